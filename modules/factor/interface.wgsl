// What all functions here have in common: the shaded point is the origin, its plane is z = 0, and what is below it does not count. A form
// factor is the integral of cos(theta) over a set of directions, divided by pi: 1 for all directions above the plane.

/// Form factor of a sphere whose radius is the share `sine` of its distance, seen by a plane whose normal has this cosine with the
/// direction to the centre; `across` is the sine of that angle. Exact across the horizon: projected onto the plane (Nusselt 1928) the visible cap
/// is an ellipse's and a circle's segment, each without cancellation. A point inside sees as much as one on the sphere.
fn sphere_factor(sine: f32, cosine: f32, across: f32) -> f32 {
    let s = min(sine, 1.0);
    let s2 = s * s;
    if cosine >= s {
        return s2 * cosine;
    }
    if cosine <= -s {
        return 0.0;
    }
    let height = sqrt(max((s - cosine) * (s + cosine), 0.0));
    let far = sqrt(max(1.0 - s2, 0.0));
    // Half angles of the two segments: of the unit circle, and of the ellipse. Where the centre is at the zenith of a point that
    // touches the sphere the sines vanish; 1e-20 keeps the ratios finite.
    let a = 1.0 / max(across, 1e-20);
    let circle = disk_segment(min(height * a, 1.0), far * a);
    let b = a / max(s, 1e-20);
    let segment = disk_segment(min(height * b, 1.0), far * abs(cosine) * b);
    let ellipse = select(-segment, 3.14159265358979 - segment, cosine > 0.0);
    return (circle + s2 * abs(cosine) * ellipse) * 0.318309886183791;
}

/// Form factor of an elliptic cone of directions c + a cos(t) + b sin(t) with c of length 1, a and b its axes, of lengths `a` >= `b`, all three
/// perpendicular; `n` holds the components of the plane's normal along a, b and c. The contour integral of Lambert 1760 has a closed
/// form for each of its terms, whether the cone is whole or cut by the horizon.
fn cone_factor(a: f32, b: f32, n: vec3f) -> f32 {
    let tilt = length(vec2f(a * n.x, b * n.y));
    let a1 = 1.0 + a * a;
    let b1 = 1.0 + b * b;
    let whole = inverseSqrt(a1 * b1);
    if n.z >= tilt {
        return a * b * n.z * whole;
    }
    if n.z <= -tilt {
        return 0.0;
    }
    // The part above the horizon: |t - t0| < w.
    let t0 = vec2f(a * n.x, b * n.y) / max(tilt, 1e-30);
    let cos_w = -n.z / max(tilt, 1e-30);
    let sin_w = sqrt(max((1.0 - cos_w) * (1.0 + cos_w), 0.0));
    if a < 0.02 {
        // The contour of a small cone adds up to the square of its terms, or the cube. The same over its flat ellipse is off by less than
        // a^2 / 3.
        let segment = disk_segment(sin_w, cos_w);
        let first = 0.666666667 * sin_w * sin_w * sin_w;
        return max(a * b * tilt * (first - cos_w * segment) * whole, 0.0) * 0.318309886183791;
    }
    let p1 = vec2f(t0.x * cos_w + t0.y * sin_w, t0.y * cos_w - t0.x * sin_w);
    let p2 = vec2f(t0.x * cos_w - t0.y * sin_w, t0.y * cos_w + t0.x * sin_w);
    let k2 = (a - b) * (a + b);
    // Integrals over the arc of 1, cos(t) and sin(t), over 1 + a^2 cos^2 + b^2 sin^2.
    let ratio = sqrt(b1 / a1);
    let turn_sine = ratio * 2.0 * sin_w * cos_w;
    let turn = angle_of(abs(turn_sine), p1.x * p2.x + ratio * ratio * p1.y * p2.y);
    let one = whole * select(turn, 6.28318530717959 - turn, turn_sine < 0.0);
    let below = a1 - k2 * p1.y * p2.y;
    let chord_a = 2.0 * t0.x * sin_w;
    let chord_b = 2.0 * t0.y * sin_w;
    let along_a = chord_a / below * artanh_ratio(sqrt(k2 * a1) * abs(chord_a) / below);
    let along_b = chord_b * angle_over_sine(sqrt(k2 * b1) * abs(chord_b), b1 + k2 * p1.x * p2.x);
    // The horizon from where the contour goes below it to where it comes back.
    let d = 2.0 * sin_w * vec2f(-a * t0.y, b * t0.x);
    let e1 = vec3f(a * p1.x, b * p1.y, 1.0);
    let e2 = vec3f(a * p2.x, b * p2.y, 1.0);
    let rim = angle_of(length(vec3f(-d.y, d.x, e1.x * d.y - e1.y * d.x)), dot(e1, e2));
    let sum = a * b * n.z * one - b * n.x * along_a - a * n.y * along_b + rim;
    return max(sum, 0.0) * 0.159154943091895;
}

/// Turns the symmetric matrix m in the plane of the axes p and q so that m[p][q] becomes 0, and the columns of `axes` with it. Jacobi 1846.
fn jacobi_turn(m: mat3x3f, axes: ptr<function, mat3x3f>, p: u32, q: u32) -> mat3x3f {
    let off = m[p][q];
    if abs(off) < 1e-30 {
        return m;
    }
    let theta = (m[q][q] - m[p][p]) / (2.0 * off);
    // Of the two angles the smaller; beyond 1e15 the square of theta would overflow.
    let bounded = clamp(theta, -1e15, 1e15);
    let t = select(-1.0, 1.0, bounded >= 0.0) / (abs(bounded) + sqrt(bounded * bounded + 1.0));
    let c = inverseSqrt(1.0 + t * t);
    var turn = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    turn[p][p] = c;
    turn[q][q] = c;
    turn[p][q] = -t * c;
    turn[q][p] = t * c;
    *axes = *axes * turn;
    var turned = transpose(turn) * m * turn;
    turned[p][p] = m[p][p] - t * off;
    turned[q][q] = m[q][q] + t * off;
    turned[p][q] = 0.0;
    turned[q][p] = 0.0;
    return turned;
}

/// Form factor of the cone with these axes, columns of `axes`, on the squares of whose widths, by the axis, stands the diagonal `m`: its one negative
/// number is the middle's. `up` is the plane's normal, `inside` a direction in the cone, all in one frame.
fn diagonal_cone_factor(m: vec3f, axes: mat3x3f, up: vec3f, inside: vec3f) -> f32 {
    var n = up * axes;
    var side = inside * axes;
    var width = m;
    // The middle last.
    if width.x < min(width.y, width.z) {
        n = n.zyx;
        side = side.zyx;
        width = width.zyx;
    } else if width.y < width.z {
        n = n.xzy;
        side = side.xzy;
        width = width.xzy;
    }
    if side.z < 0.0 {
        n.z = -n.z;
    }
    if width.y > width.x {
        n = n.yxz;
        width = width.yxz;
    }
    let middle = max(-width.z, 1e-30);
    return cone_factor(sqrt(max(width.x, 0.0) / middle), sqrt(max(width.y, 0.0) / middle), n);
}

/// Form factor of an ellipse in space with the centre c and half axes a and b, which need not be perpendicular. Its cone has the same axes as
/// the matrix a a^T + b b^T - c c^T (Heitz and Hill 2017 use the inverse, which has no digits for a small one). In a frame along c
/// the small numbers of a small ellipse stay apart from the large one. Three sweeps bring the rest below 1e-7.
fn ellipse_factor(c: vec3f, a: vec3f, b: vec3f) -> f32 {
    let distance = length(c);
    let scale = 1.0 / max(distance, 1e-15);
    let frame = frame_of(unit_or(c, vec3f(0.0, 0.0, 1.0)));
    let a1 = (a * frame) * scale;
    let b1 = (b * frame) * scale;
    var m = mat3x3f(a1 * a1.x + b1 * b1.x, a1 * a1.y + b1 * b1.y, a1 * a1.z + b1 * b1.z - vec3f(0.0, 0.0, 1.0));
    var axes = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    for (var sweep = 0; sweep < 3; sweep++) {
        m = jacobi_turn(m, &axes, 0u, 1u);
        m = jacobi_turn(m, &axes, 0u, 2u);
        m = jacobi_turn(m, &axes, 1u, 2u);
    }
    return diagonal_cone_factor(vec3f(m[0][0], m[1][1], m[2][2]), axes, vec3f(frame[0].z, frame[1].z, frame[2].z), vec3f(0.0, 0.0, 1.0));
}

/// Form factor of the disk with the centre c, the unit normal `axis` and a radius, seen by a plane with the unit normal n. The axes of its
/// cone are one turn away from directions that are known: one of them is perpendicular to c and `axis`.
fn disk_factor(c: vec3f, axis: vec3f, radius: f32, n: vec3f) -> f32 {
    let distance = length(c);
    let middle = unit_or(c, n);
    let across = unit_or(cross(middle, axis), frame_of(middle)[0]);
    let third = cross(middle, across);
    let share = radius / max(distance, 1e-15);
    let depth = cross(axis, across);
    let b = vec2f(dot(depth, third), dot(depth, middle)) * share;
    var axes = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);
    let m = mat3x3f(share * share, 0.0, 0.0, 0.0, b.x * b.x, b.x * b.y, 0.0, b.x * b.y, b.y * b.y - 1.0);
    let diagonal = jacobi_turn(m, &axes, 1u, 2u);
    let up = vec3f(dot(across, n), dot(third, n), dot(middle, n));
    return diagonal_cone_factor(vec3f(diagonal[0][0], diagonal[1][1], diagonal[2][2]), axes, up, vec3f(0.0, 0.0, 1.0));
}
