/// Solid angle by which a flux in lumen is divided to give the intensity on the axis in candela, sr, at least 1e-6. The arguments are 1 - cos
/// of the inner and of the outer half angle. Neutral: all directions.
fn spread(inner: f32, outer: f32) -> f32 {
    return 4.0 * PI;
}
