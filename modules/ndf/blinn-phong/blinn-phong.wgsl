/// (m + 2) / (2 pi) cos^m, 1/sr, of the angle between n and h, with m = 2 / alpha^2 - 2.
///
/// The power is taken by the logarithm of cos^2 = 1 - sin^2: m is 2e8 at alpha 1e-4, where a 32-bit cosine cannot
/// be told from 1 and a length that is wrong by 1e-8 would count like an angle.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let across = cross(s.normal, h);
    // The smallest alpha that is told from 0: its square is still a normal f32.
    let alpha = max(s.alpha, 1e-12);
    let half_m = (1.0 - alpha) * (1.0 + alpha) / (alpha * alpha);
    let d = exp(half_m * log_cosine2(cosine * cosine, dot(across, across))) / alpha / alpha * INV_PI;
    return select(0.0, d, cosine > 0.0);
}

/// ln(cos^2) of a direction of any length from the squares of its parts along n and across. Up to 45 degrees by the series of
/// 2 artanh(sin^2 / (2 - sin^2)), whose first missing term is below 2e-8 of the sum; the floor keeps a cosine of 0 from log(0).
fn log_cosine2(along2: f32, across2: f32) -> f32 {
    if across2 > along2 {
        return log(max(along2 / (along2 + across2), 1e-37));
    }
    let z = across2 / (2.0 * along2 + across2);
    let z2 = z * z;
    let tail = 1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 * (1.0 / 11.0 + z2 / 13.0));
    return -2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * tail)));
}

/// A facet with the density D n.h of its angle: cos = (1 - u)^(1 / (m + 2)), and 1 / (m + 2) = alpha^2 / 2. Walter et al. 2007.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    // 1 - u is at least 6e-8 for the u that f32 has below 1.
    let log_cosine2 = s.alpha * s.alpha * log(max(1.0 - u.x, 1e-30));
    let sine2 = clamp(-log_cosine2 * growth(log_cosine2), 0.0, 1.0);
    return facet_toward(s, v, sqrt(sine2), exp(0.5 * log_cosine2), u.y);
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
