/// Factor from scene luminance, cd/m2, to exposed luminance, where 1 is the camera's saturation. Neutral: 1.
fn exposure() -> f32 {
    return 1.0;
}
