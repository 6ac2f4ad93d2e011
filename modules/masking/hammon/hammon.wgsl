/// 1 / (2 mix(2 n.l n.v, n.l + n.v, alpha)): the roots of Smith's correlated GGX taken for straight lines. Hammon 2017.
///
/// All terms are positive. The floor is reached where n.l and n.v are below 1e-8 (at alpha 1e-4), less than unit vectors can tell from 0.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    let smooth_part = 2.0 * n_dot_l * n_dot_v;
    let rough_part = n_dot_l + n_dot_v;
    return 0.5 / max(mix(smooth_part, rough_part, s.alpha), 1e-12);
}
