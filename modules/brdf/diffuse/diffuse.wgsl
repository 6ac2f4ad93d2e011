/// The diffuse part alone, 1/sr. Zero where either direction is at or below the horizon.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    return diffuse(s, v, l);
}

/// By the cosine: diffuse modules are near to constant.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return cosine_sample(s.normal, u);
}

/// cos / pi, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return cosine_pdf(s.normal, l);
}
