/// L (1 + L / white^2) / (1 + L) for the luminance L, and the colour scaled with it. The quotient of the two luminances
/// has no L in its denominator, so black stays black; dividing first keeps huge colours finite. What overflowed in the frame is as bright as
/// a colour can be, not infinity / infinity.
fn tone_curve(c: vec3f) -> vec3f {
    let color = clamp(c, vec3f(0.0), vec3f(1e38));
    let l = luminance(color);
    return color / (1.0 + l) * (1.0 + l / (params.white * params.white));
}
