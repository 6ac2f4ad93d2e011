/// Directional albedo of the facets for light along the direction with this cosine to the normal: A, B, and the lost share 1 - A - B. With Schlick's
/// Fresnel term the facets send out f0 A + B; white ones (F = 1) send out all but the lost share. The neutral facets are level.
fn facet_albedo(s: Surface, cosine: f32) -> vec3f {
    return vec3f(1.0, 0.0, 0.0);
}

/// The mean of `facet_albedo` over the hemisphere, weighted with the cosine: 2 times the integral of it times the cosine.
fn facet_albedo_mean(s: Surface) -> vec3f {
    return vec3f(1.0, 0.0, 0.0);
}
