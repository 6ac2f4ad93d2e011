/// Albedo / pi, 1/sr. Zero where either direction is at or below the horizon.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return select(vec3f(0.0), s.diffuse * INV_PI, above_horizon(s.normal, v, l));
}
