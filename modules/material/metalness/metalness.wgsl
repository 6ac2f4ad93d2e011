/// Metal and dielectric are mixed linearly by metalness: base colour is the albedo of one and the reflectance at
/// normal incidence of the other.
fn surface(at: Fragment) -> Surface {
    let base = base_color_modulate(vec4f(params.base_color, params.opacity), at);
    // glTF's channels: g is roughness, b is metalness.
    let factors = metallic_roughness_modulate(vec4f(1.0, params.roughness, params.metalness, 1.0), at);
    let roughness = factors.g;
    let metalness = factors.b;

    var s = bare_surface(at, perturb(at.normal, at));
    s.diffuse = base.rgb * (1.0 - metalness);
    s.diffuse_roughness = roughness;
    s.f0 = mix(vec3f(params.reflectance), base.rgb, metalness);
    s.alpha = alpha_of_roughness(roughness);
    s.widths = vec2f(s.alpha);
    s.emission = emission_modulate(vec4f(params.emission_color, 1.0), at).rgb * params.emission;
    s.opacity = base.a;
    return s;
}
