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
    let d = slope_density(s, s.widths, h) / (cosine2 * cosine2);
    let attenuation = pow(max(n_dot_v * n_dot_l, 1e-20), params.alpha_k);
    return s.diffuse * INV_PI + schlick(s.f0, 0.5 * size) * (0.5 * d / (size * attenuation));
}

/// Half vectors by D n.h, as in the paper, and the diffuse part: by how much both reflect, seen from v.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    return slope_lobe_sample(s, s.widths, lobe_share(schlick(s.f0, dot(s.normal, v)), s.diffuse), v, u);
}

/// The density of that, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return slope_lobe_pdf(s, s.widths, lobe_share(schlick(s.f0, dot(s.normal, v)), s.diffuse), v, l);
}
