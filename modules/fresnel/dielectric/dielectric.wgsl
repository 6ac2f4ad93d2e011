/// Fresnel's equations for unpolarised light, of the index n = (1 + q) / (1 - q) with q = sqrt(f0), by channel.
///
/// Cook and Torrance's g and c are both multiplied by 1 - q, so that no n is needed: it is infinite where f0 is 1. Their difference is
/// (n^2 - 1) / (g + c), which does not cancel where n is near 1.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    let c = clamp(cosine, 0.0, 1.0);
    let f0 = clamp(s.f0, vec3f(0.0), vec3f(1.0));
    let q = sqrt(f0);
    // 1 - q without the rounding of the root. The floor keeps f0 = 1 from 0 / 0 at the horizon; it is an index of 2e18.
    let w = max((1.0 - f0) / (1.0 + q), vec3f(1e-18));
    let g = sqrt(4.0 * q + (c * w) * (c * w));
    // 0 only where f0 and c are both 0: nothing is there that reflects.
    let sum = max(g + c * w, vec3f(1e-18));
    let difference = 4.0 * q / sum;
    let across = difference / sum;
    let ratio = (c * sum - w) / (c * difference + w);
    return min(0.5 * across * across * (1.0 + ratio * ratio), vec3f(1.0));
}
