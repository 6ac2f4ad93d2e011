// What all functions here have in common: the shaded point is the origin, its plane is z = 0, and what is below it does not count. A form
// factor is the integral of cos(theta) over a set of directions, divided by pi: 1 for all directions above the plane.

/// What the edge of an outline from p to q = p + d gives to 2 pi times its form factor (Lambert 1760; Baum et al. 1989): its part above the
/// horizon, and the way along the horizon between where the outline goes below it and where it comes back. `rim` remembers the first such
/// place; it is 0 before the first edge. The sine of the edge's angle comes from p x d, which has its digits where p x q has none; but which side
/// q is on must be what the next edge takes it for, so it is not computed anew.
fn edge_above(p: vec3f, q: vec3f, d: vec3f, rim: ptr<function, vec2f>) -> f32 {
    if p.z < 0.0 && q.z < 0.0 {
        return 0.0;
    }
    var start = p;
    var part = d;
    var along_horizon = 0.0;
    if p.z < 0.0 {
        let t = p.z / (p.z - q.z);
        start = vec3f(p.xy + d.xy * t, 0.0);
        part = vec3f(d.xy * (1.0 - t), q.z);
        along_horizon = crossing(start.xy, rim);
    } else if q.z < 0.0 {
        part = vec3f(d.xy * (p.z / (p.z - q.z)), -p.z);
        along_horizon = -crossing(start.xy + part.xy, rim);
    }
    let area = cross(start, part);
    return area.z * angle_over_sine(length(area), dot(start, start + part)) + along_horizon;
}

/// Signed angle about the zenith from the outline's first crossing of the horizon to this one: below half a turn for whatever is seen.
fn crossing(at: vec2f, rim: ptr<function, vec2f>) -> f32 {
    let first = *rim;
    if all(first == vec2f(0.0)) {
        *rim = at;
        return 0.0;
    }
    let sine = first.x * at.y - first.y * at.x;
    let angle = angle_of(abs(sine), dot(first, at));
    return select(angle, -angle, sine < 0.0);
}

/// Integral of max(z, 0) / |p|^4 along p = m + x d for x from -1 to 1, in closed form: with it a surface is integrated in one of
/// its two directions, and the other may be narrow. s is the distance along the line from the point nearest to the origin, h that point's distance.
fn segment_integral(m: vec3f, d: vec3f) -> f32 {
    if m.z + abs(d.z) <= 0.0 {
        return 0.0;
    }
    var first = -1.0;
    var last = 1.0;
    if m.z - d.z < 0.0 {
        first = -m.z / d.z;
    }
    if m.z + d.z < 0.0 {
        last = -m.z / d.z;
    }
    // 1e-30 is the square of a length that no light has.
    let square = max(dot(d, d), 1e-30);
    let per_length = inverseSqrt(square);
    let foot = dot(m, d) * per_length;
    let nearest = m - d * (foot * per_length);
    let h2 = max(dot(nearest, nearest), 1e-20 * dot(m, m));
    let s0 = first * square * per_length + foot;
    let s1 = last * square * per_length + foot;
    let span = (last - first) * square * per_length;
    let slope = d.z * per_length;
    let product = h2 + s0 * s1;
    let ends = max((h2 + s0 * s0) * (h2 + s1 * s1), 1e-37);
    let h = sqrt(h2);
    if product > h * span {
        // Seen under less than 45 degrees: with w = h span / product, ((1 + w^2) atan(w) / w - 1) / w^2 is a polynomial, relative error 1.5e-7.
        let y = h2 * span * span / (product * product);
        let high = -0.03058026991 + y * (0.01631943568 + y * (-0.006581583803 + y * 0.001328569385));
        let series = 0.6666665667 + y * (-0.1333230428 + y * (0.0569667275 + y * high));
        let bend = span * span * series / product;
        let middle = m.z + 0.5 * (first + last) * d.z;
        return 0.5 * span * per_length * (middle * (2.0 + bend) - slope * 0.5 * (s0 + s1) * bend) / ends;
    }
    let straight = (h2 - s0 * s1) / ends + angle_of(h * span, product) / (h * span);
    return 0.5 * span * per_length * (nearest.z * straight / h2 + slope * (s0 + s1) / ends);
}

/// Form factor of the parallelogram with the centre c and half sides a and b, positive where it is seen from the side that a x b points to.
///
/// Where it is narrow the contour's terms cancel; there it is integrated across its width with Gauss and Legendre's four points, over
/// segments. Up to a half width of a tenth of the distance that is exact to 1e-8.
fn parallelogram_factor(c: vec3f, a: vec3f, b: vec3f) -> f32 {
    let normal = cross(a, b);
    let volume = -dot(c, normal);
    let is_long = dot(a, a) >= dot(b, b);
    let long = select(b, a, is_long);
    let short = select(a, b, is_long);
    // The nearest point of the long axis.
    let nearest = c - long * clamp(dot(c, long) / max(dot(long, long), 1e-30), -1.0, 1.0);
    if dot(short, short) < 0.01 * dot(nearest, nearest) {
        // Only where something of the segment is above the horizon.
        let height = c.z + abs(long.z);
        if height + abs(short.z) <= 0.0 {
            return 0.0;
        }
        let edge = -height / select(short.z, 1.0, short.z == 0.0);
        let first = select(-1.0, edge, height - short.z < 0.0);
        let last = select(1.0, edge, height + short.z < 0.0);
        let middle = 0.5 * (first + last);
        let half = 0.5 * (last - first);
        var sum = 0.0;
        sum += 0.347854845 * segment_integral(c + short * (middle - half * 0.861136312), long);
        sum += 0.652145155 * segment_integral(c + short * (middle - half * 0.339981044), long);
        sum += 0.652145155 * segment_integral(c + short * (middle + half * 0.339981044), long);
        sum += 0.347854845 * segment_integral(c + short * (middle + half * 0.861136312), long);
        return volume * half * sum * 0.318309886183791;
    }
    if volume == 0.0 {
        return 0.0;
    }
    let p0 = c - a - b;
    let p1 = c + a - b;
    let p2 = c + a + b;
    let p3 = c - a + b;
    var rim = vec2f(0.0);
    var sum = edge_above(p0, p1, 2.0 * a, &rim);
    sum += edge_above(p1, p2, 2.0 * b, &rim);
    sum += edge_above(p2, p3, -2.0 * a, &rim);
    sum += edge_above(p3, p0, -2.0 * b, &rim);
    // Seen from its front the contour turns clockwise.
    return -sum * 0.159154943091895;
}
