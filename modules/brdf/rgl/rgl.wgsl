/// Sixteen numbers: azimuths, elevations, width and height of ndf, sigma, vndf and values, 1 for an isotropic material, how often the azimuths go
/// round, 1 for values to be multiplied by D / (4 sigma). Then azimuths and elevations, rad, ndf, sigma, of vndf the densities, conditional and
/// marginal distributions, and the values, slices of azimuth, elevation and channel.
var<storage, read> measured: array<f32>;

/// The four slices between whose incident directions one lies.
struct Slices {
    /// The first of them.
    first: u32,
    /// To the next elevation and to the next azimuth, in slices; 0 where there is no other.
    steps: vec2u,
    /// Weights of those.
    parts: vec2f,
}

/// A cell of a grid over the unit square: its first point, and where in it.
struct Patch {
    at: u32,
    part: vec2f,
}

/// values D(m) / (4 sigma(v) n.l), the values where the warp by the visible facets comes from, 1/sr (Dupuy and Jakob 2018). Zero where either
/// direction is below the horizon of the shading normal.
fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {
    if !above_horizon(s.normal, v, l) {
        return vec3f(0.0);
    }
    var i = to_local(s, v);
    var o = to_local(s, l);
    // Into the part of the circle that the table has: from -pi on, a half of it turned, a quarter mirrored.
    let flip = select(vec2f(1.0), vec2f(-1.0), i.xy > vec2f(0.0));
    let times = measured[11];
    let sign = select(select(vec2f(1.0), flip.yy, times > 1.5), flip, times > 3.5);
    i = vec3f(i.xy * sign, i.z);
    o = vec3f(o.xy * sign, o.z);
    let m = i + o;
    let is_isotropic = measured[10] > 0.5;
    // The azimuth of an isotropic table counts from that of i.
    let from_i = vec2f(dot(i.xy, m.xy), i.x * m.y - i.y * m.x);
    let turned = select(m.xy, from_i, is_isotropic);
    let phi_i = azimuth_of(i.xy);
    let theta_i = polar_angle(length(i.xy), i.z);
    let u_m = vec2f(elevation(polar_angle(length(m.xy), m.z)), azimuth(azimuth_of(turned)));
    let slices = slices_at(phi_i, theta_i);
    let even = unwarp(u_m, slices);
    let count = slice_count();
    let vndf = size_at(6u);
    let start = 16u + u32(measured[0]) + u32(measured[1]);
    let sigma = start + area(size_at(2u));
    let values = sigma + area(size_at(4u)) + count * (2u * area(vndf) + vndf.y);
    let size = size_at(8u);
    let at = patch_at(even, size);
    let slice = area(size);
    var color: vec3f;
    for (var channel = 0u; channel < 3u; channel++) {
        color[channel] = bilinear(values + channel * slice, 3u * slice, at, size.x, slices);
    }
    let none = Slices(0u, vec2u(0u), vec2f(0.0));
    let normals = bilinear(start, 0u, patch_at(u_m, size_at(2u)), size_at(2u).x, none);
    let projected = bilinear(sigma, 0u, patch_at(vec2f(elevation(theta_i), azimuth(phi_i)), size_at(4u)), size_at(4u).x, none);
    // Facets that nobody sees reflect nothing: a table with an area of 0 has no light there either. The floors keep the quotients in range.
    let scale = select(1.0, normals / (4.0 * max(projected, 1e-6)), measured[12] > 0.5);
    return color * (scale / max(o.z, 1e-6));
}

/// sqrt(2 theta / pi), where an elevation stands in the unit square.
fn elevation(theta: f32) -> f32 {
    return sqrt(theta * 2.0 * INV_PI);
}

/// (phi + pi) / (2 pi), where an azimuth stands in the unit square.
fn azimuth(phi: f32) -> f32 {
    return clamp(0.5 * (phi * INV_PI + 1.0), 0.0, 1.0);
}

/// Width and height of a grid, at a place in the front of the table. At least 2: a buffer that nobody has filled is all zeros.
fn size_at(place: u32) -> vec2u {
    return max(vec2u(u32(measured[place]), u32(measured[place + 1u])), vec2u(2u));
}

fn area(size: vec2u) -> u32 {
    return size.x * size.y;
}

/// Incident directions of the table.
fn slice_count() -> u32 {
    return u32(measured[0]) * u32(measured[1]);
}

/// The slices around an incident direction; beyond the last ones those go on.
fn slices_at(phi: f32, theta: f32) -> Slices {
    let phis = u32(measured[0]);
    let thetas = u32(measured[1]);
    let p = interval(16u, phis, phi);
    let t = interval(16u + phis, thetas, theta);
    let steps = vec2u(select(0u, 1u, thetas > 1u), select(0u, thetas, phis > 1u));
    return Slices(u32(p.x) * thetas + u32(t.x), steps, vec2f(t.y, p.y));
}

/// Which interval of ascending numbers something is in, and what part of it lies before.
fn interval(start: u32, count: u32, x: f32) -> vec2f {
    if count < 2u {
        return vec2f(0.0);
    }
    var low = 0u;
    var high = count - 1u;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if measured[start + middle] <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    let a = measured[start + low];
    // Ascending: b is more than a.
    let b = measured[start + low + 1u];
    return vec2f(f32(low), clamp((x - a) / (b - a), 0.0, 1.0));
}

/// The cell of a grid at a point of the unit square.
fn patch_at(u: vec2f, size: vec2u) -> Patch {
    let place = clamp(u, vec2f(0.0), vec2f(1.0)) * vec2f(size - 1u);
    let low = min(vec2u(place), size - 2u);
    return Patch(low.y * size.x + low.x, place - vec2f(low));
}

/// A number of the slices, by their weights: at `at` in each slice of `size` numbers from `start` on.
fn mixed(start: u32, size: u32, at: u32, slices: Slices) -> f32 {
    let here = start + slices.first * size + at;
    let next = here + slices.steps.y * size;
    let up = slices.steps.x * size;
    let one = mix(measured[here], measured[here + up], slices.parts.x);
    return mix(one, mix(measured[next], measured[next + up], slices.parts.x), slices.parts.y);
}

/// A bilinear function of the slices in a cell.
fn bilinear(start: u32, size: u32, cell: Patch, width: u32, slices: Slices) -> f32 {
    let low = mix(mixed(start, size, cell.at, slices), mixed(start, size, cell.at + 1u, slices), cell.part.x);
    let next = cell.at + width;
    let high = mix(mixed(start, size, next, slices), mixed(start, size, next + 1u, slices), cell.part.x);
    return mix(low, high, cell.part.y);
}

/// The point of the unit square from which the warp by the visible facets comes to u: the conditional distribution in its row, and the marginal one.
fn unwarp(u: vec2f, slices: Slices) -> vec2f {
    let size = size_at(6u);
    let all = area(size);
    let start = 16u + u32(measured[0]) + u32(measured[1]) + area(size_at(2u)) + area(size_at(4u));
    let conditional = start + slice_count() * all;
    let marginal = conditional + slice_count() * all;
    let cell = patch_at(u, size);
    let row = cell.at / size.x;
    let y = cell.part.y;
    let x = cell.part.x;
    let before = mix(mixed(start, all, cell.at, slices), mixed(start, all, cell.at + size.x, slices), y);
    let after = mix(mixed(start, all, cell.at + 1u, slices), mixed(start, all, cell.at + size.x + 1u, slices), y);
    let begun = mix(mixed(conditional, all, cell.at, slices), mixed(conditional, all, cell.at + size.x, slices), y);
    let end = row * size.x + size.x - 1u;
    let low = mixed(conditional, all, end, slices);
    let high = mixed(conditional, all, end + size.x, slices);
    // A row in which no facet is seen has no place to come from; its values are those at its beginning. Sums of a slice are 1, so 1e-20 is nothing.
    let along = (begun + x * (before + 0.5 * x * (after - before))) / max(mix(low, high, y), 1e-20);
    let up = mixed(marginal, size.y, row, slices) + y * (low + 0.5 * y * (high - low));
    return vec2f(along, up);
}

/// The azimuth of a point from the x axis, in [-pi, pi], rad.
fn azimuth_of(p: vec2f) -> f32 {
    let positive = polar_angle(abs(p.y), p.x);
    return select(positive, -positive, p.y < 0.0);
}
