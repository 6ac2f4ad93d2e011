/// Illuminance of the surface by light i, which nothing hides, lx per channel. Neutral: dark.
fn irradiance(i: u32, s: Surface) -> vec3f {
    return vec3f(0.0);
}
