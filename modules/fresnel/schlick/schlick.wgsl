/// f0 + (1 - f0) (1 - cosine)^5.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    return schlick(s.f0, cosine);
}
