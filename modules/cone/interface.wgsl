/// Share of a spot light's intensity at an angle to its axis, in [0, 1]. All three arguments are 1 - cos of an angle, which keeps its
/// digits where a cosine near 1 has lost them: of the direction, of the inner angle, within which all is there, and of the outer one, beyond
/// which nothing is. Neutral: all, everywhere.
fn cone(versine: f32, inner: f32, outer: f32) -> f32 {
    return 1.0;
}

/// Integral of `cone` over all directions, sr.
fn cone_solid_angle(inner: f32, outer: f32) -> f32 {
    return 4.0 * PI;
}
