/// G1(v) G1(l) / (4 n.l n.v), with G1 = 2 cos / (cos + sqrt(a^2 + (1 - a^2) cos^2)), a being alpha.
///
/// The cosines are divided out beforehand, so nothing is 0 / 0 at the horizon and no term cancels.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    return projected(s.alpha, n_dot_v) * projected(s.alpha, n_dot_l);
}

/// G1 / (2 cos). The floor keeps alpha = 0 at the horizon finite; a cosine below it cannot be told from 0.
fn projected(alpha: f32, cosine: f32) -> f32 {
    let a2 = alpha * alpha;
    return 1.0 / max(cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine), 1e-12);
}
