/// alpha^2 / (pi (cos^2 (alpha^2 - 1) + 1)^2), 1/sr, as it is usually printed.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let a2 = s.alpha * s.alpha;
    let k = cosine * cosine * (a2 - 1.0) + 1.0;
    return select(0.0, a2 * INV_PI / (k * k), cosine > 0.0);
}
