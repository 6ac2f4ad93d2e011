/// 1 / (pi ax ay ((h.t / ax)^2 + (h.b / ay)^2 + (h.n)^2)^2), 1/sr; 0 for h below the surface. All terms are positive. The floor is far below what
/// a surface has and keeps squares in range.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let widths = max(s.widths, vec2f(1e-9));
    let local = to_local(s, h);
    let scaled = vec3f(local.xy / widths, local.z);
    let k = 1.0 / dot(scaled, scaled);
    return select(0.0, k * k * INV_PI / (widths.x * widths.y), local.z > 0.0);
}

/// A facet as v sees it.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let h = ggx_facet(s.widths, to_local(s, v), u);
    return s.tangent * h.x + cross(s.normal, s.tangent) * h.y + s.normal * h.z;
}

/// G1(v) v.h D(h) / n.v, 1/sr (Heitz 2014, eq. 16), with G1 = 2 n.v / (n.v + sqrt((ax v.t)^2 + (ay v.b)^2 + (n.v)^2)): n.v cancels.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let local = to_local(s, v);
    let projected = max(local.z, 0.0) + length(vec3f(s.widths * local.xy, local.z));
    return 2.0 * max(dot(v, h), 0.0) * distribution(s, h) / max(projected, 1e-12);
}
