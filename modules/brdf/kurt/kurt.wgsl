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

/// Share of the samples that the lobe draws: by how much it reflects, seen from v.
fn share_toward(s: Surface, v: vec3f) -> f32 {
    return lobe_share(schlick(s.f0, dot(s.normal, v)), s.diffuse);
}

/// The mirror direction about a half vector whose slopes are normally distributed, which is Beckmann's D times its cosine, or a direction by the cosine.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = share_toward(s, v);
    if u.x < share {
        return reflect(-v, slope_sample(s, s.widths, vec2f(u.x / share, u.y)));
    }
    return diffuse_sample(s.normal, u, share);
}

/// The half vector's density and the cosine's, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    return mix(cosine_pdf(s.normal, l), slope_mirror_pdf(s, s.widths, v, l), share_toward(s, v));
}
