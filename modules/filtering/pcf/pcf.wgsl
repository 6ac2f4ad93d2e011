/// Mean of the comparisons at whole texels, weighted by a tent in each direction. A tent of integers that reaches 0 one
/// texel beyond the radius sums to the square of that reach.
fn filter_shadow(at: Receiver) -> f32 {
    let reach = i32(params.radius) + 1;
    var lit = 0.0;
    for (var y = 1 - reach; y < reach; y++) {
        for (var x = 1 - reach; x < reach; x++) {
            let weight = f32((reach - abs(x)) * (reach - abs(y)));
            lit += weight * shadow_compare(at, vec2f(f32(x), f32(y)));
        }
    }
    return lit / f32(reach * reach * reach * reach);
}
