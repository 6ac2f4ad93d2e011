/// What is matte gets what the largest channel of the specular colour leaves over.
fn surface(at: Fragment) -> Surface {
    let diffuse = diffuse_modulate(vec4f(params.diffuse, params.opacity), at);
    let factors = specular_glossiness_modulate(vec4f(params.specular, params.glossiness), at);
    let roughness = roughness_of_glossiness(factors.a);

    var s = bare_surface(at, perturb(at.normal, at));
    s.diffuse = diffuse.rgb * (1.0 - max(factors.r, max(factors.g, factors.b)));
    s.diffuse_roughness = roughness;
    s.f0 = factors.rgb;
    s.alpha = alpha_of_roughness(roughness);
    s.widths = vec2f(s.alpha);
    s.emission = emission_modulate(vec4f(params.emission_color, 1.0), at).rgb * params.emission;
    s.opacity = diffuse.a;
    return s;
}
