/// Whether both directions are above the horizon of the unit vector n: elsewhere nothing is reflected.
fn above_horizon(n: vec3f, v: vec3f, l: vec3f) -> bool {
    return dot(n, v) > 0.0 && dot(n, l) > 0.0;
}

/// Components along the tangent, across it, and along the normal.
fn to_local(s: Surface, d: vec3f) -> vec3f {
    return vec3f(dot(s.tangent, d), dot(cross(s.normal, s.tangent), d), dot(s.normal, d));
}

/// The square of the sine of the angle between two unit vectors.
///
/// From the cross product, since 1 - cos^2 loses all digits for a small angle; and of the difference, since the products' rounding shrinks with
/// it: n x n is 0, but in 32 bits n x h is off by 6e-8 however near they are, which a lobe of width 1e-3 shows.
fn sine_square(n: vec3f, h: vec3f) -> f32 {
    let across = cross(n, h - n);
    return dot(across, across);
}

// --- Samples shared by a lobe and a diffuse part

/// Share of the samples that a lobe of this reflectance draws, the others a diffuse part of that albedo. The floor keeps black from 0 / 0.
fn lobe_share(reflected: vec3f, albedo: vec3f) -> f32 {
    let lobe = luminance(reflected);
    return lobe / max(lobe + luminance(albedo), 1e-20);
}

/// The others: for u.x in [share, 1) a direction around n by its cosine.
fn diffuse_sample(n: vec3f, u: vec2f, share: f32) -> vec3f {
    return cosine_sample(n, vec2f((u.x - share) / (1.0 - share), u.y));
}

// --- Fresnel

/// (1 - cosine)^5, multiplied out: `pow` of a base that rounding made negative is undefined.
fn schlick_weight(cosine: f32) -> f32 {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return x2 * x2 * x;
}

/// f0 + (1 - f0) (1 - cosine)^5. Schlick 1994, eq. 15.
fn schlick(f0: vec3f, cosine: f32) -> vec3f {
    return f0 + (1.0 - f0) * schlick_weight(cosine);
}

/// Fresnel's equations for unpolarised light, of the index n = (1 + q) / (1 - q) with q = sqrt(f0), by channel.
///
/// Cook and Torrance's g and c are both multiplied by 1 - q, so that no n is needed: it is infinite where f0 is 1. Their difference is
/// (n^2 - 1) / (g + c), which does not cancel where n is near 1.
fn dielectric_reflectance(f0: vec3f, cosine: f32) -> vec3f {
    let c = clamp(cosine, 0.0, 1.0);
    let kept = clamp(f0, vec3f(0.0), vec3f(1.0));
    let q = sqrt(kept);
    // 1 - q without the rounding of the root. The floor keeps f0 = 1 from 0 / 0 at the horizon; it is an index of 2e18.
    let w = max((1.0 - kept) / (1.0 + q), vec3f(1e-18));
    let g = sqrt(4.0 * q + (c * w) * (c * w));
    // 0 only where f0 and c are both 0: nothing is there that reflects.
    let sum = max(g + c * w, vec3f(1e-18));
    let difference = 4.0 * q / sum;
    let across = difference / sum;
    let ratio = (c * sum - w) / (c * difference + w);
    return min(0.5 * across * across * (1.0 + ratio * ratio), vec3f(1.0));
}

// --- Powers of a cosine

/// ln(1 - x) for x in [0, 1], of which also the rest 1 - x is known.
///
/// Below 1/2 from x itself, as -2 artanh(x / (2 - x)), whose first missing term is below 2e-8 of the sum: the powers here are up to 1e8, where the
/// 6e-8 that the rest is off would be all. Above, from the rest, whose floor is the least normal f32.
fn log_rest(x: f32, rest: f32) -> f32 {
    if x > 0.5 {
        return log(max(rest, 1.2e-38));
    }
    let z = x / (2.0 - x);
    let z2 = z * z;
    let tail = 1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 * (1.0 / 11.0 + z2 / 13.0));
    return -2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * tail)));
}

/// The n-th power of a cosine, by the cosine and its difference from 1; 0 behind the lobe, where the cosine is below 0.
fn cosine_power(cosine: f32, from_one: f32, n: f32) -> f32 {
    return select(exp(n * log_rest(from_one, cosine)), 0.0, cosine < 0.0);
}

/// The n-th power of the cosine of the angle between v and the mirror direction r of l; 0 behind the lobe.
///
/// 1 - cos is half the square of the chord r - v = 2 (n.l) n - (l + v), whose parts along the normal and across it are small where the lobe is, so
/// that nothing cancels.
fn mirror_power(s: Surface, v: vec3f, l: vec3f, n: f32) -> f32 {
    let along = dot(s.normal, l - v);
    let across = cross(s.normal, l + v);
    let from_one = 0.5 * (along * along + dot(across, across));
    return cosine_power(1.0 - from_one, from_one, n);
}

/// A direction around the unit vector `axis` with the density (n + 1) / (2 pi) cos^n.
///
/// cos = (1 - u)^(1 / (n + 1)); the floor keeps the logarithm of a u that rounding took to 1.
fn cosine_power_sample(axis: vec3f, n: f32, u: vec2f) -> vec3f {
    let log_cosine2 = 2.0 * log(max(1.0 - u.x, 5.96e-8)) / (n + 1.0);
    let sine2 = clamp(-log_cosine2 * exprel(log_cosine2), 0.0, 1.0);
    return frame_of(axis) * around(sqrt(sine2), sqrt(1.0 - sine2), u.y);
}

/// The unit vector with this sine and cosine of the angle to z, turned by u of a full turn.
fn around(sine: f32, cosine: f32, u: f32) -> vec3f {
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (2.0 * u - 1.0);
    return vec3f(sine * cos(turn), sine * sin(turn), cosine);
}

/// The relative exponential (exp(x) - 1) / x, 1 at x = 0. Within 1 of 0 by its Taylor series, whose first missing term is 3e-8: there
/// exp(x) - 1 cancels.
fn exprel(x: f32) -> f32 {
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

/// Inverse sine, relative error 1e-7, for x in [0, 0.71]: a polynomial in x^2 over half the range, since the built-in `acos` may be off by
/// 7e-5 (WGSL, floating point accuracy).
fn arcsine(x: f32) -> f32 {
    let z = x * x;
    let p = ((((((0.114312947 * z - 0.0974846855) * z + 0.0800461993) * z + 0.0154393734) * z + 0.0466496646) * z + 0.0748744085) * z
        + 0.166669294);
    return x + x * z * p;
}

// --- Facets with Gaussian slopes

/// tan^2 (cos^2 / ax^2 + sin^2 / ay^2) of a half vector of any length, of either sign: the square of its slope, in widths.
/// The floors keep 0 / 0 from widths below 1e-12 and half vectors in the surface, far outside of what a surface has. The cap, where the exponential
/// has long been 0, keeps the square in range.
fn squared_slope(s: Surface, widths: vec2f, h: vec3f) -> f32 {
    let slope = to_local(s, h).xy / (max(widths, vec2f(1e-12)) * max(abs(dot(s.normal, h)), 1e-18));
    let kept = min(abs(slope), vec2f(1e9));
    return dot(kept, kept);
}

/// e^-slope^2 / (pi ax ay), the density of a half vector's slopes; the widths are floored at 1e-12 each.
fn slope_density(s: Surface, widths: vec2f, h: vec3f) -> f32 {
    let kept = max(widths, vec2f(1e-12));
    return exp(-squared_slope(s, widths, h)) * INV_PI / (kept.x * kept.y);
}

/// The unit half vector whose slopes are normally distributed with these widths: facets drawn by Beckmann's D n.h (Ward 1992; Walter 2005).
fn slope_sample(s: Surface, widths: vec2f, u: vec2f) -> vec3f {
    // The floor keeps the logarithm of a u that rounding took to 1.
    let radius = sqrt(max(-log(max(1.0 - u.x, 5.96e-8)), 0.0));
    let slope = widths * around(radius, 0.0, u.y).xy;
    return normalize(s.normal + s.tangent * slope.x + cross(s.normal, s.tangent) * slope.y);
}

/// The mirror direction about such a half vector for this share of u.x, else a direction by the cosine.
fn slope_lobe_sample(s: Surface, widths: vec2f, share: f32, v: vec3f, u: vec2f) -> vec3f {
    if u.x < share {
        return reflect(-v, slope_sample(s, widths, vec2f(u.x / share, u.y)));
    }
    return diffuse_sample(s.normal, u, share);
}

/// Density of `slope_lobe_sample`, 1/sr: e^-slope^2 / (pi ax ay cos^3) with the Jacobian of the mirror 1 / (4 |v.h|) (Walter 2005), and the cosine's.
///
/// A half vector drawn on the far side of v gives l below the horizon, and there v + l points into the surface: so without a sign.
fn slope_lobe_pdf(s: Surface, widths: vec2f, share: f32, v: vec3f, l: vec3f) -> f32 {
    let h = v + l;
    let size = length(h);
    let diffuse = cosine_pdf(s.normal, l);
    // Where l is opposite to v no half vector mirrors one into the other; f32 has no shorter sum of unit vectors but 0.
    if size < 1e-12 {
        return (1.0 - share) * diffuse;
    }
    // v.h = |v + l| / 2. Where cos is at its floor the exponential is 0.
    let cosine = max(abs(dot(s.normal, h)) / size, 1e-8);
    return mix(diffuse, slope_density(s, widths, h) / (cosine * cosine * cosine) * 0.5 / size, share);
}

// --- Facets as v sees them

/// A facet of GGX with these widths as v sees it: where a sphere's cap is lit from the stretched v, and unstretched again. Dupuy and Benyoub 2023,
/// listing 3. Both directions in the frame of the surface, z along its normal.
fn ggx_facet(widths: vec2f, v: vec3f, u: vec2f) -> vec3f {
    let stretched = normalize(vec3f(widths * v.xy, v.z));
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let cap = around(sqrt(max(1.0 - z * z, 0.0)), z, u.x) + stretched;
    // Opposite to v the sum vanishes; it has no weight there.
    return unit_or(vec3f(widths * cap.xy, max(cap.z, 0.0)), vec3f(0.0, 0.0, 1.0));
}

/// The facet (sine, cosine) turned about n by u; by half a turn more where v sees it only so. So v sees every facet that is drawn.
fn facet_toward(s: Surface, v: vec3f, sine: f32, cosine: f32, u: f32) -> vec3f {
    let local = around(sine, cosine, u);
    let basis = frame_of(s.normal);
    let h = basis * local;
    let turned = basis * vec3f(-local.xy, cosine);
    return select(h, turned, dot(v, h) < 0.0 && dot(v, turned) > 0.0);
}

/// How often `facet_toward` draws h for once that its angle to n is: twice where v sees it but not h after half a turn, never where it is the
/// other way round.
fn facet_multiplicity(s: Surface, v: vec3f, h: vec3f) -> f32 {
    let here = dot(v, h);
    let turned = 2.0 * dot(s.normal, h) * dot(s.normal, v) - here;
    if here < 0.0 && turned > 0.0 {
        return 0.0;
    }
    return select(1.0, 2.0, here > 0.0 && turned < 0.0);
}
