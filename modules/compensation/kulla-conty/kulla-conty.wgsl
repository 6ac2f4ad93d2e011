/// Mean of the Fresnel term over the hemisphere, weighted with the cosine: 2 times the integral of F(m) m, by Gauss-Legendre with 4 nodes (Abramowitz
/// and Stegun 1964, table 25.4), which has polynomials up to degree 7, Schlick's among them, exactly.
fn fresnel_mean(s: Surface) -> vec3f {
    let low = fresnel(s, 0.0694318442) * 0.0241522034 + fresnel(s, 0.3300094782) * 0.2152140823;
    return low + fresnel(s, 0.6699905218) * 0.4369310726 + fresnel(s, 0.9305681558) * 0.3237026417;
}

/// single + F_ms (1 - E(v)) (1 - E(l)) / (pi (1 - E_mean)).
///
/// Of the light that is lost, a share F_mean (1 - E_mean) of what hits facets again is lost again, and so on: the series sums to
/// F_ms = F_mean^2 E_mean / (1 - F_mean (1 - E_mean)), 1 for white facets. Where nothing is lost, the floor keeps 0 / 0 from the smoothest surface: the
/// mean of alpha 1e-4 is 5e-8.
fn compensate(s: Surface, v: vec3f, l: vec3f, single: vec3f) -> vec3f {
    let lost = facet_albedo_mean(s).z;
    let lobe = facet_albedo(s, dot(s.normal, v)).z * facet_albedo(s, dot(s.normal, l)).z * INV_PI / max(lost, 1e-12);
    let f = fresnel_mean(s);
    return single + f * f * (1.0 - lost) / (1.0 - f * lost) * lobe;
}
