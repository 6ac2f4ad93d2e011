/// Diffuse reflectance, 1/sr per channel, without the cosine. Neutral: none.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    return vec3f(0.0);
}
