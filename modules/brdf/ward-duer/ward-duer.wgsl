/// diffuse / pi + f0 e^-slope^2 / (4 pi ax ay n.v n.l): Ward's lobe without the root (Duer 2006),
/// 1/sr. Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    // The floor is that of two cosines of 1e-15, less than dot products of unit vectors can tell from 0; with widths of 1e-4 the peak stays
    // in range.
    let spread = 0.25 / max(n_dot_v * n_dot_l, 1e-30);
    return s.diffuse * INV_PI + s.f0 * (spread * slope_density(s, s.widths, v + l));
}

/// As Ward's: half vectors with normally distributed slopes (Walter 2005), and the diffuse part.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return slope_lobe_sample(s, s.widths, lobe_share(s.f0, s.diffuse), v, u);
}

/// The density of that, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return slope_lobe_pdf(s, s.widths, lobe_share(s.f0, s.diffuse), v, l);
}
