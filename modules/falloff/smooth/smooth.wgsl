/// 1 / (d^2 + size^2) with a window that reaches 0 at the range with slope and curvature 0, 1/m2. 1e-6 m stands for a size below a
/// micrometre, so that no size at all is finite too.
fn falloff(distance: f32, range: f32, size: f32) -> f32 {
    // 1 - x^2 as a product: the difference that vanishes at the range is exact there.
    let reach = max(range, 1e-15);
    let gap = select(1.0, (reach - min(distance, reach)) / reach, range > 0.0);
    let x = 1.0 - gap;
    let window = gap * (1.0 + x);
    let radius = max(size, 1e-6);
    return window * window * window / (distance * distance + radius * radius);
}
