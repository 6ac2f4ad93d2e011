/// F D V + diffuse, 1/sr. Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    // Opposite directions, both at the horizon, have no half vector; any will do, the normal is as good.
    let h = unit_or(v + l, s.normal);
    let facets = distribution(s, h) * masking(s, v, l, h);
    // v.h and l.h, which are the same half length but differ where rounded directions at the horizon leave them no digits.
    let cosine = 0.5 * length(v + l);
    if params.compensated {
        return compensate(s, v, l, fresnel(s, cosine) * facets) + diffuse(s, v, l);
    }
    return fresnel(s, cosine) * facets + diffuse(s, v, l);
}

/// Share of the samples that facets draw, the others the diffuse part: by how much they reflect, seen from v.
fn share_toward(s: Surface, v: vec3f) -> f32 {
    return lobe_share(fresnel(s, dot(s.normal, v)), s.diffuse);
}

/// The mirror direction about a facet that v sees, or a direction by the cosine.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = share_toward(s, v);
    if u.x < share {
        return reflect(-v, facet_sample(s, v, vec2f(u.x / share, u.y)));
    }
    return diffuse_sample(s.normal, u, share);
}

/// The facets' density, by the Jacobian of the mirror 1 / (4 v.h) (Walter et al. 2007, eq. 14), and the cosine's, each by its share.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = unit_or(v + l, s.normal);
    // Where l is opposite to v no facet mirrors one into the other.
    let facets = facet_pdf(s, v, h) / max(4.0 * dot(v, h), 1e-12);
    return mix(cosine_pdf(s.normal, l), facets, share_toward(s, v));
}
