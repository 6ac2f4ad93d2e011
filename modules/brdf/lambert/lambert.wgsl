/// Albedo / pi, 1/sr.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return s.diffuse * INV_PI;
}

/// The cosine is all that there is to know.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return cosine_sample(s.normal, u);
}

/// cos / pi, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return cosine_pdf(s.normal, l);
}
