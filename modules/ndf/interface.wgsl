/// Density of microfacets with the unit normal h, 1/sr, such that its integral times n.h over the hemisphere is 1.
fn distribution(s: Surface, h: vec3f) -> f32 {
    return 0.0;
}
