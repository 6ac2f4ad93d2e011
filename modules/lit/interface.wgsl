/// Radiance leaving the surface toward the unit direction v, cd/m2 per channel. Neutral: dark.
fn lit(s: Surface, v: vec3f) -> vec3f {
    return vec3f(0.0);
}
