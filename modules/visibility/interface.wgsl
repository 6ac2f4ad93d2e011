/// What a light says of one of its instances, seen from a surface point.
struct Ray {
    /// Index of the light in its buffer, and so of its views.
    light: u32,
    /// Unit direction from the surface to the light.
    direction: vec3f,
    /// Distance to the light, m; irrelevant for directional lights.
    distance: f32,
}

/// Share of the light that arrives, in [0, 1]. Neutral: all.
fn visible(ray: Ray, s: Surface) -> f32 {
    return 1.0;
}
