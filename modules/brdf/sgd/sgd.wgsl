/// (rho_d + rho_s F D G / (n.v n.l)) / pi per channel, 1/sr (Bagher et al. 2012). Zero where either direction is below the horizon of the shading
/// normal. Of the surface only the normal is looked at: the parameters are the material.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let h = v + l;
    // v.h = |v + l| / 2. The floor is below what dot products of unit vectors can tell from 0, and keeps all in range.
    let shadowed = visible(n_dot_v) * visible(n_dot_l) / max(n_dot_v * n_dot_l, 1e-20);
    let facets = params.rho_s * reflected(0.5 * length(h)) * distribution(slope_square(s, h)) * shadowed;
    return (params.rho_d + facets) * INV_PI;
}

/// tan^2 of the angle between n and a half vector of any length, of either sign. The cap, where all distributions here are 0, keeps squares in range.
fn slope_square(s: Surface, h: vec3f) -> f32 {
    let across = cross(s.normal, h);
    let along = dot(s.normal, h);
    return min(dot(across, across) / max(along * along, 1e-36), 1e15);
}

/// kappa e^-x / (pi x^p cos^4) with x = alpha + tan^2 / alpha: the shifted gamma distribution. 1 / cos^2 is 1 + tan^2.
fn distribution(tan2: f32) -> vec3f {
    let x = params.alpha + tan2 / params.alpha;
    return params.kappa * (exp(-x) * (1.0 + tan2)) * (1.0 + tan2) * INV_PI * pow(x, -params.p);
}

/// f0 - f1 cosine + (1 - f0) (1 - cosine)^5: Schlick's term with a correction that was fitted. Not below 0, where fits can get.
fn reflected(cosine: f32) -> vec3f {
    return max(schlick(params.f0, cosine) - params.f1 * cosine, vec3f(0.0));
}

/// G1 = 1 + lambda (1 - exp(c max(theta - theta_0, 0)^k)), within [0, 1].
///
/// The power is taken in the logarithm and capped at e^4.4 = 81, where exp is still a number and G1 has long been 0. The floor of the base, 1e-30, is 0 for
/// any k of 1 and more.
fn visible(cosine: f32) -> vec3f {
    let base = max(vec3f(arccos(cosine)) - params.theta_0, vec3f(1e-30));
    let power = exp(min(params.k * log(base) + log(params.c), vec3f(4.4)));
    return clamp(1.0 + params.lambda * (1.0 - exp(power)), vec3f(0.0), vec3f(1.0));
}

/// Angle with this cosine in [0, 1], within 2e-8 (Abramowitz and Stegun 1964, eq. 4.4.46). WGSL's own may be off by 7e-5, which the 42nd power shows.
fn arccos(cosine: f32) -> f32 {
    let x = min(cosine, 1.0);
    let near = 0.0889789874 + x * (-0.0501743046 + x * (0.0308918810 + x * (-0.0170881256 + x * (0.0066700901 + x * -0.0012624911))));
    return sqrt(1.0 - x) * (1.5707963050 + x * (-0.2145988016 + x * near));
}

/// Share of the samples that facets draw, the others the diffuse part: by how much they reflect, seen from v, and never all or nothing, since the density
/// of the facets is only near theirs.
fn share_toward(s: Surface, v: vec3f) -> f32 {
    let facets = params.rho_s * reflected(clamp(dot(s.normal, v), 0.0, 1.0));
    return clamp(lobe_share(facets, params.rho_d), 0.1, 0.9);
}

/// Mean of the channels' alpha.
fn width() -> f32 {
    return dot(params.alpha, vec3f(1.0 / 3.0));
}

/// The mirror direction about a facet, or a direction by the cosine. Half of the facets are drawn by GGX of the width alpha, which has the core of
/// the distribution, half by Beckmann of the width sqrt(alpha), which has its tail e^-(tan^2 / alpha).
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = share_toward(s, v);
    if u.x >= share {
        return diffuse_sample(s.normal, u, share);
    }
    let twice = 2.0 * u.x / share;
    // The floors keep logarithm and quotient of a u that rounding took to 1.
    let core = width() * sqrt(twice / max(1.0 - twice, 5.96e-8));
    let tail = sqrt(-width() * log(max(2.0 - twice, 5.96e-8)));
    let slope = select(tail, core, twice < 1.0);
    return reflect(-v, frame_of(s.normal) * normalize(around(slope, 1.0, u.y)));
}

/// Both D n.h with the Jacobian of the mirror 1 / (4 |v.h|), and the cosine's density, each by its share, 1/sr. A facet drawn on the far side of v gives l
/// below the horizon, and there v + l points into the surface: so without a sign.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = v + l;
    let a = width();
    let tan2 = slope_square(s, h);
    // 1 / cos^3. GGX has it in its denominator, where it cannot overflow.
    let ggx = a * a / ((a * a + tan2) * (a * a + tan2));
    let beckmann = exp(-tan2 / a) / a;
    let secant = sqrt(1.0 + tan2);
    let facets = 0.5 * INV_PI * (ggx + beckmann) * secant * secant * secant;
    // v.h = |v + l| / 2. Where l is opposite to v no facet mirrors one into the other.
    return mix(cosine_pdf(s.normal, l), facets * 0.5 / max(length(h), 1e-12), share_toward(s, v));
}
