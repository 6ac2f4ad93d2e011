/// All of the light up to the outer angle, nothing beyond.
fn cone(versine: f32, inner: f32, outer: f32) -> f32 {
    return select(0.0, 1.0, versine < outer);
}

/// The outer cone, sr.
fn cone_solid_angle(inner: f32, outer: f32) -> f32 {
    return 2.0 * PI * outer;
}
