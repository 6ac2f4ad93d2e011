/// Maps an exposed linear colour to a linear display colour. Neutral: as it is.
fn tone_curve(c: vec3f) -> vec3f {
    return c;
}
