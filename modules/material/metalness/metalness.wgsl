/// Smallest alpha, a roughness of 0.01. A narrower lobe is not resolved by unit vectors of 32-bit floats: their
/// rounding, 6e-8, is already 1/1700 of this width and an error of 5e-4 in the lobe.
const MIN_ALPHA: f32 = 1e-4;

/// Metal and dielectric are mixed linearly by metalness: base colour is the albedo of one and the reflectance at
/// normal incidence of the other.
fn surface(at: Fragment) -> Surface {
    let base = base_color_modulate(vec4f(params.base_color, params.opacity), at);
    // glTF's channels: g is roughness, b is metalness.
    let factors = metallic_roughness_modulate(vec4f(1.0, params.roughness, params.metalness, 1.0), at);
    let roughness = factors.g;
    let metalness = factors.b;

    var s: Surface;
    s.position = at.position;
    s.normal = perturb(at.normal, at);
    s.geometric_normal = at.normal;
    s.diffuse = base.rgb * (1.0 - metalness);
    s.f0 = mix(vec3f(params.reflectance), base.rgb, metalness);
    s.alpha = max(roughness * roughness, MIN_ALPHA);
    s.tangent = unit_or(at.tangent.xyz - s.normal * dot(s.normal, at.tangent.xyz), frame_of(s.normal)[0]);
    s.widths = vec2f(s.alpha);
    s.emission = emission_modulate(vec4f(params.emission_color, 1.0), at).rgb * params.emission;
    s.opacity = base.a;
    return s;
}
