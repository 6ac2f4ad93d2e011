/// Bidirectional reflectance from the unit direction l to the unit direction v, 1/sr per channel, without the cosine.
/// Neutral: a white Lambertian surface, so that a light probed alone gives irradiance / pi.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return vec3f(0.318309886183791);
}
