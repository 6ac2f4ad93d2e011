/// diffuse / pi + f0 (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) (n.h)^n, 1/sr. Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    let n = exponent_of_alpha(s.alpha);
    let peak = (n + 2.0) / (exp2(-0.5 * n) + n) * (n + 4.0) * 0.125 * INV_PI;
    // (n.h)^2 to the power of n / 2: the square's difference to 1 is the sine's square, which a cross product has without cancellation.
    return s.diffuse * INV_PI + s.f0 * (peak * facet_power(s, v + l, n));
}

/// |n.h|^n for a half vector of any length; 1 where opposite directions have none. The sine is taken from the cross product. The floor is a length of
/// 1e-15, whose square is still a normal f32.
fn facet_power(s: Surface, h: vec3f, n: f32) -> f32 {
    let across = cross(s.normal, h);
    let along = dot(s.normal, h);
    let square = max(dot(across, across) + along * along, 1e-30);
    return exp(0.5 * n * log_rest(dot(across, across) / square, along * along / square));
}

/// The mirror direction about a half vector by its cosine's power, or a direction by the cosine to the normal.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s.f0, s.diffuse);
    if u.x < share {
        return reflect(-v, cosine_power_sample(s.normal, exponent_of_alpha(s.alpha), vec2f(u.x / share, u.y)));
    }
    return diffuse_sample(s.normal, u, share);
}

/// (n + 1) / (2 pi) |n.h|^n with the Jacobian of the mirror 1 / (4 |v.h|), and the cosine's density, each by its share, 1/sr. A half vector drawn on
/// the far side of v gives l below the horizon, and there v + l points into the surface: so without a sign.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let n = exponent_of_alpha(s.alpha);
    let h = v + l;
    // v.h = |v + l| / 2. Where l is opposite to v no half vector mirrors one into the other.
    let lobe = (n + 1.0) * 0.25 * INV_PI * facet_power(s, h, n) / max(length(h), 1e-12);
    return mix(cosine_pdf(s.normal, l), lobe, lobe_share(s.f0, s.diffuse));
}
