/// 1 / sqrt(pi): the density of a Gaussian slope at 0, in units of alpha.
const INV_SQRT_PI: f32 = 0.564189583547756;

/// exp(-tan^2 / alpha^2) / (pi alpha^2 cos^4), 1/sr, of the angle between n and h.
///
/// The sine is taken from the cross product: 1 - cos^2 loses all digits where the lobe of a smooth surface lies. Half the exponent is
/// taken and squared, so that nothing is out of the range of f32 before the exponential is 0. The floors stand for alpha = 1e-12 and
/// for a cosine of 1e-9, less than unit vectors can tell from 0; they keep alpha = 0 and the horizon from 0 / 0.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let cosine = dot(s.normal, h);
    let alpha = max(s.alpha, 1e-12);
    let cosine2 = max(cosine * cosine, 1e-18);
    let slope2 = sine_square(s.normal, h) / max(alpha * alpha * cosine2, 1e-30);
    let k = exp(-0.5 * slope2) / (alpha * cosine2);
    return select(0.0, k * k * INV_PI, cosine > 0.0);
}

/// A facet as v sees it (Heitz and d'Eon 2014, section 4): the slopes of a surface of alpha 1, seen from v stretched by alpha, along
/// v and across.
fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let basis = frame_of(s.normal);
    let local = v * basis;
    let toward = stretched(s, v);
    let along = slope_above(toward.x, toward.y, u.x);
    let across = slope_above(1.0, 0.0, u.y);
    // Of a v along the normal any direction will do.
    let side = unit_or(vec3f(local.xy, 0.0), vec3f(1.0, 0.0, 0.0)).xy;
    let slope = s.alpha * (along * side + across * vec2f(-side.y, side.x));
    return basis * normalize(vec3f(slope, 1.0));
}

/// D v.h over the projected area of the facets that v sees, 1/sr. Heitz 2014, eq. 16. 0 where h is turned from v.
fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let toward = stretched(s, v);
    let area = toward.z * seen_above(toward.x, toward.y, lowest_slope(toward.x, toward.y));
    return distribution(s, h) * max(dot(v, h), 0.0) / max(area, 1e-12);
}

/// Cosine and sine of the angle of v to n on a surface that is stretched to alpha 1, and the length that v has there. The floor is
/// for v below the horizon, or along it and alpha 0.
fn stretched(s: Surface, v: vec3f) -> vec3f {
    let tangential = s.alpha * length(cross(s.normal, v));
    let normal = max(dot(s.normal, v), 0.0);
    let size = max(length(vec2f(tangential, normal)), 1e-12);
    return vec3f(normal / size, tangential / size, size);
}

/// The slope toward v from which facets are seen; -5 where that is less: beyond 5 are 2e-12 of the slopes.
fn lowest_slope(cosine: f32, sine: f32) -> f32 {
    return -min(cosine / max(sine, 1e-6), 5.0);
}

/// Projected area of the facets whose slope toward v is above x: cos erfc(x) / 2 + sin exp(-x^2) / (2 sqrt(pi)).
fn seen_above(cosine: f32, sine: f32, x: f32) -> f32 {
    return cosine * slopes_above(x) + 0.5 * INV_SQRT_PI * sine * exp(-x * x);
}

/// erfc(x) / 2, the share of Gaussian slopes above x. For x above 0 exp(-x^2) times a polynomial in t = 1 / (1 + x / 2), fitted for
/// this module: the largest relative error for x in [0, 5.2] is 4e-7.
fn slopes_above(x: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * abs(x));
    let high = 0.012275627 + t * (0.4246231 + t * (-0.38162967 + t * 0.095196331));
    let p = 0.28247871 + t * (0.27565447 + t * (0.29140178 + t * high));
    let tail = 0.5 * exp(-x * x) * t * p;
    return select(tail, 1.0 - tail, x < 0.0);
}

/// The slope toward v above which the given share of the projected area lies.
///
/// The area's logarithm is concave in the slope, so Newton's method comes to it from above and converges; bounds halfway to either
/// end catch its first step, which starts below. With v along the normal this is the quantile of a Gaussian.
fn slope_above(cosine: f32, sine: f32, share: f32) -> f32 {
    let lowest = lowest_slope(cosine, sine);
    // Shares below 1e-9 are steeper than 4: f32 has none between that and 0 here.
    let goal = log(max(share, 1e-9) * seen_above(cosine, sine, lowest));
    var x = max(lowest + 1.0, 0.0);
    for (var i = 0; i < 10; i++) {
        let area = seen_above(cosine, sine, x);
        // The least slope of the area is exp(-25) / sqrt(pi) times the distance to where it is 0.
        let density = max((cosine + x * sine) * exp(-x * x) * INV_SQRT_PI, 1e-25);
        x = clamp(x + (log(area) - goal) * area / density, 0.5 * (x + lowest), 0.5 * (x + 5.0));
    }
    return x;
}
