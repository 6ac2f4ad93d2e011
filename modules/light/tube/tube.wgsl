/// The axis, unit length.
fn axis(i: u32) -> vec3f {
    return unit_or(instances[i].along, vec3f(1.0, 0.0, 0.0));
}

/// Luminance, or a flux spread over all that shines: phi / (pi A). The floor stands for a square of a thousandth of a millimetre.
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    let ends = select(0.0, instances[i].radius, params.caps);
    let area = 2.0 * PI * instances[i].radius * (instances[i].length + ends);
    return instances[i].color * select(instances[i].luminance, instances[i].flux / (PI * max(area, 1e-12)), instances[i].flux > 0.0);
}

fn shape_centre(i: u32) -> vec3f {
    return instances[i].position;
}

fn shape_radius(i: u32) -> f32 {
    return sqrt(2.0 * INV_PI * instances[i].radius * instances[i].length);
}

/// A rectangle from the side, a disk from the end.
fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    let toward = unit_or(origin - instances[i].position, vec3f(0.0));
    let side = 2.0 * instances[i].radius * instances[i].length * length(cross(toward, axis(i)));
    let end = PI * instances[i].radius * instances[i].radius * abs(dot(toward, axis(i)));
    return side + select(0.0, end, params.caps);
}

/// The tube from the origin: columns are the direction from the nearest point of its axis to the origin, the one perpendicular to that and the axis,
/// and the axis.
fn seen_frame(i: u32, c: vec3f) -> mat3x3f {
    let e = axis(i);
    let w = unit_or(e * dot(c, e) - c, frame_of(e)[0]);
    return mat3x3f(w, cross(e, w), e);
}

/// Side of the end that shows its cap: 1, -1, or 0 where neither does.
fn cap_side(i: u32, c: vec3f) -> f32 {
    let along = dot(c, axis(i));
    return select(0.0, -sign(along), abs(along) > 0.5 * instances[i].length);
}

/// Share of the samples that goes to the cap that is seen: that of what both show.
fn cap_share(i: u32, c: vec3f) -> f32 {
    if params.caps {
        let side = cap_side(i, c);
        let end = c + axis(i) * (0.5 * side * instances[i].length);
        let away = length(cross(c, axis(i)));
        let cap = PI * instances[i].radius * instances[i].radius * abs(dot(unit_or(end, vec3f(0.0)), axis(i)) * side);
        let flank = 2.0 * instances[i].radius * instances[i].length * away / max(length(c), 1e-15);
        return select(cap / max(cap + flank, 1e-30), side * side, away <= instances[i].radius);
    }
    return 0.0;
}

/// Half the angle about the axis that is seen from a distance from it; 0 within the radius.
fn half_turn(i: u32, away: f32) -> f32 {
    let r = instances[i].radius;
    return select(0.0, angle_of(sqrt(max((away - r) * (away + r), 0.0)), r), away > r);
}

/// Evenly over the part of the side that is seen, and over the cap.
fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    let c = instances[i].position - origin;
    let frame = seen_frame(i, c);
    let share = cap_share(i, c);
    if u.x < share {
        let out = instances[i].radius * sqrt(u.x / share);
        let turn = PI * (2.0 * u.y - 1.0);
        let at = vec3f(out * cos(turn), out * sin(turn), 0.5 * instances[i].length * cap_side(i, c));
        return unit_or(c + frame * at, -frame[2]);
    }
    let x = (u.x - share) / max(1.0 - share, 1e-7) - 0.5;
    let turn = half_turn(i, dot(-c, frame[0])) * (2.0 * u.y - 1.0);
    let at = vec3f(instances[i].radius * cos(turn), instances[i].radius * sin(turn), instances[i].length * x);
    return unit_or(c + frame * at, -frame[0]);
}

/// d^2 / (A cos), 1/sr, where l meets the side or the cap first.
fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    let c = instances[i].position - origin;
    let frame = seen_frame(i, c);
    let center = c * frame;
    let ray = l * frame;
    let r = instances[i].radius;
    let half = 0.5 * instances[i].length;
    let share = cap_share(i, c);
    if params.caps {
        let end = center.z + cap_side(i, c) * half;
        let distance = end / select(ray.z, 1e-30, ray.z == 0.0);
        let out = length(ray.xy * distance - center.xy);
        if share > 0.0 && distance > 0.0 && out <= r * 1.00001 + 1e-6 * distance {
            return share * distance * distance / (PI * max(r * r, 1e-30) * max(abs(ray.z), 1e-7));
        }
    }
    // The root of |t ray - center| = r, across the axis, that is nearer.
    let away = length(center.xy);
    let outside = (away - r) * (away + r);
    let square = dot(ray.xy, ray.xy);
    let toward = dot(ray.xy, center.xy);
    let miss = ray.x * center.y - ray.y * center.x;
    let under = square * r * r - miss * miss;
    let distance = outside / max(toward + sqrt(max(under, 0.0)), 1e-30);
    if outside <= 0.0 || toward <= 0.0 || under <= 0.0 || abs(ray.z * distance - center.z) > half + 1e-6 * distance {
        return 0.0;
    }
    let shown = 2.0 * half_turn(i, away) * instances[i].length * sqrt(under);
    return (1.0 - share) * distance * distance / max(shown, 1e-30);
}

fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return shape_luminance(i, origin, l, l, 0.0) * sign(shape_pdf(i, origin, l));
}

fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    return shape_form_factor(i, origin, transpose(frame_of(n)));
}

/// What a line of the side gives, with the width that it stands for by t.
fn line_factor(i: u32, frame: mat3x3f, c: vec3f, away: f32, local: mat3x3f, t: f32) -> f32 {
    let r = instances[i].radius;
    let scale = 1.0 / (1.0 + t * t);
    let width = 2.0 * scale * r * (away * (1.0 - t * t) * scale - r);
    return width * segment_integral(local * (c + out_at(frame, t) * r), local * (frame[2] * (0.5 * instances[i].length)));
}

/// The side of a thin tube: lines along it, each integrated exactly, and across them Gauss and Legendre's eight points, which are off by 4e-5.
/// No terms cancel, however thin it is.
fn thin_factor(i: u32, frame: mat3x3f, c: vec3f, away: f32, local: mat3x3f, last: f32) -> f32 {
    let x = array<f32, 4>(0.1834346425, 0.5255324099, 0.7966664774, 0.9602898565);
    let w = array<f32, 4>(0.3626837834, 0.3137066459, 0.2223810345, 0.1012285363);
    let half = 0.5 * instances[i].length;
    let up = transpose(local)[2];
    let heights = up * frame;
    let part = part_above(dot(up, c) + abs(heights.z) * half, heights.x * instances[i].radius, heights.y * instances[i].radius, last);
    let middle = 0.5 * (part.x + part.y);
    let wide = 0.5 * (part.y - part.x);
    var sum = 0.0;
    for (var k = 0; k < 4; k++) {
        let before = line_factor(i, frame, c, away, local, middle - wide * x[k]);
        sum += w[k] * (before + line_factor(i, frame, c, away, local, middle + wide * x[k]));
    }
    return sum * wide * abs(determinant(local)) * half * INV_PI;
}

/// Corner k of 26 of the outline: along the circle of one end and back along the other's, over the part that is seen of the side; but at the end `cap` on
/// the far side, behind the cap. A chord over the angle delta loses delta^2 / 12 of the radius in the mean, so its ends are that far out, but those
/// where the lines begin.
fn outline_corner(i: u32, frame: mat3x3f, c: vec3f, away: f32, cap: f32, k: u32) -> vec3f {
    let r = instances[i].radius;
    let end = select(-1.0, 1.0, k < 13u);
    let share = f32(select(25u - k, k, k < 13u)) / 6.0 - 1.0;
    let last = sqrt(max(away - r, 0.0) / (away + r));
    var delta = last / (3.0 + 3.0 * last * last * share * share);
    var at = out_at(frame, last * share);
    if cap == end {
        delta = (PI - half_turn(i, away)) / 6.0;
        at = frame[1] * sin(6.0 * delta * share) - frame[0] * cos(6.0 * delta * share);
    }
    let out = r * select(1.0 + delta * delta / 12.0, 1.0, abs(share) == 1.0);
    return c + at * out + frame[2] * (0.5 * end * instances[i].length);
}

/// The side of a thick tube by its outline.
fn outline_factor(i: u32, frame: mat3x3f, c: vec3f, away: f32, local: mat3x3f) -> f32 {
    var rim = vec2f(0.0);
    var sum = 0.0;
    var at = local * outline_corner(i, frame, c, away, 0.0, 25u);
    for (var k = 0u; k < 26u; k++) {
        let next = local * outline_corner(i, frame, c, away, 0.0, k);
        sum += edge_above(at, next, next - at, &rim);
        at = next;
    }
    return abs(sum) * 0.159154943091895;
}

/// The side and, where it shines, the cap that is seen. The tangent of half the angle about the axis is the variable: it needs no sine, and the side is
/// seen up to sqrt((away - r) / (away + r)).
fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    let c = instances[i].position - origin;
    let frame = seen_frame(i, c);
    let r = instances[i].radius;
    let half = 0.5 * instances[i].length;
    let away = -dot(c, frame[0]);
    var sum = 0.0;
    if away > r {
        let last = sqrt((away - r) / (away + r));
        let middle = local * c;
        let along = local * frame[2];
        let nearest = middle - along * clamp(dot(middle, along) / max(dot(along, along), 1e-30), -half, half);
        let across = max(length(local * frame[0]), length(local * frame[1])) * r;
        if across < 0.15 * length(nearest) {
            sum = thin_factor(i, frame, c, away, local, last);
        } else {
            sum = outline_factor(i, frame, c, away, local);
        }
    }
    if params.caps {
        let side = cap_side(i, c);
        if side != 0.0 {
            sum += ellipse_factor(local * (c + frame[2] * (side * half)), local * (frame[0] * r), local * (frame[1] * r));
        }
    }
    return sum;
}

/// The point of the axis, moved toward the ray by the radius.
fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    let near = segment_toward(instances[i].position - origin, axis(i) * (0.5 * instances[i].length), along);
    return sphere_toward(near, instances[i].radius, along);
}

/// From within the radius only the cap is seen.
fn shape_corners(i: u32, origin: vec3f) -> u32 {
    let c = instances[i].position - origin;
    return select(select(0u, CIRCLE_CORNERS, params.caps && cap_side(i, c) != 0.0), 26u, length(cross(c, axis(i))) > instances[i].radius);
}

fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    let c = instances[i].position - origin;
    let frame = seen_frame(i, c);
    let away = -dot(c, frame[0]);
    let cap = select(0.0, cap_side(i, c), params.caps);
    if away > instances[i].radius {
        return outline_corner(i, frame, c, away, cap, k);
    }
    return c + frame * vec3f(circle_corner(k) * instances[i].radius, 0.5 * cap * instances[i].length);
}

/// Radiance toward v because of all tubes, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let radiance = illuminate(i, s, v);
        if max(radiance.x, max(radiance.y, radiance.z)) > 0.0 {
            let offset = shape_centre(i) - s.position;
            var ray: Ray;
            ray.light = i;
            ray.direction = unit_or(offset, s.normal);
            ray.distance = length(offset);
            sum += radiance * visible(ray, s);
        }
    }
    return sum;
}
