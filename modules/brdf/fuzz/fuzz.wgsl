/// Share of light from the direction with this cosine that white fuzz scatters back: Hill's fit of a Gaussian. It lies below 0 by 2e-5 in
/// places.
fn albedo(cosine: f32, y: f32) -> f32 {
    let width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y));
    let middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y);
    let floor_value = y * (0.000654023 + y * (-0.0207818 + 0.119681 * y)) / (1.26264 + y * (-1.92021 + y));
    let t = (cosine - middle) / width;
    return clamp(exp(-0.5 * t * t) / (width * 2.50662827463) + floor_value, 0.0, 1.0);
}

/// Roughness at which the fit holds: of smoother fuzz the tables have nothing.
fn fitted(s: Surface) -> f32 {
    return clamp(s.fuzz_roughness, 0.01, 1.0);
}

/// The matrix that makes a cosine lobe of the fuzz's: its stretch in the plane, and its shear by the height (Hill's fits), for the eye's cosine.
fn stretch(cosine: f32, y: f32) -> vec2f {
    let x = clamp(cosine, 0.0, 1.0);
    let a = (2.58126 * x + 0.813703 * y) * y / (1.0 + 0.310327 * x * x + 2.60994 * x * y);
    let b = sqrt(1.0 - x) * (y - 1.0) * y * y * y / (0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y);
    return vec2f(a, b);
}

/// Direction across the normal in which v lies; along the normal any, for there the lobe is round.
///
/// By way of the cross product, which lies in the surface however near v is to the normal: what is left of v without its part along the normal is there rounding,
/// along the normal itself.
fn toward(s: Surface, v: vec3f) -> vec3f {
    return cross(unit_or(cross(s.normal, v - s.normal), frame_of(s.normal)[1]), s.normal);
}

/// Density of the lobe over the cosine, times pi: a^2 / |M l|^4, the cosine cancelled.
fn lobe(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let m = stretch(dot(s.normal, v), fitted(s));
    let x = toward(s, v);
    let n_dot_l = dot(s.normal, l);
    let local = vec3f(m.x * dot(x, l) + m.y * n_dot_l, m.x * dot(cross(s.normal, x), l), n_dot_l);
    let square = dot(local, local);
    // Only where l lies along the horizon and the lobe is stretched to a line is this near 0; fitted widths keep it above 1e-5.
    let k = m.x / max(square, 1e-12);
    return k * k;
}

/// Share of the light from v that the fuzz does not let through.
fn covered(s: Surface, v: vec3f) -> f32 {
    return s.fuzz * albedo(max(dot(s.normal, v), 0.0), fitted(s));
}

/// What the fuzz scatters, and what it lets through to the base, 1/sr. Zero where either direction is below the horizon, but for the base.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let caught = covered(s, v);
    let below = base_brdf(s, v, l) * (1.0 - caught);
    if dot(s.normal, v) <= 0.0 || dot(s.normal, l) <= 0.0 {
        return below;
    }
    return below + s.fuzz_color * (caught * INV_PI * lobe(s, v, l));
}

/// Share of the samples that the fuzz draws. The floor keeps black from 0 / 0.
fn fuzz_share(s: Surface, v: vec3f) -> f32 {
    let caught = covered(s, v);
    let above = caught * luminance(s.fuzz_color);
    let below = (1.0 - caught) * min(luminance(s.diffuse + s.f0), 1.0);
    return above / max(above + below, 1e-20);
}

/// A cosine lobe's direction, put through the inverse of the matrix; or what the base draws.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = fuzz_share(s, v);
    if u.x >= share {
        return base_brdf_sample(s, v, vec2f((u.x - share) / (1.0 - share), u.y));
    }
    let m = stretch(dot(s.normal, v), fitted(s));
    let x = toward(s, v);
    let c = cosine_sample(vec3f(0.0, 0.0, 1.0), vec2f(u.x / share, u.y));
    let local = vec3f((c.x - m.y * c.z) / m.x, c.y / m.x, c.z);
    return unit_or(x * local.x + cross(s.normal, x) * local.y + s.normal * local.z, s.normal);
}

/// The lobe's density and the base's, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let own = INV_PI * max(dot(s.normal, l), 0.0) * lobe(s, v, l);
    return mix(base_brdf_pdf(s, v, l), own, fuzz_share(s, v));
}
