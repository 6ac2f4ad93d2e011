/// Bidirectional reflectance from the unit direction l to the unit direction v, 1/sr per channel, without the cosine.
/// Neutral: a white Lambertian surface, so that a light probed alone gives irradiance / pi.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return vec3f(0.318309886183791);
}

/// Draws a unit direction l with the density `brdf_pdf`, for u uniform in [0, 1)^2. It may be below the horizon: such a sample counts, with
/// the value 0. Neutral: the density is the cosine's.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return cosine_sample(s.normal, u);
}

/// Density over solid angle with which `brdf_sample` draws l, 1/sr. It is above 0 wherever `brdf` is.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return cosine_pdf(s.normal, l);
}
