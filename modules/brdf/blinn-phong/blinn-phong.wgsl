/// diffuse / pi + f0 (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)) (n.h)^n, 1/sr. Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if dot(s.normal, v) <= 0.0 || dot(s.normal, l) <= 0.0 {
        return vec3f(0.0);
    }
    let n = exponent(s);
    let peak = (n + 2.0) / (exp2(-0.5 * n) + n) * (n + 4.0) * 0.125 * INV_PI;
    // (n.h)^2 to the power of n / 2: the square's difference to 1 is the sine's square, which a cross product has without cancellation.
    return s.diffuse * INV_PI + s.f0 * (peak * facet_power(s, v + l, n));
}

/// Phong's exponent of a lobe as wide as facets of this alpha: 2 / alpha^2 - 2, without the difference of two numbers near each other.
/// The floor is far below what a surface has, and its square is still a normal f32.
fn exponent(s: Surface) -> f32 {
    let alpha = max(s.alpha, 1e-12);
    return max(2.0 * (1.0 - alpha) * (1.0 + alpha) / (alpha * alpha), 0.0);
}

/// (n.h)^n for a half vector of any length, of either sign; 1 where opposite directions have none.
///
/// With exponents of 1e8 an error of 6e-8 in the cosine would be all, so near the normal the logarithm is taken of the sine's square x, which a
/// cross product has without cancellation: -ln(1 - x) = 2 artanh(x / (2 - x)), whose four terms leave 2e-8 for x below 1/4. The floor of h.h
/// is a length of 1e-15, whose square is still a normal f32; that of the logarithm is a cosine of 1e-15.
fn facet_power(s: Surface, h: vec3f, n: f32) -> f32 {
    let square = max(dot(h, h), 1e-30);
    let across = cross(s.normal, h);
    let cosine = dot(s.normal, h);
    let x = dot(across, across) / square;
    let z = x / (2.0 - x);
    let z2 = z * z;
    let near = 2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (0.2 + z2 / 7.0)));
    return exp(-0.5 * n * select(-log(clamp(cosine * cosine / square, 1e-30, 1.0)), near, x < 0.25));
}

/// Share of the samples that the lobe draws, the others the diffuse part: by their colours. The floor keeps black from 0 / 0.
fn lobe_share(s: Surface) -> f32 {
    let lobe = luminance(s.f0);
    return lobe / max(lobe + luminance(s.diffuse), 1e-20);
}

/// The mirror direction about a half vector by its cosine's power, or a direction by the cosine to the normal.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s);
    if u.x < share {
        return reflect(-v, lobe_sample(s.normal, exponent(s), vec2f(u.x / share, u.y)));
    }
    return cosine_sample(s.normal, vec2f((u.x - share) / (1.0 - share), u.y));
}

/// A direction around the unit vector `axis` with the density (n + 1) / (2 pi) cos^n.
///
/// cos = (1 - u)^(1 / (n + 1)); the sine's square 1 - exp(-y) is a series where y is small, which it is for every smooth surface: its sixth
/// term is below 2e-8 for y < 1/10. The floor keeps the logarithm of a u that rounding took to 1.
fn lobe_sample(axis: vec3f, n: f32, u: vec2f) -> vec3f {
    let y = -2.0 * log(max(1.0 - u.x, 5.96e-8)) / (n + 1.0);
    let near = y * (1.0 - y * (0.5 - y * (1.0 / 6.0 - y * (1.0 / 24.0 - y / 120.0))));
    let sine2 = select(1.0 - exp(-y), near, y < 0.1);
    let turn = 2.0 * PI * u.y;
    return frame_of(axis) * vec3f(sqrt(sine2) * vec2f(cos(turn), sin(turn)), sqrt(max(1.0 - sine2, 0.0)));
}

/// (n + 1) / (2 pi) |n.h|^n with the Jacobian of the mirror 1 / (4 |v.h|), and the cosine's density, each by its share, 1/sr. A half vector drawn on
/// the far side of v gives l below the horizon, and there v + l points into the surface: so without a sign.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let n = exponent(s);
    let h = v + l;
    // v.h = |v + l| / 2. Where l is opposite to v no half vector mirrors one into the other.
    let lobe = (n + 1.0) * 0.25 * INV_PI * facet_power(s, h, n) / max(length(h), 1e-12);
    return mix(cosine_pdf(s.normal, l), lobe, lobe_share(s));
}
