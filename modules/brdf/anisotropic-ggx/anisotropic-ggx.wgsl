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
    return reflected(s, 0.5 * length(v + l)) * (distribution(s, h) * visible) + s.diffuse * INV_PI;
}

/// Components along the tangent, across it, and along the normal.
fn local_of(s: Surface, d: vec3f) -> vec3f {
    return vec3f(dot(s.tangent, d), dot(cross(s.normal, s.tangent), d), dot(s.normal, d));
}

/// 1 / (pi ax ay ((h.t / ax)^2 + (h.b / ay)^2 + (h.n)^2)^2), 1/sr; 0 for h below the surface. All terms are positive. The floor is far below what
/// a surface has and keeps squares in range.
fn distribution(s: Surface, h: vec3f) -> f32 {
    let widths = max(s.widths, vec2f(1e-9));
    let local = local_of(s, h);
    let scaled = vec3f(local.xy / widths, local.z);
    let k = 1.0 / dot(scaled, scaled);
    return select(0.0, k * k * INV_PI / (widths.x * widths.y), local.z > 0.0);
}

/// sqrt((ax d.t)^2 + (ay d.b)^2 + (d.n)^2): (2 Lambda + 1) n.d, the tangents multiplied out.
fn projected(s: Surface, d: vec3f) -> f32 {
    let local = local_of(s, d);
    return length(vec3f(s.widths * local.xy, local.z));
}

/// f0 + (1 - f0) (1 - cosine)^5 (Schlick 1994, eq. 15), multiplied out: `pow` of a base that rounding made negative is undefined.
fn reflected(s: Surface, cosine: f32) -> vec3f {
    let x = clamp(1.0 - cosine, 0.0, 1.0);
    let x2 = x * x;
    return s.f0 + (1.0 - s.f0) * (x2 * x2 * x);
}

/// Share of the samples that facets draw, the others the diffuse part: by how much they reflect, seen from v. The floor keeps black from 0 / 0.
fn facet_share(s: Surface, v: vec3f) -> f32 {
    let facets = luminance(reflected(s, dot(s.normal, v)));
    return facets / max(facets + luminance(s.diffuse), 1e-20);
}

/// The mirror direction about a facet that v sees, or a direction by the cosine. The facet: where a sphere's cap is lit from the stretched v,
/// unstretched again (Dupuy and Benyoub 2023, listing 3, with two widths).
fn brdf_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {
    let share = facet_share(s, v);
    if u.x >= share {
        return cosine_sample(s.normal, vec2f((u.x - share) / (1.0 - share), u.y));
    }
    let local = local_of(s, v);
    let stretched = normalize(vec3f(s.widths * local.xy, local.z));
    let turn = 2.0 * PI * (u.x / share);
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let radius = sqrt(max(1.0 - z * z, 0.0));
    let cap = vec3f(radius * cos(turn), radius * sin(turn), z) + stretched;
    // Opposite to v the sum vanishes; it has no weight there.
    let h = unit_or(vec3f(s.widths * cap.xy, max(cap.z, 0.0)), vec3f(0.0, 0.0, 1.0));
    return reflect(-v, s.tangent * h.x + cross(s.normal, s.tangent) * h.y + s.normal * h.z);
}

/// G1(v) v.h D / n.v (Heitz 2014, eq. 16) with G1 = 2 n.v / (n.v + projected) and the Jacobian of the mirror 1 / (4 v.h): n.v and v.h cancel. And the
/// cosine's density, each by its share, 1/sr.
fn brdf_pdf(s: Surface, v: vec3f, l: vec3f) -> f32 {
    let h = unit_or(v + l, s.normal);
    let seen = max(dot(s.normal, v), 0.0) + projected(s, v);
    return mix(cosine_pdf(s.normal, l), 0.5 * distribution(s, h) / max(seen, 1e-12), facet_share(s, v));
}
