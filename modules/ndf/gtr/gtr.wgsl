/// c / (alpha^2 cos^2 + sin^2)^gamma, 1/sr, of the angle between n and h, c such that D n.h has the integral 1.
///
/// With q = alpha^2 cos^2 + sin^2 that integral is pi c times the mean of q^-gamma over q from alpha^2 to 1: a power, or a logarithm at
/// gamma = 1; `growth` has both. Everything is relative to the peak, so no power leaves the range of f32.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let across = cross(s.normal, h);
    let a2 = width2(s);
    // alpha^2 / q: 1 at the peak. Of a unit vector the floor is never reached.
    let relative = a2 / max(a2 * cosine * cosine + dot(across, across), 1e-30);
    let l = log_width(a2);
    let d = pow(relative, params.gamma) * INV_PI / (a2 * l * growth((1.0 - params.gamma) * l * (1.0 - a2)));
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
    let sine2 = clamp(a2 * l * share * growth(l * (1.0 - a2) * share), 0.0, 1.0);
    return facet_toward(s, v, sqrt(sine2), sqrt(1.0 - sine2), u.y);
}

/// D n.h of the facets that v sees, 1/sr.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    return distribution(s, h) * max(dot(s.normal, h), 0.0) * facet_share(s, v, h);
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
