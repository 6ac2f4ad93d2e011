/// 1 / (2 (n.l p(v) + n.v p(l))), the tangents multiplied out. The floor is below what dot products of unit vectors can tell from 0; with widths of
/// 1e-4 the peak stays in range.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    return 0.5 / max(n_dot_l * projected(s, v) + n_dot_v * projected(s, l), 1e-28);
}

/// sqrt((ax d.t)^2 + (ay d.b)^2 + (d.n)^2): (2 Lambda + 1) n.d.
fn projected(s: Surface, d: vec3f) -> f32 {
    let local = to_local(s, d);
    return length(vec3f(s.widths * local.xy, local.z));
}
