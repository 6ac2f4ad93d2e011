/// Scales a material's value at a point. Neutral: as it is.
fn modulate(value: vec4f, at: Fragment) -> vec4f {
    return value;
}
