/// Cosine over density in one place: the light's share of the sky by it, sr.
fn at(i: u32, s: Surface, u: vec2f) -> f32 {
    let l = shape_sample(i, s.position, u);
    let density = shape_pdf(i, s.position, l);
    // A sample that rounding has put beside the shape.
    return select(0.0, max(dot(s.normal, l), 0.0) / density, density > 0.0);
}

/// The mean of five equal weights, lx. The four outer ones are at 0.5 +- 0.3227 of each coordinate: so the mean of squares is right as well. Five points of
/// a large light near by may be too many bright ones: what fills the sky gives pi.
fn irradiance(i: u32, s: Surface) -> vec3f {
    let sum = at(i, s, vec2f(0.5, 0.5)) + at(i, s, vec2f(0.1773, 0.1773)) + at(i, s, vec2f(0.8227, 0.1773))
        + at(i, s, vec2f(0.1773, 0.8227)) + at(i, s, vec2f(0.8227, 0.8227));
    return shape_luminance(i) * min(0.2 * sum, 3.14159265358979);
}
