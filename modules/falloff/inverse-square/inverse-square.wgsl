/// 1 / d^2, 1/m2, whatever the range. Within `size` it stays what it is there; 1e-6 m stands for a size below a micrometre, so that no
/// size at all is finite too.
fn falloff(distance: f32, range: f32, size: f32) -> f32 {
    let nearest = max(max(distance, size), 1e-6);
    return 1.0 / (nearest * nearest);
}
