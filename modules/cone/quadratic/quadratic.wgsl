/// The square of a ramp that is linear in the cosine. Angles closer than 1e-10 in 1 - cos, a thousandth of a degree at the axis, are an edge.
fn cone(versine: f32, inner: f32, outer: f32) -> f32 {
    let ramp = clamp((outer - versine) / max(outer - inner, 1e-10), 0.0, 1.0);
    return ramp * ramp;
}

/// The inner cone and a third of what is between the cones, sr.
fn cone_solid_angle(inner: f32, outer: f32) -> f32 {
    let full = min(inner, outer);
    return 2.0 * PI * (full + (outer - full) / 3.0);
}
