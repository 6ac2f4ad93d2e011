/// The base as a mixture of metal and dielectric under a coat and under fuzz.
fn surface(at: Fragment) -> Surface {
    let base = base_color_modulate(vec4f(params.base_color, params.geometry_opacity), at);
    let factors = metalness_roughness_modulate(vec4f(1.0, params.specular_roughness, params.base_metalness, 1.0), at);
    let metalness = factors.b;
    let roughness = roughness_under_coat(factors.g, params.coat_roughness, params.coat_weight);
    let base_color = params.base_weight * base.rgb;
    // Light comes from within the coat, where there is one.
    let ior = params.specular_ior / mix(1.0, params.coat_ior, params.coat_weight);
    let reflectance = min(params.specular_weight * f0_of_ior(ior), 1.0);
    // What is matte below a coat is lit by itself: the coat reflects light back down to it, again and again.
    let inner = inner_reflectance_of_ior(params.coat_ior);
    let darkened = (1.0 - inner) / (1.0 - inner * base_color);

    var s = bare_surface(at, perturb(at.normal, at));
    s.diffuse = base_color * mix(vec3f(1.0), darkened, params.coat_weight * params.coat_darkening) * (1.0 - metalness);
    s.diffuse_roughness = params.base_diffuse_roughness;
    s.f0 = mix(params.specular_color * reflectance, base_color * min(params.specular_weight, 1.0), metalness);
    // Below a reflectance of 2 % a boundary hardly has a horizon: without the factor, specular_weight 0 would leave a bright rim.
    let at_horizon = params.specular_color * min(50.0 * reflectance, 1.0);
    s.f90 = mix(at_horizon, vec3f(min(params.specular_weight, 1.0)), metalness);
    s.f82 = mix(vec3f(1.0), params.specular_color, metalness);
    s.alpha = alpha_of_roughness(roughness);
    s.widths = widths_of_anisotropy(roughness, params.specular_roughness_anisotropy);
    s.emission = emission_modulate(vec4f(params.emission_color, 1.0), at).rgb * params.emission_luminance;
    s.opacity = base.a;
    s.coat = params.coat_weight;
    s.coat_alpha = alpha_of_roughness(params.coat_roughness);
    s.coat_ior = params.coat_ior;
    s.coat_color = params.coat_color;
    s.coat_normal = coat_perturb(at.normal, at);
    s.fuzz = params.fuzz_weight;
    s.fuzz_color = params.fuzz_color;
    s.fuzz_roughness = params.fuzz_roughness;
    return s;
}
