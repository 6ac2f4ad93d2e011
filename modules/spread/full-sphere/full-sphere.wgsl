/// All directions, sr: the cone is a mask before a lamp that shines everywhere.
fn spread(inner: f32, outer: f32) -> f32 {
    return 4.0 * PI;
}
