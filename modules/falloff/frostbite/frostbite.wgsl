/// 1 / d^2 with a window that takes it to 0 at the range, 1/m2. Within `size` the inverse square stays what it is there; 1e-6 m
/// stands for a size below a micrometre, so that no size at all is finite too.
fn falloff(distance: f32, range: f32, size: f32) -> f32 {
    // 1 - x^4 as a product: the difference that vanishes at the range is exact there.
    let reach = max(range, 1e-15);
    let gap = select(1.0, (reach - min(distance, reach)) / reach, range > 0.0);
    let x = 1.0 - gap;
    let window = gap * (1.0 + x) * (1.0 + x * x);
    let share = window / max(max(distance, size), 1e-6);
    return share * share;
}
