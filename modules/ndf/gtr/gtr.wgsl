/// c / (alpha^2 cos^2 + sin^2)^gamma, 1/sr, of the angle between n and h, c such that D n.h has the integral 1.
///
/// With q = alpha^2 cos^2 + sin^2 that integral is pi c times the mean of q^-gamma over q from alpha^2 to 1: a power, or a logarithm at
/// gamma = 1; `exprel` has both. Everything is relative to the peak, so no power leaves the range of f32.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let a2 = width2(s);
    // alpha^2 / q: 1 at the peak. Of a unit vector the floor is never reached.
    let relative = a2 / max(a2 * cosine * cosine + sine_square(s.normal, h), 1e-30);
    let l = log_width(a2);
    let d = pow(relative, params.gamma) * INV_PI / (a2 * l * exprel((1.0 - params.gamma) * l * (1.0 - a2)));
    return select(0.0, d, cosine > 0.0);
}

/// alpha^2; the floor stands for alpha = 1e-9 and keeps alpha = 0 from 0 / 0.
fn width2(s: Surface) -> f32 {
    return max(s.alpha * s.alpha, 1e-18);
}

/// -ln(alpha^2) / (1 - alpha^2), 1 at alpha = 1. Above alpha^2 = 1/2, where this is nearly 0 / 0, by the series of artanh, whose
/// first missing term is below 2e-8.
fn log_width(a2: f32) -> f32 {
    if a2 < 0.5 {
        return -log(a2) / (1.0 - a2);
    }
    let z = (1.0 - a2) / (1.0 + a2);
    let z2 = z * z;
    let tail = 1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 * (1.0 / 11.0 + z2 / 13.0));
    return 2.0 / (1.0 + a2) * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * tail)));
}

/// A facet with the density D n.h of its angle, by inversion. Burley 2012, appendix B.2, with the sine in place of the cosine.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let a2 = width2(s);
    let l = log_width(a2);
    // q is alpha^2 exp(l (1 - alpha^2) share), and sin^2 is (q - alpha^2) / (1 - alpha^2).
    let share = power_quantile(u.x, (1.0 - params.gamma) * l * (1.0 - a2));
    let sine2 = clamp(a2 * l * share * exprel(l * (1.0 - a2) * share), 0.0, 1.0);
    return facet_toward(s, v, sqrt(sine2), sqrt(1.0 - sine2), u.y);
}

/// D n.h of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    return distribution(s, h) * max(dot(s.normal, h), 0.0) * facet_multiplicity(s, v, h);
}
