/// Radiance leaving the surface toward v, cd/m2 per channel, for each lux that a disc around the unit direction l gives a surface perpendicular
/// to l. `radius` is the angle between l and the disc's rim, in [0, pi / 4] rad. Neutral: dark.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    return vec3f(0.0);
}
