/// 7^7 / 6^6, one over the largest value of c (1 - c)^6, which it has at c = 1/7: 81.8 degrees.
const PEAK: f32 = 17.6513846022;
/// (6/7)^5: Schlick's power there.
const POWER: f32 = 0.462664366038;

/// Schlick's term between the surface's colours at normal incidence and at the horizon, less a bump that takes it to `f82` times itself at 82
/// degrees.
///
/// Not below 0: where f0 is low and the tint dark, the bump is wider than what it is taken from.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    let c = clamp(cosine, 0.0, 1.0);
    let x = 1.0 - c;
    let x2 = x * x;
    let x5 = x2 * x2 * x;
    let rise = s.f90 - s.f0;
    let at_peak = s.f0 + rise * POWER;
    return max(s.f0 + rise * x5 - (c * x5 * x * PEAK) * at_peak * (1.0 - s.f82), vec3f(0.0));
}
