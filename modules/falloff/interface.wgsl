/// Illuminance of a perpendicular surface at `distance`, m, from a light of 1 cd: 1/m2. At `range`, m, it has faded to 0;
/// a range of 0 is none. `size`, m, is the radius of what shines: nearer than that, the inverse square no longer
/// holds and what is returned stays bounded. Neutral: the inverse square.
fn falloff(distance: f32, range: f32, size: f32) -> f32 {
    let nearest = max(max(distance, size), 1e-6);
    return 1.0 / (nearest * nearest);
}
