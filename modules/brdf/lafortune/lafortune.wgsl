/// diffuse / pi + f0 (n + 2) / (2 pi) (Cx lx vx + Cy ly vy + Cz lz vz)^n, 1/sr (Lafortune et al. 1997). Zero where either direction is below the horizon of the
/// shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    let n = exponent_of_alpha(s.alpha);
    return s.diffuse * INV_PI + s.f0 * ((n + 2.0) * 0.5 * INV_PI * cosine_power(dot(coefficients() * to_local(s, l), to_local(s, v)), from_lobe(s, v, l), n));
}

/// 1 - (Cx lx vx + Cy ly vy + Cz lz vz) for unit vectors and C in [-1, 1], as a sum of positive terms:
/// half of |C| (l sign(C) - v)^2 + (1 - |C|) (l^2 + v^2) over the three components.
fn from_lobe(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let c = coefficients();
    let a = to_local(s, l);
    let b = to_local(s, v);
    let chord = a * sign(c) - b;
    return 0.5 * (dot(abs(c), chord * chord) + dot(1.0 - abs(c), a * a + b * b));
}

fn coefficients() -> vec3f {
    return vec3f(params.cx, params.cy, params.cz);
}

/// The lobe's axis: C v at unit length; the normal where C v has none.
fn axis_of(s: Surface, v: vec3f) -> vec3f {
    let scaled = coefficients() * to_local(s, v);
    return unit_or(s.tangent * scaled.x + cross(s.normal, s.tangent) * scaled.y + s.normal * scaled.z, s.normal);
}

/// Around C v by the cosine's power, of which the lobe is a multiple, or a direction by the cosine to the normal.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s.f0, s.diffuse);
    if u.x < share {
        return cosine_power_sample(axis_of(s, v), exponent_of_alpha(s.alpha), vec2f(u.x / share, u.y));
    }
    return diffuse_sample(s.normal, u, share);
}

/// (n + 1) / (2 pi) cos^n of the angle between C v and l, from the chord between them, and the cosine's density, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let n = exponent_of_alpha(s.alpha);
    let axis = axis_of(s, v);
    let chord = axis - l;
    let lobe = (n + 1.0) * 0.5 * INV_PI * cosine_power(dot(axis, l), 0.5 * dot(chord, chord), n);
    return mix(cosine_pdf(s.normal, l), lobe, lobe_share(s.f0, s.diffuse));
}
