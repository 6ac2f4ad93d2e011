/// f0 + (f90 - f0) (1 - cosine)^5.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    return s.f0 + (s.f90 - s.f0) * schlick_weight(cosine);
}
