/// Widths and directions of the table; behind them the means, by width. `table.rs` makes it.
const SIDE: u32 = 32u;
var<storage> albedo: array<vec2f, 1056>;

/// The width's place between the table's rows: evenly in the root, from 1e-4 to 1.
fn row_of(alpha: f32) -> f32 {
    return (roughness_of_alpha(alpha) - 0.01) / 0.99 * f32(SIDE - 1u);
}

/// The number below a place that has a next one.
fn below(place: f32) -> u32 {
    return min(u32(max(place, 0.0)), SIDE - 2u);
}

/// Between four neighbours. At a grazing angle the albedo changes where the cosine is about alpha, so the columns are evenly spaced in the root of
/// m (1 + alpha) / (m + alpha); alpha is at least 1e-4, which keeps m = 0 from 0 / 0.
fn facet_albedo(s: Surface, cosine: f32) -> vec3f {
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let m = clamp(cosine, 0.0, 1.0);
    let x = sqrt(min(m * (1.0 + alpha) / (m + alpha), 1.0)) * f32(SIDE - 1u);
    let y = row_of(alpha);
    let i = below(x);
    let j = below(y);
    let at = j * SIDE + i;
    let low = mix(albedo[at], albedo[at + 1u], x - f32(i));
    let high = mix(albedo[at + SIDE], albedo[at + SIDE + 1u], x - f32(i));
    let found = mix(low, high, y - f32(j));
    let lost = found.x * found.x;
    let c = 1.0 - m;
    let c2 = c * c;
    // Level facets would have c^5 of what is not lost; the table has the rest.
    let b = (1.0 - lost) * (c2 * c2 * c) + found.y;
    return vec3f(1.0 - lost - b, b, lost);
}

/// Between two neighbours. The lost share falls with alpha^2, which the table has divided out.
fn facet_albedo_mean(s: Surface) -> vec3f {
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let y = row_of(alpha);
    let j = below(y);
    let found = mix(albedo[SIDE * SIDE + j], albedo[SIDE * SIDE + j + 1u], y - f32(j));
    let lost = found.x * alpha * alpha;
    return vec3f(1.0 - lost - found.y, found.y, lost);
}
