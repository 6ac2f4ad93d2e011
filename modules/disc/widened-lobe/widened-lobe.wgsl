/// The disc as a point, reflected by a rougher surface.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    // The disc as the half vectors see it: half as wide in the plane of v and l, half over v.h across it, so this is the mean square of its radius.
    // |v + l| = 2 v.h; 1e-4 bounds it where v and l oppose each other and there is no half vector.
    let sum = v + l;
    let spread = 0.25 * radius * radius / sqrt(max(0.25 * dot(sum, sum), 1e-4));
    var rough = s;
    rough.alpha = min(sqrt(s.alpha * s.alpha + spread), 1.0);
    rough.widths = min(sqrt(s.widths * s.widths + spread), vec2f(1.0));
    return brdf(rough, v, l) * cosine;
}
