/// Burley's diffuse reflectance, 1/sr: dark at grazing angles on smooth surfaces, bright there on rough ones. Zero at and below the horizon.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    // 2 cos^2 of half the angle between v and l: |v + l|^2 / 2.
    let sum = v + l;
    let at_grazing = 0.5 + s.diffuse_roughness * 0.5 * dot(sum, sum);
    return s.diffuse * (INV_PI * toward(at_grazing, n_dot_v) * toward(at_grazing, n_dot_l));
}

/// From 1 along the normal to `at_grazing` at the horizon, by Schlick's fifth power.
fn toward(at_grazing: f32, cosine: f32) -> f32 {
    return 1.0 + (at_grazing - 1.0) * schlick_weight(cosine);
}
