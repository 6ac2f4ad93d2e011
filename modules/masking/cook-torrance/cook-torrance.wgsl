/// G2 / (4 n.l n.v), G2 = min(1, 2 n.h n.v / v.h, 2 n.h n.l / v.h). Cook and Torrance 1982.
///
/// With 2 v.h = |v + l| and n.h = (n.v + n.l) / |v + l| the half vector disappears, and with it the 0 / 0 at the horizon: only the larger
/// of the cosines is left below a fraction. For v opposite to l, v.h has no digits in f32, while the sum v + l is exact.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    let sum = v + l;
    // |v + l|^2 below 1e-14 is the rounding of unit vectors. The floor of the first keeps products of the smallest cosines from 1 / 0.
    let square = max(dot(sum, sum), 1e-14);
    let open = 0.25 / max(n_dot_v * n_dot_l, 1e-24);
    return min(open, (n_dot_v + n_dot_l) / (square * max(n_dot_v, n_dot_l)));
}
