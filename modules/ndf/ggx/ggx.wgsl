/// alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2), 1/sr, of the angle between n and h.
///
/// The sine is taken from the cross product: 1 - cos^2 loses all digits where the lobe of a smooth surface lies.
/// The floor of the denominator is alpha^2 of alpha = 1e-12, far below what a surface has; it keeps alpha = 0 from 0 / 0.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let along = s.alpha * cosine;
    let k = s.alpha / max(along * along + sine_square(s.normal, h), 1e-24);
    return select(0.0, k * k * INV_PI, cosine > 0.0);
}

/// A facet as v sees it.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let basis = frame_of(s.normal);
    return basis * ggx_facet(vec2f(s.alpha), v * basis, u);
}

/// G1(v) v.h D(h) / n.v, 1/sr (Heitz 2014, eq. 16), with Smith's G1 = 2 n.v / (n.v + sqrt(alpha^2 + (1 - alpha^2) (n.v)^2)): n.v cancels.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let n_dot_v = max(dot(s.normal, v), 0.0);
    let a2 = s.alpha * s.alpha;
    let projected = n_dot_v + sqrt(a2 + (1.0 - a2) * n_dot_v * n_dot_v);
    return 2.0 * max(dot(v, h), 0.0) * distribution(s, h) / max(projected, 1e-12);
}
