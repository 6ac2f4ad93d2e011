/// The cosine of the centre where all of the light is above the horizon; else the mean of what is above, the cosines taken as evenly spread between
/// that of the light's highest point and as far below the centre. How much light there is comes from a disk that shows the same area, seen
/// from straight ahead: pi R^2 / (d^2 + R^2), which is right in the distance and at most pi near by.
fn irradiance(i: u32, s: Surface) -> vec3f {
    let offset = shape_centre(i) - s.position;
    let middle = dot(s.normal, unit_or(offset, s.normal));
    let top = dot(s.normal, unit_or(shape_toward(i, s.position, s.normal), s.normal));
    if top <= 0.0 {
        return vec3f(0.0);
    }
    let reach = max(top - middle, 0.0);
    let cosine = select(0.25 * top * top / max(reach, 1e-20), middle, middle >= reach);
    let area = shape_projected_area(i, s.position);
    return shape_luminance(i, s.position, s.normal, s.normal, 0.5) * (cosine * area / max(dot(offset, offset) + area * INV_PI, 1e-30));
}
