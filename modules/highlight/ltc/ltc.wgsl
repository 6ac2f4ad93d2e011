/// Three pairs of a cell: of the inverse map row 0, row 2, and the integrals.
struct Cell {
    first: vec2f,
    third: vec2f,
    integrals: vec2f,
}

/// Two cells of a row, k and the next, mixed.
fn along_row(k: u32, share: f32) -> Cell {
    let at = 3u * k;
    var cell: Cell;
    cell.first = mix(cosine_pair(at), cosine_pair(at + 3u), share);
    cell.third = mix(cosine_pair(at + 1u), cosine_pair(at + 4u), share);
    cell.integrals = mix(cosine_pair(at + 2u), cosine_pair(at + 5u), share);
    return cell;
}

/// The table between four cells, for the cosine m of the angle of incidence. alpha is at least 1e-4, which keeps m = 0 from 0 / 0.
fn cell_at(alpha: f32, m: f32) -> Cell {
    let last = f32(COSINE_SIDE - 1u);
    let place = last * min(vec2f(sqrt(m * (1.0 + alpha) / (m + alpha)), roughness_of_alpha(alpha)), vec2f(1.0));
    let corner = min(floor(place), vec2f(last - 1.0));
    let share = place - corner;
    let k = COSINE_SIDE * u32(corner.y) + u32(corner.x);
    let low = along_row(k, share.x);
    let high = along_row(k + COSINE_SIDE, share.x);
    var cell: Cell;
    cell.first = mix(low.first, high.first, share.y);
    cell.third = mix(low.third, high.third, share.y);
    cell.integrals = mix(low.integrals, high.integrals, share.y);
    return cell;
}

/// Luminance times (f0 A + (1 - f0) B) times the form factor of the light moved by M^-1.
///
/// The table's map is in the frame around the mirrored view, x in the plane of incidence. Looking straight down there is no such plane, and
/// the lobe is round: below a sine of 1e-4 any will do, and there the cross product has no digits left for one.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let m = min(dot(s.normal, v), 1.0);
    if m <= 0.0 {
        return vec3f(0.0);
    }
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let cell = cell_at(alpha, m);
    let across = cross(s.normal, v);
    let sine = length(across);
    let mirror = normalize(reflect(-v, s.normal));
    let frame = frame_of(mirror);
    let side = select(frame[1], across / max(sine, 1e-4), sine > 1e-4);
    let forward = normalize(cross(side, mirror));
    let y = cross(mirror, forward);
    let narrow = alpha + m;
    let skew = alpha * sine;
    let first = forward * (cell.first.x * narrow) + mirror * (cell.first.y * skew);
    let third = forward * (cell.third.x * skew) + mirror * (cell.third.y * alpha * narrow);
    let factor = shape_form_factor(i, s.position, transpose(mat3x3f(first, y, third)));
    // The table's second integral is B less what level facets would have.
    let c = 1.0 - m;
    let grazing = cosine_fresnel() * cell.integrals.x * (c * c) * (c * c) * c + cell.integrals.y;
    return shape_luminance(i, s.position, s.normal, mirror, alpha) * (s.f0 * cell.integrals.x + (1.0 - s.f0) * grazing) * factor;
}
