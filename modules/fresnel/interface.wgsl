/// Reflectance of a microfacet for light at an angle with this cosine to its normal, per channel, in [0, 1].
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    return s.f0;
}
