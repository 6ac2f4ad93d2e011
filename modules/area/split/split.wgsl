/// The diffuse part as Lambert's law, albedo / pi, times the illuminance, and the rest of the BRDF by itself.
fn illuminate(i: u32, s: Surface, v: vec3f) -> vec3f {
    var glossy = s;
    glossy.diffuse = vec3f(0.0);
    return s.diffuse * INV_PI * irradiance(i, s) + highlight(i, glossy, v);
}
