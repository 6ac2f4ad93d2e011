/// What the facets let in and out again, 1/sr. Zero at and below the horizon.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    return s.diffuse * (1.0 - s.f0) * (28.0 / 23.0 * INV_PI * passed(n_dot_v) * passed(n_dot_l));
}

/// 1 - (1 - cosine / 2)^5, as the geometric sum: near the horizon the difference has no digits left.
fn passed(cosine: f32) -> f32 {
    let half = 0.5 * cosine;
    let x = 1.0 - half;
    return half * (1.0 + x * (1.0 + x * (1.0 + x * (1.0 + x))));
}
