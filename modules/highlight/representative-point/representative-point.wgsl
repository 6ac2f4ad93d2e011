/// The lobe's full height wherever the mirrored ray hits the light, times (alpha / alpha')^2 with alpha' = alpha + widening R / d: what a lobe
/// loses in height that is widened by the light. What the light sends is that of a disk that shows the same area.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let mirror = reflect(-v, s.normal);
    let l = unit_or(shape_toward(i, s.position, mirror), s.normal);
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    let offset = shape_centre(i) - s.position;
    let square = max(dot(offset, offset), 1e-30);
    let area = shape_projected_area(i, s.position);
    let widened = min(s.alpha + params.widening * shape_radius(i) * inverseSqrt(square), 1.0);
    let height = s.alpha / max(widened, s.alpha);
    // A surface mirrors no more than the light has.
    return shape_luminance(i, s.position, s.normal, mirror, s.alpha) * min(brdf(s, v, l) * (cosine * height * height * area / (square + area * INV_PI)), vec3f(1.0));
}
