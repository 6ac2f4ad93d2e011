/// G2 / (4 n.l n.v) = 1 / (4 n.l n.v (1 + L(v) + L(l))), L from the rational fit of Smith's masking of Beckmann facets. Walter et al.
/// 2007, eq. 27.
///
/// cos(theta) L is multiplied out, so nothing is 0 / 0 at the horizon. The floor is reached where n.l and n.v are below 5e-9 (at
/// alpha 1e-4), less than unit vectors can tell from 0.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    let toward_v = n_dot_l * hidden(s, v, n_dot_v);
    let toward_l = n_dot_v * hidden(s, l, n_dot_l);
    return 0.25 / max(n_dot_l * n_dot_v + toward_v + toward_l, 1e-12);
}

/// cos(theta) L, the area that is hidden, seen from a direction at the angle theta to n: with a = 1 / (alpha tan(theta)), L = 1 / G1 - 1 =
/// (1 - 1.259 a + 0.396 a^2) / (3.535 a + 2.181 a^2) for a < 1.6, else 0.
fn hidden(s: Surface, direction: vec3f, cosine: f32) -> f32 {
    let width = s.alpha * length(cross(s.normal, direction));
    // Along the normal the width is 0; the floor keeps 0 from 1 / 0.
    let a = min(cosine / max(width, 1e-12), 1.6);
    let l = (1.0 + a * (0.396 * a - 1.259)) / (3.535 + 2.181 * a);
    return select(0.0, width * l, a < 1.6);
}
