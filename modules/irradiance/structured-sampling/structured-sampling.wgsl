/// What one place of the light gives: the share of the sky that it stands for, sr, and that times its cosine.
fn at(i: u32, s: Surface, u: vec2f) -> vec2f {
    let l = shape_sample(i, s.position, u);
    let density = shape_pdf(i, s.position, l);
    // A sample that rounding has put beside the shape.
    let share = select(0.0, 1.0 / density, density > 0.0);
    return vec2f(share, share * max(dot(s.normal, l), 0.0));
}

/// The mean of five equal weights, lx. The four outer ones are at 0.5 +- 0.3227 of each coordinate: so the mean of squares is right as well. Five points
/// of a large light near by may be too many bright ones: more than half a sky is taken for half a sky.
fn irradiance(i: u32, s: Surface) -> vec3f {
    // The sampler does not ask which side shines.
    if shape_projected_area(i, s.position) <= 0.0 {
        return vec3f(0.0);
    }
    let sum = at(i, s, vec2f(0.5, 0.5)) + at(i, s, vec2f(0.1773, 0.1773)) + at(i, s, vec2f(0.8227, 0.1773))
        + at(i, s, vec2f(0.1773, 0.8227)) + at(i, s, vec2f(0.8227, 0.8227));
    // Of 2 pi sr, in the mean.
    let sky = sum.x * 0.0318309886183791;
    return shape_luminance(i, s.position, s.normal, s.normal, 0.5) * min(0.2 * sum.y * inverseSqrt(1.0 + sky * sky), 3.14159265358979);
}
