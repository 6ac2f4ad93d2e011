/// single (1 + F0 (1 - E) / E), E being the albedo of white facets for light from v and F0 the Fresnel term at normal incidence. E is at least
/// 0.3, so the floor is never reached by a table; it keeps an estimate from 1 / 0.
fn compensate(s: Surface, v: vec3f, l: vec3f, single: vec3f) -> vec3f {
    let lost = clamp(facet_albedo(s, dot(s.normal, v)).z, 0.0, 0.99);
    return single * (1.0 + fresnel(s, 1.0) * (lost / (1.0 - lost)));
}
