/// Radiance that leaves the surface toward the unit direction v because its glossy part reflects light i, which nothing hides, cd/m2 per
/// channel. The surface comes with a diffuse albedo of 0, so that `brdf` is the glossy part. Neutral: dark.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    return vec3f(0.0);
}
