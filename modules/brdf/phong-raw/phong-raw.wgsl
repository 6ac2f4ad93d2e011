/// (diffuse + f0 cos^n) / pi with the angle between v and the mirror direction of l, 1/sr. Zero where either direction is below the horizon of the
/// shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    let n = exponent_of_alpha(s.alpha);
    return s.diffuse * INV_PI + s.f0 * (INV_PI * mirror_power(s, v, l, n));
}

/// Around the mirror direction of v by the lobe's own cosine, or a direction by the cosine to the normal.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s.f0, s.diffuse);
    if u.x < share {
        return cosine_power_sample(reflect(-v, s.normal), exponent_of_alpha(s.alpha), vec2f(u.x / share, u.y));
    }
    return diffuse_sample(s.normal, u, share);
}

/// (n + 1) / (2 pi) cos^n and the cosine's density, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let n = exponent_of_alpha(s.alpha);
    let lobe = (n + 1.0) * 0.5 * INV_PI * mirror_power(s, v, l, n);
    return mix(cosine_pdf(s.normal, l), lobe, lobe_share(s.f0, s.diffuse));
}
