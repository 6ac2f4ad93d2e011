const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;

/// Luminance of a linear Rec.709 colour (ITU-R BT.709, Y row).
fn luminance(c: vec3f) -> f32 {
    return dot(c, vec3f(0.2126, 0.7152, 0.0722));
}

/// v at unit length; `fallback` where v is so short that its direction is noise. 1e-15 is far below any length in
/// metres that a scene has, and its square is still a normal f32.
fn unit_or(v: vec3f, fallback: vec3f) -> vec3f {
    let square = dot(v, v);
    return select(fallback, v * inverseSqrt(max(square, 1e-30)), square > 1e-30);
}
