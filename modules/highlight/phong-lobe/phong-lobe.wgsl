/// A Phong lobe, wider in one direction than in the other.
struct Phong {
    /// Columns: in the plane of incidence and across it, both divided by the lobe's width in their direction, so that the lobe is round; and its axis.
    frame: mat3x3f,
    /// Half the power of the cosine that is left outside of a cone.
    power: f32,
    /// The squared tangent where only 1e-4 is left.
    reach2: f32,
}

/// Logarithm of what is left of the lobe outside of the cone whose rim has the squared tangent x: of (1 + x)^-power = cos^(n + 1).
fn log_outside(x: f32, power: f32) -> f32 {
    let rest = 1.0 / (1.0 + x);
    return power * log_rest(x * rest, rest);
}

/// The lobe of GGX facets as a Phong lobe: its axis between the mirrored view and the normal, its two widths.
fn phong_of(s: Surface, v: vec3f, alpha: f32, m: f32) -> Phong {
    let y = roughness_of_alpha(alpha);
    let u = sqrt(m * (1.0 + alpha) / (m + alpha));
    let widths = vec4f(1.0, y, alpha, alpha * y);
    let turned = dot(widths, vec4f(-0.70906, 3.70494, -4.04103, 2.05721))
        + u * (dot(widths, vec4f(0.61918, -2.01384, 4.96504, -3.69042))
        + u * dot(widths, vec4f(0.09507, 0.80925, -2.90379, 2.12775)));
    let forward = dot(widths, vec4f(-4.35927, 51.21716, -92.07924, 46.75243))
        + u * (dot(widths, vec4f(13.28191, -115.82194, 217.11332, -115.33256))
        + u * dot(widths, vec4f(-6.40452, 65.46424, -128.51483, 69.76415)));
    let aside = dot(widths, vec4f(12.41603, -30.18279, 32.01018, -12.96543))
        + u * (dot(widths, vec4f(-44.07016, 173.29198, -222.09439, 93.23991))
        + u * dot(widths, vec4f(34.27689, -142.65557, 185.46923, -77.95703)));
    let rise = alpha * (1.0 + m) / (m + alpha);
    let mirror = normalize(reflect(-v, s.normal));
    let axis = normalize(mix(mirror, s.normal, clamp(turned * rise * rise, 0.0, 1.0)));
    // Looking straight down any direction is across: the lobe is round there.
    let across = cross(s.normal, v);
    let sine = length(across);
    let side = normalize(select(frame_of(axis)[1], across, sine > 1e-4));
    let wide = vec2f(max(forward, 0.5), max(aside, 0.3) * sqrt(m * m + alpha));
    let stretch = sqrt(wide.y / wide.x);
    var lobe: Phong;
    lobe.frame = mat3x3f(normalize(cross(side, axis)) * stretch, side / stretch, axis);
    lobe.power = 1.0 / (alpha * alpha * wide.x * wide.y);
    let decay = 9.21034 / lobe.power;
    lobe.reach2 = max(exp(min(decay, 60.0)) - 1.0, decay);
    return lobe;
}

/// What of the lobe is inside of the cone through a point of a line whose nearest point has the squared tangent d2, times 1 + 1 / (power x): between 1 and
/// 1.3 wherever the point is. c2 = d2 + 1 / power; `slope` is the point's distance from the nearest one, by c.
fn level_inside(d2: f32, c2: f32, slope: f32, power: f32) -> f32 {
    let x = max(d2 + c2 * slope * slope, 1e-24);
    let left = log_outside(x, power);
    return -left * exprel(left) * (1.0 + 1.0 / (power * x));
}

/// The same at the angles from `middle` with the half tangents t and -t, weighted with the width that they have there.
fn pair_inside(d2: f32, c2: f32, middle: vec2f, t: f32, power: f32) -> f32 {
    let level = middle * (1.0 - t * t);
    let tilt = 2.0 * t * vec2f(-middle.y, middle.x);
    let after = level + tilt;
    let before = level - tilt;
    let sum = level_inside(d2, c2, after.y / max(after.x, 1e-9), power) + level_inside(d2, c2, before.y / max(before.x, 1e-9), power);
    return sum / (1.0 + t * t);
}

/// The integral of what of the lobe is inside over the angle phi about the axis, along a line from one unit vector, cosine and sine of the angle from its
/// nearest point, to another. With the distance d of that point, tan(phi) = c / d tan(psi) and c^2 = d^2 + 1 / power it is d / c times that of `level_inside` over
/// psi: Gauss and Legendre's points, four or over a short way two, by the tangent of half the angle, so that no sine is needed.
fn line_inside(d: f32, first: vec2f, last: vec2f, power: f32) -> f32 {
    let d2 = d * d;
    let c2 = d2 + 1.0 / power;
    let c = sqrt(c2);
    let end = normalize(last * vec2f(c, d));
    let middle = normalize(normalize(first * vec2f(c, d)) + end);
    let cosine = dot(middle, end);
    let quarter = (middle.x * end.y - middle.y * end.x) / (1.0 + cosine);
    let scale = 2.0 * quarter * d / c;
    if cosine > 0.95 {
        return scale * pair_inside(d2, c2, middle, quarter * 0.5773502692, power);
    }
    let inner = pair_inside(d2, c2, middle, quarter * 0.3399810436, power);
    return scale * (0.6521451549 * inner + 0.3478548451 * pair_inside(d2, c2, middle, quarter * 0.8611363116, power));
}

/// What the edge from p to q in the lobe's frame gives to 2 pi times the share of the lobe within the outline: by Stokes' theorem the integral of what is
/// inside of a cone over the angle about the axis. The angles add up to whole turns, which are counted where they cross a half plane.
fn edge_inside(p: vec3f, q: vec3f, lobe: Phong) -> f32 {
    let normal = cross(p, q - p);
    let turn = sign(normal.z);
    var sum = 0.0;
    if (p.y > 0.0) != (q.y > 0.0) && (q.y > 0.0) == (turn > 0.0) {
        sum = 2.0 * PI;
    }
    let tilt = max(length(normal.xy), 1e-30);
    // Below 1e-12 the axis is on the edge.
    let d = max(abs(normal.z) / tilt, 1e-12);
    // Cosine of the angle from the nearest point to where the edge leaves the lobe.
    let leave = d * inverseSqrt(lobe.reach2);
    if leave >= 1.0 || turn == 0.0 {
        return turn * sum;
    }
    let near = normal.xy * (-turn / tilt);
    let along = vec2f(-near.y, near.x) * turn;
    let rim = sqrt((1.0 - leave) * (1.0 + leave));
    let p1 = p.xy * inverseSqrt(max(dot(p.xy, p.xy), 1e-30));
    let q1 = q.xy * inverseSqrt(max(dot(q.xy, q.xy), 1e-30));
    var first = vec2f(dot(p1, near), dot(p1, along));
    var last = vec2f(dot(q1, near), dot(q1, along));
    if first.x < leave {
        first = vec2f(leave, select(-rim, 2.0, first.y >= 0.0));
    }
    if last.x < leave {
        last = vec2f(leave, select(rim, -2.0, last.y <= 0.0));
    }
    if first.y >= last.y {
        return turn * sum;
    }
    let angle = angle_of(max(first.x * last.y - first.y * last.x, 0.0), dot(first, last));
    return turn * (sum - angle + line_inside(d, first, last, lobe.power));
}

/// The way along the outline, as far as it is above the horizon.
struct Way {
    first: vec3f,
    last: vec3f,
    /// Corners so far.
    count: f32,
    /// Sum of `edge_inside`.
    sum: f32,
    /// Seen from the first corner, in the plane at distance 1 along the lobe's axis: twice the area, the sum of all corners, the largest distance squared.
    area: f32,
    middle: vec2f,
    extent2: f32,
}

fn go_to(way: ptr<function, Way>, p: vec3f, lobe: Phong) {
    if (*way).count == 0.0 {
        (*way).first = p;
    } else {
        (*way).sum += edge_inside((*way).last, p, lobe);
        let start = (*way).first.xy / (*way).first.z;
        let before = (*way).last.xy / (*way).last.z - start;
        let now = p.xy / p.z - start;
        (*way).area += before.x * now.y - before.y * now.x;
        (*way).middle += now;
        // Behind the lobe there is no such plane.
        (*way).extent2 = max((*way).extent2, select(1e30, dot(now, now), p.z > 0.0 && (*way).first.z > 0.0));
    }
    (*way).last = p;
    (*way).count += 1.0;
}

/// Share of the lobe that is within the light's outline, above the surface's horizon.
fn share_within(i: u32, s: Surface, lobe: Phong) -> f32 {
    let count = shape_corners(i, s.position);
    if count == 0u {
        return 0.0;
    }
    var way: Way;
    var corner = shape_corner(i, s.position, count - 1u);
    var height = dot(corner, s.normal);
    for (var k = 0u; k < count; k++) {
        let next = shape_corner(i, s.position, k);
        let next_height = dot(next, s.normal);
        if (height > 0.0) != (next_height > 0.0) {
            go_to(&way, (corner + (next - corner) * (height / (height - next_height))) * lobe.frame, lobe);
        }
        if next_height > 0.0 {
            go_to(&way, next * lobe.frame, lobe);
        }
        corner = next;
        height = next_height;
    }
    if way.count < 3.0 {
        return 0.0;
    }
    if way.extent2 * lobe.power < 1e-2 {
        // The edges of so small a light cancel; the lobe is even over it.
        let middle = way.first.xy / way.first.z + way.middle / way.count;
        let x = dot(middle, middle);
        return min(abs(way.area) * 0.5 * INV_PI * lobe.power * exp(log_outside(x, lobe.power)) / (1.0 + x), 1.0);
    }
    return clamp(abs(way.sum + edge_inside(way.last, way.first, lobe)) * 0.5 * INV_PI, 0.0, 1.0);
}

/// Luminance times albedo times the share of the lobe.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let m = min(dot(s.normal, v), 1.0);
    if m <= 0.0 {
        return vec3f(0.0);
    }
    let alpha = clamp(s.alpha, 1e-4, 1.0);
    let inside = share_within(i, s, phong_of(s, v, alpha, max(m, 0.02)));
    let albedo = facet_albedo(s, m);
    let mirror = normalize(reflect(-v, s.normal));
    return shape_luminance(i, s.position, s.normal, mirror, alpha) * (s.f0 * albedo.x + s.f90 * albedo.y) * inside;
}
