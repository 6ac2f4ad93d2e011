/// A / (1 + B (1 - cos))^C, 1/sr, of the angle between n and h, with B = 2 / alpha^2 and A such that D n.h has the integral 1.
///
/// 1 - cos is sin^2 / (1 + cos), with the sine from the cross product: the subtraction has no digits where the lobe of a smooth
/// surface lies.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let b = sharpness(s);
    let w = log(1.0 + b);
    // The integral of (1 - t) (1 + b t)^-C over t = 1 - cos in [0, 1], times b: both terms are powers, or logarithms at C = 1 and 2.
    let x = 1.0 - params.c;
    let mass = w * ((1.0 + 1.0 / b) * exprel(x * w) - exprel((x + 1.0) * w) / b);
    return select(0.0, falloff(s, h) * b * 0.5 * INV_PI / mass, cosine > 0.0);
}

/// B. The floor of alpha^2 stands for alpha = 1e-9 and keeps alpha = 0 from 1 / 0.
fn sharpness(s: Surface) -> f32 {
    return 2.0 / max(s.alpha * s.alpha, 1e-18);
}

/// (1 + B (1 - cos))^-C, at most 1. Below the horizon it means nothing, and is finite.
fn falloff(s: Surface, h: vec3f) -> f32 {
    let t = sine_square(s.normal, h) / (1.0 + max(dot(s.normal, h), 0.0));
    return pow(1.0 + sharpness(s) * t, -params.c);
}

/// A facet with the density D, without the cosine, of its angle, by inversion: D n.h has no closed inverse.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let b = sharpness(s);
    let w = log(1.0 + b);
    // 1 + B t is exp(reach), a power of 1 + B.
    let reach = w * power_quantile(u.x, (1.0 - params.c) * w);
    let t = clamp(reach * exprel(reach) / b, 0.0, 1.0);
    return facet_toward(s, v, sqrt(t * (2.0 - t)), 1.0 - t, u.y);
}

/// D over its own integral, of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let b = sharpness(s);
    let w = log(1.0 + b);
    let d = falloff(s, h) * b * 0.5 * INV_PI / (w * exprel((1.0 - params.c) * w));
    return select(0.0, d * facet_multiplicity(s, v, h), dot(s.normal, h) > 0.0);
}
