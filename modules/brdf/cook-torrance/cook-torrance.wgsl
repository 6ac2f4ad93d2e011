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
    return dielectric_reflectance(s.f0, 0.5 * length(h)) * facets + s.diffuse * INV_PI;
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

/// Facets by D n.h (Walter et al. 2007, eqs. 28 and 29), and the diffuse part: by how much both reflect, seen from v.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return slope_lobe_sample(s, vec2f(s.alpha), lobe_share(dielectric_reflectance(s.f0, dot(s.normal, v)), s.diffuse), v, u);
}

/// The density of that, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return slope_lobe_pdf(s, vec2f(s.alpha), lobe_share(dielectric_reflectance(s.f0, dot(s.normal, v)), s.diffuse), v, l);
}
