/// G2 / (4 n.l n.v) = 1 / (2 (n.l sqrt(a^2 + (1 - a^2) (n.v)^2) + n.v sqrt(a^2 + (1 - a^2) (n.l)^2))), a being alpha.
///
/// n.l and n.v are divided out beforehand, so nothing is 0 / 0 at the horizon and no term cancels. The floor of the
/// denominator is reached where n.l and n.v are below 5e-9 (at alpha 1e-4), less than unit vectors can tell from 0.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    let a2 = s.alpha * s.alpha;
    let toward_v = n_dot_l * sqrt(a2 + (1.0 - a2) * n_dot_v * n_dot_v);
    let toward_l = n_dot_v * sqrt(a2 + (1.0 - a2) * n_dot_l * n_dot_l);
    return 0.5 / max(toward_v + toward_l, 1e-12);
}
