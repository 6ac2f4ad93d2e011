/// sqrt(6): the exponent at a slope of once its root mean square.
const SQRT_6: f32 = 2.449489742783178;

/// 3 exp(-sqrt(6) tan / alpha) / (pi alpha^2 cos^4), 1/sr, of the angle between n and h.
///
/// The sine is taken from the cross product: 1 - cos^2 loses all digits where the lobe of a smooth surface lies. Half the exponent is
/// taken and squared, so that nothing is out of the range of f32 before the exponential is 0. The floors stand for alpha = 1e-12 and
/// for a cosine of 1e-9, less than unit vectors can tell from 0; they keep alpha = 0 and the horizon from 0 / 0.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let alpha = max(s.alpha, 1e-12);
    let slope = sqrt(sine_square(s.normal, h)) / (alpha * max(cosine, 1e-9));
    let k = exp(-0.5 * SQRT_6 * slope) / (alpha * max(cosine * cosine, 1e-18));
    return select(0.0, 3.0 * k * k * INV_PI, cosine > 0.0);
}

/// A facet with the density D n.h of its angle. With x = sqrt(6) tan / alpha the share of facets up to x is 1 - (1 + x) exp(-x): its
/// inverse is found by Newton's method on x - ln(1 + x) = -ln(1 - u), convex, from above. Four steps leave less than 1e-6.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    // 1 - u is at least 6e-8 for the u that f32 has below 1.
    let target_log = max(-log(max(1.0 - u.x, 1e-30)), 0.0);
    var x = target_log + sqrt(2.0 * target_log);
    // Nearer to 0, where x - ln(1 + x) has no digits, the start is good enough: one facet in 1e4.
    if target_log > 1e-4 {
        for (var i = 0; i < 4; i++) {
            x -= (x - log(1.0 + x) - target_log) * (1.0 + x) / x;
        }
    }
    let slope = s.alpha * max(x, 0.0) / SQRT_6;
    let cosine = inverseSqrt(1.0 + slope * slope);
    return facet_toward(s, v, slope * cosine, cosine, u.y);
}

/// D n.h of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    return distribution(s, h) * max(dot(s.normal, h), 0.0) * facet_multiplicity(s, v, h);
}
