/// alpha^2 / (pi (alpha^2 cos^2 + 1 - cos^2)^2), 1/sr: the sine from the cosine.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let a2 = s.alpha * s.alpha;
    let c2 = cosine * cosine;
    let k = a2 * c2 + (1.0 - c2);
    return select(0.0, a2 * INV_PI / (k * k), cosine > 0.0);
}
