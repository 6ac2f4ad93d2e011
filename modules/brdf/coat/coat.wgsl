/// The surface of the coat, for the modules that make up its lobe.
fn coated(s: Surface) -> Surface {
    var c = s;
    c.normal = s.coat_normal;
    c.alpha = s.coat_alpha;
    c.f0 = vec3f(f0_of_ior(s.coat_ior));
    c.f90 = vec3f(1.0);
    c.f82 = vec3f(1.0);
    return c;
}

/// What a smooth coat reflects of light from this direction, before its share of the surface: F at the angle to the coat's normal.
fn mirrored(c: Surface, d: vec3f) -> f32 {
    return fresnel(c, max(dot(c.normal, d), 0.0)).r;
}

/// What is left of light that goes in along l and out along v, by the lengths of both ways within the coat: the color's power of their
/// mean over the coat's thickness. The floors keep a coat of index 1 from 1 / 0 at the horizon, and a black one from the logarithm of 0.
fn passed(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let ways = 0.5 * (1.0 / refracted(s, v) + 1.0 / refracted(s, l));
    return exp2(ways * log2(max(s.coat_color, vec3f(1e-6))));
}

/// Cosine to the coat's normal after refraction into the coat (Snell's law).
fn refracted(s: Surface, d: vec3f) -> f32 {
    let across = cross(s.coat_normal, d) / s.coat_ior;
    return sqrt(max(1.0 - dot(across, across), 1e-6));
}

/// What the coat reflects, over what it lets through to the base and back, 1/sr. Of the two directions the coat reflects more of one, and so
/// much is taken off: that is reciprocal, and no more than what is left.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let c = coated(s);
    let through = 1.0 - s.coat * max(mirrored(c, v), mirrored(c, l));
    let below = base_brdf(s, v, l) * mix(vec3f(1.0), passed(s, v, l), s.coat) * through;
    let n_dot_l = dot(s.normal, l);
    let c_dot_l = dot(c.normal, l);
    if dot(c.normal, v) <= 0.0 || c_dot_l <= 0.0 || n_dot_l <= 0.0 {
        return below;
    }
    // Opposite directions, both at the horizon, have no half vector; any will do, the normal is as good.
    let h = unit_or(v + l, c.normal);
    // Lights multiply by the cosine to the shading normal; the coat is lit by that to its own.
    let own = s.coat * (c_dot_l / n_dot_l);
    // v.h and l.h, which are the same half length but differ where rounded directions at the horizon leave them no digits.
    let cosine = 0.5 * length(v + l);
    return below + fresnel(c, cosine) * (own * distribution(c, h) * masking(c, v, l, h));
}

/// Share of the samples that the coat draws: by how much it reflects, and the base, about, seen from v. The floor keeps black from 0 / 0.
fn coat_share(s: Surface, c: Surface, v: vec3f) -> f32 {
    let above = s.coat * mirrored(c, v);
    let below = (1.0 - above) * min(luminance(s.diffuse + s.f0), 1.0);
    return above / max(above + below, 1e-20);
}

/// The mirror direction about a facet of the coat that v sees, or what the base draws.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let c = coated(s);
    let share = coat_share(s, c, v);
    if u.x < share {
        return reflect(-v, facet_sample(c, v, vec2f(u.x / share, u.y)));
    }
    return base_brdf_sample(s, v, vec2f((u.x - share) / (1.0 - share), u.y));
}

/// The facets' density, by the Jacobian of the mirror 1 / (4 v.h) (Walter et al. 2007, eq. 14), and the base's, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let c = coated(s);
    let h = unit_or(v + l, c.normal);
    // Where l is opposite to v no facet mirrors one into the other.
    let facets = facet_pdf(c, v, h) / max(4.0 * dot(v, h), 1e-12);
    return mix(base_brdf_pdf(s, v, l), facets, coat_share(s, c, v));
}
