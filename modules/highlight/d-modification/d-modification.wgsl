/// A lobe with alpha' = alpha + widening R / d and the light as a point. What the light sends is that of a disk that shows the same area.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let offset = shape_centre(i) - s.position;
    let square = max(dot(offset, offset), 1e-30);
    let l = unit_or(offset, s.normal);
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    let area = shape_projected_area(i, s.position);
    let more = params.widening * shape_radius(i) * inverseSqrt(square);
    var rougher = s;
    rougher.alpha = min(s.alpha + more, 1.0);
    rougher.widths = min(s.widths + more, vec2f(1.0));
    // A surface mirrors no more than the light has.
    return shape_luminance(i, s.position, s.normal, l, rougher.alpha) * min(brdf(rougher, v, l) * (cosine * area / (square + area * INV_PI)), vec3f(1.0));
}
