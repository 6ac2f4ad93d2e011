/// Oren and Nayar's qualitative model, 1/sr. Zero at and below the horizon.
///
/// sin(alpha) tan(beta) cos(phi_l - phi_v) is the dot product of the directions' shadows on the plane over the larger of their cosines: no
/// angle is needed, and along the normal, where phi is none, it is 0. The floor of the cosine is a fifth of a second of arc above the
/// horizon: there the model itself is infinite.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let across = dot(v - n_dot_v * s.normal, l - n_dot_l * s.normal);
    let retro = max(across, 0.0) / max(max(n_dot_v, n_dot_l), 1e-6);
    // The standard deviation of the walls' angle.
    let sigma = arcsine(grooves_of_roughness(s.diffuse_roughness));
    let sigma2 = sigma * sigma;
    let a = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let b = 0.45 * sigma2 / (sigma2 + 0.09);
    return s.diffuse * (INV_PI * (a + b * retro));
}
