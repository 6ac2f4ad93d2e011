/// diffuse / pi + F D G / (4 n.v n.l) with Beckmann's D, the V-cavities' G and the Fresnel equations, 1/sr. Zero where either direction is below the
/// horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let h = v + l;
    let facets = beckmann(s, h) * cavities(n_dot_v, n_dot_l, h);
    // v.h = |v + l| / 2
    return reflected(s.f0, min(0.5 * length(h), 1.0)) * facets + s.diffuse * INV_PI;
}

/// e^-(tan / alpha)^2 / (pi alpha^2 cos^4) of the angle between n and a half vector of any length, of either sign.
///
/// The sine is taken from the cross product, which cancels nothing. The cap keeps the slope's square in range, the floor of the cosine its fourth
/// power: the exponential is 0 long before either. The floor of alpha is far below what a surface has.
fn beckmann(s: Surface, sum: vec3f) -> f32 {
    let alpha = max(s.alpha, 1e-12);
    // Opposite directions have no half vector; any will do, the normal is as good.
    let h = unit_or(sum, s.normal);
    let cosine = max(abs(dot(s.normal, h)), 1e-8);
    let slope = min(length(cross(s.normal, h)) / (alpha * cosine), 1e9);
    let square = cosine * cosine;
    return exp(-slope * slope) / (square * square) * INV_PI / (alpha * alpha);
}

/// G / (4 n.v n.l), G = min(1, 2 n.h n.v / v.h, 2 n.h n.l / v.h).
///
/// n.h / v.h = 2 (n.v + n.l) / |v + l|^2, and the smaller cosine is divided out of the minimum, so nothing is 0 / 0 at the horizon. The floors
/// are below what dot products of unit vectors can tell from 0.
fn cavities(n_dot_v: f32, n_dot_l: f32, h: vec3f) -> f32 {
    let low = max(min(n_dot_v, n_dot_l), 1e-15);
    let high = max(max(n_dot_v, n_dot_l), 1e-15);
    let edge = 4.0 * (low + high) / max(dot(h, h), 1e-30);
    return 0.25 * min(1.0 / low, edge) / high;
}

/// The Fresnel equations of a dielectric with this reflectance at normal incidence, its index being (1 + sqrt f0) / (1 - sqrt f0).
///
/// With r = sqrt f0 all terms of Cook and Torrance are multiplied by 1 - r, so that f0 = 1, an infinite index, is one value like others, and
/// g - c = 4 r / (g + c) does not cancel. The floors are for f0 = 0 and for f0 = 1 at the horizon, where the terms are 0 / 0.
fn reflected(f0: vec3f, cosine: f32) -> vec3f {
    let r = sqrt(f0);
    let m = 1.0 - r;
    let c = m * cosine;
    let sum = max(sqrt(4.0 * r + c * c) + c, vec3f(1e-18));
    let difference = 4.0 * r / sum;
    let a = difference / sum;
    let across = max(cosine, 1e-8);
    let b = (across * sum - m) / (across * difference + m);
    return 0.5 * a * a * (1.0 + b * b);
}

/// Share of the samples that facets draw, the others the diffuse part: by how much they reflect, seen from v. The floor keeps black from 0 / 0.
fn facet_share(s: Surface, v: vec3f) -> f32 {
    let facets = luminance(reflected(s.f0, clamp(dot(s.normal, v), 0.0, 1.0)));
    return facets / max(facets + luminance(s.diffuse), 1e-20);
}

/// The mirror direction about a facet drawn by D n.h (Walter et al. 2007, eqs. 28 and 29), or a direction by the cosine.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = facet_share(s, v);
    if u.x < share {
        // The floor keeps the logarithm of a u that rounding took to 1.
        let slope = s.alpha * sqrt(-log(max(1.0 - u.x / share, 5.96e-8)));
        let turn = 2.0 * PI * u.y;
        return reflect(-v, frame_of(s.normal) * normalize(vec3f(slope * cos(turn), slope * sin(turn), 1.0)));
    }
    return cosine_sample(s.normal, vec2f((u.x - share) / (1.0 - share), u.y));
}

/// D n.h with the Jacobian of the mirror 1 / (4 |v.h|), and the cosine's density, each by its share, 1/sr. A facet drawn on the far side of v gives l
/// below the horizon, and there v + l points into the surface: so without a sign.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = v + l;
    // v.h = |v + l| / 2. Where l is opposite to v no facet mirrors one into the other.
    let size = max(length(h), 1e-12);
    let facets = beckmann(s, h) * abs(dot(s.normal, h)) / size * 0.5 / size;
    return mix(cosine_pdf(s.normal, l), facets, facet_share(s, v));
}
