/// A receiver as its shadow map sees it.
struct Receiver {
    /// Layer of the map (of a cube map: the cube).
    layer: u32,
    /// Where in the map: u and v in [0, 1] and the distance along the view's axis in m; for a cube map the
    /// offset from the light to the receiver, world space, m.
    place: vec3f,
    /// Depth to compare with, in the map's own measure, bias taken off.
    depth: f32,
}

/// Share of the light that passes, in [0, 1].
fn filter_shadow(at: Receiver) -> f32 {
    return 1.0;
}

/// Offered by the shadow map: one comparison, 1 lit and 0 dark, at an offset in texels. Where a filter is
/// probed alone, an edge: everything with offset.x < place.x is lit.
fn shadow_compare(at: Receiver, offset: vec2f) -> f32 {
    return select(0.0, 1.0, offset.x < at.place.x);
}

/// Offered by the shadow map: the stored depth at an offset in texels.
fn shadow_depth(at: Receiver, offset: vec2f) -> f32 {
    return select(0.0, 1.0, offset.x < at.place.x);
}

/// Offered by the shadow map: side of a texel at the receiver, m.
fn shadow_texel(at: Receiver) -> f32 {
    return 1.0;
}
