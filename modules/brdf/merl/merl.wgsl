/// How many theta_h, theta_d and phi_d; then red, green and blue of each point, phi_d fastest, 1/sr. theta_h and theta_d have one more point, at 0.
var<storage, read> measured: array<f32>;

/// What was measured, interpolated evenly in each coordinate of the table, 1/sr (Matusik et al. 2003). Half and difference angles after Rusinkiewicz 1998.
/// Zero where either direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    let h = v + l;
    let d = l - v;
    let size = length(h);
    let across = cross(s.normal, h);
    let theta_h = polar_angle(length(across), dot(s.normal, h));
    // |l - v| / |l + v| is the tangent: exact for small angles, where an arc cosine of a product is not.
    let theta_d = polar_angle(length(d), size);
    // l - v is perpendicular to h: its part along n x h, and that along the direction in which theta_h grows, both times |n x h|.
    let along = vec2f(-dot(d, s.normal) * size, dot(d, across));
    // phi_d + pi is phi_d: the light and the viewer, exchanged.
    let turned = select(along, -along, along.y < 0.0);
    let phi_d = polar_angle(turned.y, turned.x);
    return interpolated(vec3f(sqrt(theta_h * 2.0 * INV_PI), theta_d * 2.0 * INV_PI, phi_d * INV_PI));
}

/// The table at a place in the unit cube. theta_h and theta_d have points at 0 and in the middles of the cells, and beyond the last middle the last
/// one goes on; phi_d goes round.
fn interpolated(place: vec3f) -> vec3f {
    // A buffer that nobody has filled is all zeros.
    let sizes = max(vec3f(measured[0], measured[1], measured[2]), vec3f(1.0));
    // The middle of cell i, (i + 0.5) / size, is point i + 1; 0 is point 0, half as far from it.
    let at = min(place.xy * sizes.xy + 0.5, sizes.xy);
    let low = min(floor(at), sizes.xy - 1.0);
    let part = select(at - low, 2.0 * at - 1.0, at < vec2f(1.0));
    // From -0.5 on: rounded down after a whole turn.
    let round = place.z * sizes.z - 0.5;
    let before = floor(round);
    let turn = round - before;
    let columns = vec2u((vec2f(before, before + 1.0) + sizes.z) % sizes.z);
    let row = u32(sizes.z);
    let plane = u32(sizes.y + 1.0) * row;
    let first = u32(low.x) * plane + u32(low.y) * row;
    let near = mix(between(first + columns.x, first + columns.y, turn), between(first + row + columns.x, first + row + columns.y, turn), part.y);
    let next = first + plane;
    let far = mix(between(next + columns.x, next + columns.y, turn), between(next + row + columns.x, next + row + columns.y, turn), part.y);
    return mix(near, far, part.x);
}

/// Between the values of two points, 1/sr.
fn between(a: u32, b: u32, part: f32) -> vec3f {
    let i = 3u + 3u * a;
    let j = 3u + 3u * b;
    return mix(vec3f(measured[i], measured[i + 1u], measured[i + 2u]), vec3f(measured[j], measured[j + 1u], measured[j + 2u]), part);
}
