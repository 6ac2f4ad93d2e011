/// F D V + diffuse / pi with GGX of two widths, Smith's masking correlated by height and Schlick's F, 1/sr. Zero where either direction is below the
/// horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    // Opposite directions, both at the horizon, have no half vector; any will do, the normal is as good.
    let h = unit_or(v + l, s.normal);
    // The floor is below what dot products of unit vectors can tell from 0; with widths of 1e-4 the peak stays in range.
    let visible = 0.5 / max(n_dot_l * projected(s, v) + n_dot_v * projected(s, l), 1e-28);
    return schlick(s.f0, 0.5 * length(v + l)) * (distribution(s, h) * visible) + s.diffuse * INV_PI;
}

/// 1 / (pi ax ay ((h.t / ax)^2 + (h.b / ay)^2 + (h.n)^2)^2), 1/sr; 0 for h below the surface. All terms are positive. The floor is far below what
/// a surface has and keeps squares in range.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let widths = max(s.widths, vec2f(1e-9));
    let local = to_local(s, h);
    let scaled = vec3f(local.xy / widths, local.z);
    let k = 1.0 / dot(scaled, scaled);
    return select(0.0, k * k * INV_PI / (widths.x * widths.y), local.z > 0.0);
}

/// sqrt((ax d.t)^2 + (ay d.b)^2 + (d.n)^2): (2 Lambda + 1) n.d, the tangents multiplied out.
fn projected(s: Surface, d: vec3f) -> f32 {
    let local = to_local(s, d);
    return length(vec3f(s.widths * local.xy, local.z));
}

/// Share of the samples that facets draw, the others the diffuse part: by how much they reflect, seen from v.
fn share_toward(s: Surface, v: vec3f) -> f32 {
    return lobe_share(schlick(s.f0, dot(s.normal, v)), s.diffuse);
}

/// The mirror direction about a facet that v sees, or a direction by the cosine.
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = share_toward(s, v);
    if u.x >= share {
        return diffuse_sample(s.normal, u, share);
    }
    let h = ggx_facet(s.widths, to_local(s, v), vec2f(u.x / share, u.y));
    return reflect(-v, s.tangent * h.x + cross(s.normal, s.tangent) * h.y + s.normal * h.z);
}

/// G1(v) v.h D / n.v (Heitz 2014, eq. 16) with G1 = 2 n.v / (n.v + projected) and the Jacobian of the mirror 1 / (4 v.h): n.v and v.h cancel. And the
/// cosine's density, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = unit_or(v + l, s.normal);
    let seen = max(dot(s.normal, v), 0.0) + projected(s, v);
    return mix(cosine_pdf(s.normal, l), 0.5 * distribution(s, h) / max(seen, 1e-12), share_toward(s, v));
}
