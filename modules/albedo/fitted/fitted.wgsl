/// A cubic in the column's place u and the width's root y for the root of the lost share, which is 0 at u = 0 and falls with alpha at u = 1; another for B less
/// what level facets would have. Alpha is at least 1e-4, which keeps a cosine of 0 from 0 / 0.
fn facet_albedo(s: Surface, cosine: f32) -> vec3f {
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let m = clamp(cosine, 0.0, 1.0);
    let u = sqrt(min(m * (1.0 + alpha) / (m + alpha), 1.0));
    let y = roughness_of_alpha(alpha);
    let widths = vec4f(1.0, y, alpha, alpha * y);
    let root = vec3f(0.926725, -0.706094, 0.533226)
        + u * (vec3f(-3.930082, 7.258192, -3.355085)
        + u * (vec3f(9.704638, -20.404608, 9.737548)
        + u * vec3f(-5.797197, 14.862729, -7.981150)));
    let more = vec4f(-1.679422, -2.003170, 6.056696, -3.356715)
        + u * (vec4f(0.933127, -11.371319, 19.195944, -8.304476)
        + u * (vec4f(-2.556614, 39.811352, -56.127136, 21.720154)
        + u * vec4f(3.200912, -25.253908, 28.525017, -8.814514)));
    let r = u * (1.0 - u * u + alpha) * dot(root, widths.xyz);
    let lost = clamp(r * r, 0.0, 1.0);
    let c = 1.0 - m;
    let c2 = c * c;
    let b = clamp((1.0 - lost) * (c2 * c2 * c) + y * dot(more, widths), 0.0, 1.0 - lost);
    return vec3f(1.0 - lost - b, b, lost);
}

/// The mean of the fit above, by polynomials in the root of alpha.
fn facet_albedo_mean(s: Surface) -> vec3f {
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let y = roughness_of_alpha(alpha);
    let low = dot(vec3f(1.0, y, alpha), vec3f(10.248155, -46.491723, 115.728747));
    let high = dot(vec3f(1.0, y, alpha), vec3f(-162.093598, 116.833022, -33.630077));
    let lost = alpha * alpha * (low + alpha * y * high);
    let b = dot(vec4f(1.0, y, alpha, alpha * y), vec4f(0.046840, 0.004252, -0.165839, 0.131940));
    return vec3f(1.0 - lost - b, b, lost);
}
