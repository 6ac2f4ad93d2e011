/// Albedo / pi, 1/sr.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return s.diffuse * INV_PI;
}
