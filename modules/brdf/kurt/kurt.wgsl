/// diffuse / pi + F D / (4 v.h (n.v n.l)^k) with Beckmann's D of two widths and Schlick's F, 1/sr (Kurt et al. 2010). Zero where either direction is
/// below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let h = v + l;
    // v.h = |v + l| / 2. Its floor and the cosines' are below what dot products of unit vectors can tell from 0; with widths of 1e-4 the peak
    // stays in range.
    let size = max(length(h), 1e-10);
    // Opposite directions, both at the horizon, have no half vector; any will do, the normal is as good.
    let cosine = max(dot(s.normal, unit_or(h, s.normal)), 1e-8);
    let cosine2 = cosine * cosine;
    let d = exp(-slope_square(s, h)) / (cosine2 * cosine2) * INV_PI / area(s);
    let attenuation = pow(max(n_dot_v * n_dot_l, 1e-20), params.alpha_k);
    return s.diffuse * INV_PI + mirrored(s, 0.5 * size) * (0.5 * d / (size * attenuation));
}

/// f0 + (1 - f0) (1 - cosine)^5 (Schlick 1994, eq. 15), multiplied out: `pow` of a base that rounding made negative is undefined.
fn mirrored(s: Surface, cosine: f32) -> vec3f {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return s.f0 + (1.0 - s.f0) * (x2 * x2 * x);
}

/// tan^2 (cos^2 / ax^2 + sin^2 / ay^2) of a half vector of any length, of either sign: the square of its slope, in widths.
/// The floors keep 0 / 0 from widths below 1e-12 and half vectors in the surface, far outside of what a surface has. The cap, where the exponential
/// has long been 0, keeps the square in range.
fn slope_square(s: Surface, h: vec3f) -> f32 {
    let tangential = vec2f(dot(s.tangent, h), dot(cross(s.normal, s.tangent), h));
    let slope = tangential / (max(s.widths, vec2f(1e-12)) * max(abs(dot(s.normal, h)), 1e-18));
    let kept = min(abs(slope), vec2f(1e9));
    return dot(kept, kept);
}

/// ax ay, floored at 1e-12 each.
fn area(s: Surface) -> f32 {
    let widths = max(s.widths, vec2f(1e-12));
    return widths.x * widths.y;
}

/// Share of the samples that the lobe draws, the others the diffuse part: by how much they reflect, seen from v. The floor keeps black from 0 / 0.
fn lobe_share(s: Surface, v: vec3f) -> f32 {
    let lobe = luminance(mirrored(s, dot(s.normal, v)));
    return lobe / max(lobe + luminance(s.diffuse), 1e-20);
}

/// The mirror direction about a half vector whose slopes are normally distributed, which is Beckmann's D times its cosine, or a direction by the cosine.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = lobe_share(s, v);
    if u.x < share {
        // The floor keeps the logarithm of a u that rounding took to 1.
        let radius = sqrt(-log(max(1.0 - u.x / share, 5.96e-8)));
        let turn = 2.0 * PI * u.y;
        let slope = radius * s.widths * vec2f(cos(turn), sin(turn));
        return reflect(-v, normalize(s.normal + s.tangent * slope.x + cross(s.normal, s.tangent) * slope.y));
    }
    return cosine_sample(s.normal, vec2f((u.x - share) / (1.0 - share), u.y));
}

/// D n.h with the Jacobian of the mirror 1 / (4 |v.h|), as in the paper, and the cosine's density, each by its share,
/// 1/sr. A half vector drawn on the far side of v gives l below the horizon, and there v + l points into the surface: so without a sign.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = v + l;
    let size = length(h);
    let diffuse = cosine_pdf(s.normal, l);
    let share = lobe_share(s, v);
    // Where l is opposite to v no half vector mirrors one into the other; f32 has no shorter sum of unit vectors but 0.
    if size < 1e-12 {
        return (1.0 - share) * diffuse;
    }
    // v.h = |v + l| / 2. Where cos is at its floor the exponential is 0.
    let cosine = max(abs(dot(s.normal, h)) / size, 1e-8);
    let lobe = exp(-slope_square(s, h)) / (cosine * cosine * cosine) * INV_PI / area(s) * 0.5 / size;
    return mix(diffuse, lobe, share);
}
