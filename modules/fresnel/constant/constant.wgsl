/// f0 at every angle.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    return s.f0;
}
