/// G2 / (4 n.l n.v) = 1 / (4 n.l n.v (1 + L(v) + L(l))), L Smith's integral over Gaussian slopes. Heitz 2014, section 5.3 and eq. 99.
///
/// cos(theta) L is alpha sin(theta) M / 2 with M = exp(-a^2) / sqrt(pi) - a erfc(a), a = 1 / (alpha tan(theta)): multiplied out,
/// nothing is 0 / 0 at the horizon. The floor is reached where n.l and n.v are below 5e-9 (at alpha 1e-4), less than unit vectors can
/// tell from 0.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let n_dot_v = dot(s.normal, v);
    let n_dot_l = dot(s.normal, l);
    if n_dot_v <= 0.0 || n_dot_l <= 0.0 {
        return 0.0;
    }
    let toward_v = n_dot_l * hidden(s, v, n_dot_v);
    let toward_l = n_dot_v * hidden(s, l, n_dot_l);
    return 0.25 / max(n_dot_l * n_dot_v + toward_v + toward_l, 1e-12);
}

/// cos(theta) L, the area that is hidden, seen from a direction at the angle theta to n.
fn hidden(s: Surface, direction: vec3f, cosine: f32) -> f32 {
    let width = s.alpha * length(cross(s.normal, direction));
    // From 9 on M is below 1e-36. Along the normal the width is 0; the floor keeps 0 from 1 / 0.
    return 0.5 * width * slope_tail(min(cosine / max(width, 1e-12), 9.0));
}

/// exp(-a^2) / sqrt(pi) - a erfc(a), the mean of what a Gaussian slope has above a. A polynomial in 1 / (1 + a / 2) times exp(-a^2),
/// fitted for this module: the largest relative error for a in [0, 5] is 2e-6. It has no difference that cancels, as erf(a) - 1 has.
fn slope_tail(a: f32) -> f32 {
    let t = 1.0 / (1.0 + 0.5 * a);
    let high = 0.39595945 + t * (0.1178075 + t * (-0.33276724 + t * 0.10864344));
    let p = 0.00077037349 + t * (0.059626046 + t * (0.20292712 + t * (0.011223776 + t * high)));
    return exp(-a * a) * t * p;
}
