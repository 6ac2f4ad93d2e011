const PI: f32 = 3.14159265358979;
const INV_PI: f32 = 0.318309886183791;

/// Luminance of a linear Rec.709 colour (ITU-R BT.709, Y row).
fn luminance(c: vec3f) -> f32 {
    return dot(c, vec3f(0.2126, 0.7152, 0.0722));
}
