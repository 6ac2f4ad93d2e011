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
    let mass = w * ((1.0 + 1.0 / b) * growth(x * w) - growth((x + 1.0) * w) / b);
    return select(0.0, falloff(s, h) * b * 0.5 * INV_PI / mass, cosine > 0.0);
}

/// B. The floor of alpha^2 stands for alpha = 1e-9 and keeps alpha = 0 from 1 / 0.
fn sharpness(s: Surface) -> f32 {
    return 2.0 / max(s.alpha * s.alpha, 1e-18);
}

/// (1 + B (1 - cos))^-C, at most 1. Below the horizon it means nothing, and is finite.
fn falloff(s: Surface, h: vec3f) -> f32 {
    let across = cross(s.normal, h);
    let t = dot(across, across) / (1.0 + max(dot(s.normal, h), 0.0));
    return pow(1.0 + sharpness(s) * t, -params.c);
}

/// A facet with the density D, without the cosine, of its angle, by inversion: D n.h has no closed inverse.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let b = sharpness(s);
    let w = log(1.0 + b);
    // 1 + B t is exp(reach), a power of 1 + B.
    let reach = w * power_quantile(u.x, (1.0 - params.c) * w);
    let t = clamp(reach * growth(reach) / b, 0.0, 1.0);
    return facet_toward(s, v, sqrt(t * (2.0 - t)), 1.0 - t, u.y);
}

/// D over its own integral, of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let b = sharpness(s);
    let w = log(1.0 + b);
    let d = falloff(s, h) * b * 0.5 * INV_PI / (w * growth((1.0 - params.c) * w));
    return select(0.0, d * facet_share(s, v, h), dot(s.normal, h) > 0.0);
}

/// (exp(x) - 1) / x, 1 at x = 0. Within 1 of 0 by its Taylor series, whose first missing term is 3e-8: there exp(x) - 1 cancels.
fn growth(x: f32) -> f32 {
    if abs(x) > 1.0 {
        return (exp(x) - 1.0) / x;
    }
    let tail = 1.0 + x / 7.0 * (1.0 + x / 8.0 * (1.0 + x / 9.0 * (1.0 + x / 10.0)));
    return 1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0 * tail))));
}

/// ln(1 + u (exp(y) - 1)) / y, u at y = 0: where the share u of the integral of a power lies, in the logarithm. Within 0.05 of 0 by the
/// first terms of its series, good to 1e-5: there the logarithm cancels. The floor keeps u = 1 from log(0).
fn power_quantile(u: f32, y: f32) -> f32 {
    if abs(y) < 0.05 {
        return u + 0.5 * u * (1.0 - u) * y * (1.0 + (1.0 - 2.0 * u) * y / 3.0);
    }
    return log(max((1.0 - u) + u * exp(y), 1e-37)) / y;
}

/// The facet (sine, cosine) turned about n by u.y; by half a turn more where v sees it only so. So v sees every facet that is drawn.
fn facet_toward(s: Surface, v: vec3f, sine: f32, cosine: f32, u: f32) -> vec3f {
    let basis = frame_of(s.normal);
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (2.0 * u - 1.0);
    let side = sine * vec2f(cos(turn), sin(turn));
    let h = basis * vec3f(side, cosine);
    let turned = basis * vec3f(-side, cosine);
    return select(h, turned, dot(v, h) < 0.0 && dot(v, turned) > 0.0);
}

/// How often h is drawn for once that its angle to n is: twice where v sees it but not h after half a turn, never where it is the
/// other way round.
fn facet_share(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let here = dot(v, h);
    let turned = 2.0 * dot(s.normal, h) * dot(s.normal, v) - here;
    if here < 0.0 && turned > 0.0 {
        return 0.0;
    }
    return select(1.0, 2.0, here > 0.0 && turned < 0.0);
}
