/// Oren and Nayar's full model, 1/sr: what grooves reflect at once (L1) and after one interreflection (L2). Zero at and below the horizon.
///
/// beta is the smaller of the angles to the normal, alpha the larger. The floors of the cosines are a fifth of a second of arc above
/// the horizon, where the model itself is infinite.
fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return vec3f(0.0);
    }
    // The standard deviation of the walls' angle.
    let sigma = arcsine(grooves_of_roughness(s.diffuse_roughness));
    let sigma2 = sigma * sigma;
    let c1 = 1.0 - 0.5 * sigma2 / (sigma2 + 0.33);
    let b = 0.45 * sigma2 / (sigma2 + 0.09);

    let shadow_v = v - n_dot_v * s.normal;
    let shadow_l = l - n_dot_l * s.normal;
    let sine_v = length(shadow_v);
    let sine_l = length(shadow_l);
    // Along the normal there is no azimuth; all that asks for it is 0 there.
    let phi_v = shadow_v / max(sine_v, 1e-15);
    let phi_l = shadow_l / max(sine_l, 1e-15);
    let cosine_phi = dot(phi_v, phi_l);
    // 1 - |cos phi|, as half the square of a difference: at grazing angles it is multiplied by up to 1e6.
    let apart = phi_v - phi_l * select(-1.0, 1.0, cosine_phi >= 0.0);
    let aside = 0.5 * dot(apart, apart);

    let v_is_larger = n_dot_v < n_dot_l;
    let sine_a = select(sine_l, sine_v, v_is_larger);
    let cosine_a = select(n_dot_l, n_dot_v, v_is_larger);
    let sine_b = select(sine_v, sine_l, v_is_larger);
    let cosine_b = select(n_dot_v, n_dot_l, v_is_larger);
    // 2 alpha / pi, 2 beta / pi, and 1 - 2 beta / pi without a difference.
    let y_a = turn(sine_a, cosine_a);
    let y_b = turn(sine_b, cosine_b);
    let u_b = turn(cosine_b, sine_b);

    // sin(alpha) - (2 beta / pi)^3, which vanishes at the horizon, as the difference of both from 1.
    let lessened = u_b * (3.0 - 3.0 * u_b + u_b * u_b) - cosine_a * cosine_a / (1.0 + sine_a);
    let c2 = b * select(lessened, sine_a, cosine_phi >= 0.0);
    let c3 = 0.125 * sigma2 / (sigma2 + 0.09) * (y_a * y_b) * (y_a * y_b);
    let tangent_b = sine_b / max(cosine_b, 1e-6);
    let tangent_half = (sine_a + sine_b) / max(cosine_a + cosine_b, 2e-6);
    let once = c1 + cosine_phi * c2 * tangent_b + aside * c3 * tangent_half;
    let twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1.0 - cosine_phi * y_b * y_b);
    return s.diffuse * INV_PI * (once + s.diffuse * twice);
}

/// The angle in [0, pi / 2] with this sine and cosine, as a share of pi / 2.
fn turn(sine: f32, cosine: f32) -> f32 {
    let angle = arcsine(min(sine, cosine)) * (2.0 * INV_PI);
    return select(1.0 - angle, angle, sine < cosine);
}
