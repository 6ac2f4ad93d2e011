/// Density of microfacets with the unit normal h, 1/sr, such that its integral times n.h over the hemisphere is 1.
fn distribution(s: Surface, h: vec3f) -> f32 {
    return 0.0;
}

/// Draws the unit normal h of a facet with the density `facet_pdf`, for u uniform in [0, 1)^2. Neutral: the density is the
/// cosine's, which draws every facet that there may be.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return cosine_sample(s.normal, u);
}

/// Density over solid angle with which `facet_sample` draws h, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    return cosine_pdf(s.normal, h);
}
