/// The outer cone, sr: all of the flux leaves through it. The solid angle of a cone of 0.03 degrees, 1e-6 sr, stands for
/// narrower ones, whose intensity would overflow.
fn spread(inner: f32, outer: f32) -> f32 {
    return max(2.0 * PI * outer, 1e-6);
}
