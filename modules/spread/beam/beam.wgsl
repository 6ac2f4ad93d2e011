/// What the smoothed cone lets through, sr: the flux is that which really leaves, whatever the inner angle. The solid angle of a cone of
/// 0.03 degrees, 1e-6 sr, stands for narrower ones, whose intensity would overflow.
fn spread(inner: f32, outer: f32) -> f32 {
    return max(cone_solid_angle(inner, outer), 1e-6);
}
