/// Metal and dielectric are mixed linearly by metalness. The dielectric's reflection is of its index of refraction, weakened by a weight and
/// coloured at normal incidence; the metal's is the base colour. Over both lie a coat, where the BRDF has one, and fuzz.
fn surface(at: Fragment) -> Surface {
    let base = base_color_modulate(vec4f(params.base_color, params.opacity), at);
    // glTF's channels: g is roughness, b is metalness.
    let factors = metallic_roughness_modulate(vec4f(1.0, params.roughness, params.metalness, 1.0), at);
    let roughness = factors.g;
    let metalness = factors.b;
    let specular = specular_modulate(vec4f(1.0, 1.0, 1.0, params.specular), at).a;
    let specular_color = specular_color_modulate(vec4f(params.specular_color, 1.0), at).rgb;
    let dielectric = min(f0_of_ior(params.ior) * specular_color, vec3f(1.0)) * specular;
    let fuzz_color = fuzz_color_modulate(vec4f(params.fuzz_color, 1.0), at).rgb;

    let normal = perturb(at.normal, at);
    var s = bare_surface(at, normal);
    s.diffuse = base.rgb * (1.0 - metalness);
    s.diffuse_roughness = roughness;
    s.f0 = mix(dielectric, base.rgb, metalness);
    s.f90 = vec3f(mix(specular, 1.0, metalness));
    s.alpha = alpha_of_roughness(roughness);
    s.widths = widths_of_strength(roughness, params.anisotropy);
    s.tangent = turned_tangent(at, normal, params.anisotropy_rotation);
    s.emission = emission_modulate(vec4f(params.emission_color, 1.0), at).rgb * params.emission;
    s.opacity = base.a;
    s.coat = coat_modulate(vec4f(params.coat), at).r;
    s.coat_alpha = alpha_of_roughness(coat_roughness_modulate(vec4f(params.coat_roughness), at).g);
    s.coat_normal = coat_perturb(at.normal, at);
    // The largest channel is the weight; the floor keeps black from 0 / 0.
    s.fuzz = max(fuzz_color.r, max(fuzz_color.g, fuzz_color.b));
    s.fuzz_color = fuzz_color / max(s.fuzz, 1e-30);
    s.fuzz_roughness = fuzz_roughness_modulate(vec4f(params.fuzz_roughness), at).a;
    return s;
}
