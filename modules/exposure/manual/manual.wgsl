/// 1 / (1.2 2^EV100), m2/cd: the luminance that saturates the sensor becomes 1. The 1.2 is 78 / (100 q) of a lens with
/// vignetting and transmittance q = 0.65.
fn exposure() -> f32 {
    return exp2(-params.ev100) / 1.2;
}
