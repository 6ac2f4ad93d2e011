/// Fresnel's equations for unpolarised light; 1 beyond the critical angle.
///
/// g - c is taken as (n^2 - 1) / (g + c), which does not cancel where n is near 1.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    let n = params.ior;
    let c = clamp(cosine, 0.0, 1.0);
    let contrast = (n - 1.0) * (n + 1.0);
    let square = contrast + c * c;
    if square <= 0.0 {
        return vec3f(1.0);
    }
    let sum = sqrt(square) + c;
    let difference = contrast / sum;
    let across = difference / sum;
    let ratio = (c * sum - 1.0) / (c * difference + 1.0);
    return vec3f(min(0.5 * across * across * (1.0 + ratio * ratio), 1.0));
}
