/// Radiance that leaves the surface toward the unit direction v because of light i, which nothing hides, cd/m2 per channel. Neutral: dark.
fn illuminate(i: u32, s: Surface, v: vec3f) -> vec3f {
    return vec3f(0.0);
}
