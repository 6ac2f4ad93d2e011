/// F D V + diffuse, 1/sr. Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if dot(s.normal, v) <= 0.0 || dot(s.normal, l) <= 0.0 {
        return vec3f(0.0);
    }
    // Opposite directions, both at the horizon, have no half vector; any will do, the normal is as good.
    let h = unit_or(v + l, s.normal);
    let facets = distribution(s, h) * masking(s, v, l, h);
    return fresnel(s, dot(v, h)) * facets + diffuse(s, v, l);
}
