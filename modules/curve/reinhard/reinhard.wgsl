/// L (1 + L / white^2) / (1 + L) for the luminance L, and the colour scaled with it. The quotient of the two luminances
/// has no L in its denominator, so black stays black; dividing first keeps huge colours finite.
fn tone_curve(c: vec3f) -> vec3f {
    let color = max(c, vec3f(0.0));
    let l = luminance(color);
    return color / (1.0 + l) * (1.0 + l / (params.white * params.white));
}
