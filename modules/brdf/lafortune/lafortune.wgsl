/// diffuse / pi + f0 (n + 2) / (2 pi) (Cx lx vx + Cy ly vy + Cz lz vz)^n, 1/sr (Lafortune et al. 1997). Zero where either direction is below the horizon of the
/// shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if dot(s.normal, v) <= 0.0 || dot(s.normal, l) <= 0.0 {
        return vec3f(0.0);
    }
    let n = exponent(s);
    return s.diffuse * INV_PI + s.f0 * ((n + 2.0) * 0.5 * INV_PI * cosine_power(dot(coefficients() * local_of(s, l), local_of(s, v)), from_lobe(s, v, l), n));
}

/// 1 - (Cx lx vx + Cy ly vy + Cz lz vz) for unit vectors and C in [-1, 1], as a sum of positive terms:
/// half of |C| (l sign(C) - v)^2 + (1 - |C|) (l^2 + v^2) over the three components.
fn from_lobe(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let c = coefficients();
    let a = local_of(s, l);
    let b = local_of(s, v);
    let chord = a * sign(c) - b;
    return 0.5 * (dot(abs(c), chord * chord) + dot(1.0 - abs(c), a * a + b * b));
}

fn coefficients() -> vec3f {
    return vec3f(params.cx, params.cy, params.cz);
}

/// Components along the tangent, across it, and along the normal.
fn local_of(s: Surface, d: vec3f) -> vec3f {
    return vec3f(dot(s.tangent, d), dot(cross(s.normal, s.tangent), d), dot(s.normal, d));
}

/// The lobe's axis: C v at unit length; the normal where C v has none.
fn axis_of(s: Surface, v: vec3f) -> vec3f {
    let scaled = coefficients() * local_of(s, v);
    return unit_or(s.tangent * scaled.x + cross(s.normal, s.tangent) * scaled.y + s.normal * scaled.z, s.normal);
}

/// Phong's exponent of a lobe as wide as facets of this alpha: 2 / alpha^2 - 2, without the difference of two numbers near each other.
/// The floor is far below what a surface has, and its square is still a normal f32.
fn exponent(s: Surface) -> f32 {
    let alpha = max(s.alpha, 1e-12);
    return max(2.0 * (1.0 - alpha) * (1.0 + alpha) / (alpha * alpha), 0.0);
}

/// The n-th power of a cosine of which also the difference to 1 is known, x; 0 where it is not above 0, n = 0 included.
///
/// With exponents of 1e8 an error of 6e-8 in the cosine would be all, so near 1 the logarithm is taken of x itself: -ln(1 - x) =
/// 2 artanh(x / (2 - x)), whose four terms leave 2e-8 for x below 1/4. The floor keeps the logarithm normal.
fn cosine_power(cosine: f32, x: f32, n: f32) -> f32 {
    if cosine <= 0.0 {
        return 0.0;
    }
    let z = x / (2.0 - x);
    let z2 = z * z;
    let near = 2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (0.2 + z2 / 7.0)));
    return exp(-n * select(-log(max(cosine, 1e-30)), near, x < 0.25));
}

/// Share of the samples that the lobe draws, the others the diffuse part: by their colours. The floor keeps black from 0 / 0.
fn lobe_share(s: Surface) -> f32 {
    let lobe = luminance(s.f0);
    return lobe / max(lobe + luminance(s.diffuse), 1e-20);
}

/// Around C v by the cosine's power, of which the lobe is a multiple, or a direction by the cosine to the normal.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s);
    if u.x < share {
        return lobe_sample(axis_of(s, v), exponent(s), vec2f(u.x / share, u.y));
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

/// (n + 1) / (2 pi) cos^n of the angle between C v and l, from the chord between them, and the cosine's density, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let n = exponent(s);
    let axis = axis_of(s, v);
    let chord = axis - l;
    let lobe = (n + 1.0) * 0.5 * INV_PI * cosine_power(dot(axis, l), 0.5 * dot(chord, chord), n);
    return mix(cosine_pdf(s.normal, l), lobe, lobe_share(s));
}
