/// Numbers of the fitted lobes, two by two, five pairs a cell, the angle of incidence running fastest. `table.rs` made it.
var<storage> table: array<vec2f, 14000>;

/// Cells of the table along the wider width, the narrower over it, the azimuth and the angle of incidence.
const SIDES = vec4f(7.0, 5.0, 5.0, 16.0);
const STRIDES = vec4u(400u, 80u, 16u, 1u);
/// Roots of the smallest wider width and of the smallest ratio in the table.
const SMALLEST = vec2f(0.05, 0.125);

/// A cell's pairs: x, x'; x", y; y", z; z', z"; A, and B less what level facets would have.
struct Fitted {
    a: vec2f,
    b: vec2f,
    c: vec2f,
    d: vec2f,
    integrals: vec2f,
}

/// The table between the five corners of the simplex that holds the place (Kuhn 1960): from the low corner along one side after the other, that
/// with the largest fraction first.
fn fitted_at(place: vec4f) -> Fitted {
    let at = clamp(place, vec4f(0.0), vec4f(1.0)) * (SIDES - 1.0);
    let corner = min(floor(at), SIDES - 2.0);
    let low = vec4u(corner) * STRIDES;
    var k = low.x + low.y + low.z + low.w;
    var rest = at - corner;
    var before = 1.0;
    var sum: Fitted;
    for (var step = 0; step < 5; step++) {
        let most = max(max(rest.x, rest.y), max(rest.z, rest.w));
        // After the last side none is left, and the rest of the weight is the high corner's.
        let weight = before - max(most, 0.0);
        sum.a += weight * table[5u * k];
        sum.b += weight * table[5u * k + 1u];
        sum.c += weight * table[5u * k + 2u];
        sum.d += weight * table[5u * k + 3u];
        sum.integrals += weight * table[5u * k + 4u];
        before = most;
        if rest.w == most {
            k += STRIDES.w;
            rest.w = -1.0;
        } else if rest.z == most {
            k += STRIDES.z;
            rest.z = -1.0;
        } else if rest.y == most {
            k += STRIDES.y;
            rest.y = -1.0;
        } else {
            k += STRIDES.x;
            rest.x = -1.0;
        }
    }
    return sum;
}

/// Luminance times (f0 A + (1 - f0) B) times the form factor of the light moved by M^-1.
///
/// M's columns are taken along (forward, side, axis): the axis is the mirrored view, bent toward the normal where facets are wide, and the side is
/// across the plane of incidence. Looking straight down there is no such plane; there the wider width's direction is as good as any, since the
/// fitted ellipse has the facets' axes.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let m = min(dot(s.normal, v), 1.0);
    if m <= 0.0 {
        return vec3f(0.0);
    }
    let widths = clamp(s.widths, vec2f(1e-4), vec2f(1.0));
    let bitangent = cross(s.normal, s.tangent);
    let is_along = widths.x >= widths.y;
    let wider = select(bitangent, s.tangent, is_along);
    let major = max(widths.x, widths.y);
    let ratio = min(widths.x, widths.y) / major;

    // The view's azimuth from the wider width's direction.
    let across = cross(s.normal, v);
    let sine = length(across);
    let is_tilted = sine > 1e-4;
    let side = select(cross(s.normal, wider), across / max(sine, 1e-4), is_tilted);
    let c = dot(cross(side, s.normal), wider);
    let d = -dot(side, wider);

    // Width of the facets toward the viewer, in shares of the wider width.
    let wide = length(vec2f(c, ratio * d));
    let toward = wide * major;
    let narrow = m + toward;
    let mirror = normalize(reflect(-v, s.normal));
    let axis = normalize(mirror + s.normal * (toward * toward));
    let forward = normalize(cross(side, axis));

    let rough = roughness_of_alpha(major);
    let roots = (vec2f(rough, sqrt(ratio)) - SMALLEST) / (1.0 - SMALLEST);
    let cell = fitted_at(vec4f(roots, c * c * (1.0 + ratio) / (wide + ratio), sqrt(m * (1.0 + 0.5 * rough) / (m + 0.5 * rough))));

    // Mirrored across the plane of incidence a thin lobe is an arc; it is as thick as that is bent.
    let grazing = toward / narrow;
    let thick = ratio + abs(d) * (0.5 * major * sine * m + 2.0 * abs(c) * grazing * grazing * (1.0 - 0.7 * major));
    let skew = sine / narrow;
    // The columns over what they vanish with, the wider width, the thickness and 1; the first two without what they have of the third.
    let first = 2.0 * vec2f(c, -narrow * d);
    let second = 2.0 * vec2f(d, narrow * c);
    let x = vec3f(first * cell.a.x + second * (cell.a.y * c * d), 0.0);
    let y = vec3f(second * cell.b.y, 0.0);
    let z = vec3f((first * (cell.c.y * c) + second * (cell.d.x * d)) * (skew * major), cell.d.y);
    // Rows of M^-1, their common length left out.
    let row0 = cross(y, z);
    let row1 = cross(z, x);
    let row2 = cross(x, y) - row0 * (cell.b.x * skew * c) - row1 * (cell.c.x * skew * d / thick);
    let local = mat3x3f(forward, side, axis);
    let rows = mat3x3f(local * (row0 * thick), local * row1, local * (row2 * (thick * major)));
    let factor = shape_form_factor(i, s.position, transpose(rows));

    let miss = 1.0 - m;
    let grown = max(cell.integrals.x * (miss * miss) * (miss * miss) * miss + cell.integrals.y, 0.0);
    return shape_luminance(i, s.position, s.normal, mirror, sqrt(widths.x * widths.y)) * (s.f0 * cell.integrals.x + (1.0 - s.f0) * grown) * factor;
}
