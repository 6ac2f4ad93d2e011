/// (m + 2) / (2 pi) cos^m, 1/sr, of the angle between n and h, with m = 2 / alpha^2 - 2.
///
/// The power is taken by the logarithm of cos^2 = 1 - sin^2: m is 2e8 at alpha 1e-4, where a 32-bit cosine cannot
/// be told from 1 and a length that is wrong by 1e-8 would count like an angle.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let sine2 = sine_square(s.normal, h);
    // The smallest alpha that is told from 0: its square is still a normal f32.
    let alpha = max(s.alpha, 1e-12);
    let half_m = 0.5 * exponent_of_alpha(alpha);
    let d = exp(half_m * log_rest(sine2 / (sine2 + cosine * cosine), cosine * cosine / (sine2 + cosine * cosine))) / alpha / alpha * INV_PI;
    return select(0.0, d, cosine > 0.0);
}

/// A facet with the density D n.h of its angle: cos = (1 - u)^(1 / (m + 2)), and 1 / (m + 2) = alpha^2 / 2. Walter et al. 2007.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    // 1 - u is at least 6e-8 for the u that f32 has below 1.
    let log_cosine2 = s.alpha * s.alpha * log(max(1.0 - u.x, 1e-30));
    let sine2 = clamp(-log_cosine2 * exprel(log_cosine2), 0.0, 1.0);
    return facet_toward(s, v, sqrt(sine2), exp(0.5 * log_cosine2), u.y);
}

/// D n.h of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    return distribution(s, h) * max(dot(s.normal, h), 0.0) * facet_multiplicity(s, v, h);
}
