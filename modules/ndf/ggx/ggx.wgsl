/// alpha^2 / (pi (alpha^2 cos^2 + sin^2)^2), 1/sr, of the angle between n and h.
///
/// The sine is taken from the cross product: 1 - cos^2 loses all digits where the lobe of a smooth surface lies.
/// The floor of the denominator is alpha^2 of alpha = 1e-12, far below what a surface has; it keeps alpha = 0 from 0 / 0.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let across = cross(s.normal, h);
    let along = s.alpha * cosine;
    let k = s.alpha / max(along * along + dot(across, across), 1e-24);
    return select(0.0, k * k * INV_PI, cosine > 0.0);
}
