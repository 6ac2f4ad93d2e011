/// The point lies toward the middle of two directions: the surface's normal, where light counts most, and that to the light's centre. Its cosine
/// stands for all of the light; how much that is, is taken from a disk that shows the same area, seen from straight ahead:
/// pi R^2 / (d^2 + R^2), which is right in the distance and at most pi near by.
fn irradiance(i: u32, s: Surface) -> vec3f {
    let offset = shape_centre(i) - s.position;
    let between = unit_or(s.normal + unit_or(offset, s.normal), s.normal);
    let l = unit_or(shape_toward(i, s.position, between), s.normal);
    let area = shape_projected_area(i, s.position);
    let seen = area / max(dot(offset, offset) + area * INV_PI, 1e-30);
    return shape_luminance(i) * (seen * max(dot(s.normal, l), 0.0));
}
