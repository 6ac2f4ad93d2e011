/// Radiance leaving the surface toward the unit direction v because of all lights of one kind, cd/m2 per channel. Neutral: dark.
fn light(s: Surface, v: vec3f) -> vec3f {
    return vec3f(0.0);
}
