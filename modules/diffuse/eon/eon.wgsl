/// 1/2 - 2 / (3 pi): what a white surface of roughness 1 loses along its normal, before normalisation.
const LOSS: f32 = 0.287793409;
/// 2/3 - 28 / (15 pi): what is left of the mean over the hemisphere.
const MEAN: f32 = 0.0724882125;

/// Energy-preserving Oren-Nayar reflectance, 1/sr: Fujii's model, and what it loses, given back as by many reflections. Zero at and
/// below the horizon.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    let r = s.diffuse_roughness;
    let scale = 1.0 / (1.0 + LOSS * r);
    let once = scale * shape(r, n_dot_v, n_dot_l, v - n_dot_v * s.normal, l - n_dot_l * s.normal);

    // With E the albedo of one reflection, 1 - E is scale r missing; so neither a difference nor a 0 / 0 at r = 0 is left.
    let mean = scale * (1.0 + MEAN * r);
    let many = r * scale * missing(n_dot_v) * missing(n_dot_l) / (LOSS - MEAN);
    let rho = s.diffuse;
    return rho * INV_PI * (once + rho * mean / (1.0 - rho * (1.0 - mean)) * many);
}

/// 1 + r s / t, with s the dot product of the directions' shadows on the plane, and t the larger cosine where s is positive, else 1.
///
/// Where s is negative 1 + s is a sum of squares: for two opposite directions near the horizon it is next to 0. The floor of t is a
/// fifth of a second of arc above the horizon, where the model itself is infinite.
fn shape(r: f32, n_dot_v: f32, n_dot_l: f32, shadow_v: vec3f, shadow_l: vec3f) -> f32 {
    let s = dot(shadow_v, shadow_l);
    if s > 0.0 {
        return 1.0 + r * s / max(max(n_dot_v, n_dot_l), 1e-6);
    }
    let sum = shadow_v + shadow_l;
    return 1.0 - r + r * 0.5 * (dot(sum, sum) + n_dot_v * n_dot_v + n_dot_l * n_dot_l);
}

/// LOSS - G / pi of the paper's G: from LOSS along the normal to 0 at the horizon, where G is expanded around the angle to the horizon
/// so that nothing cancels.
fn missing(cosine: f32) -> f32 {
    let mu = min(cosine, 1.0);
    let sine = sqrt((1.0 - mu) * (1.0 + mu));
    let elevation = select(0.5 * PI - arcsine(sine), arcsine(mu), mu < sine);
    let rest = (0.5 * PI - 2.0 / 3.0) * mu * mu - (2.0 / 3.0) * sine * mu * (1.0 + sine + sine * sine);
    return INV_PI * (sine * (elevation + sine * mu) + rest / (1.0 + sine));
}
