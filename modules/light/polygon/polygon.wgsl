/// Columns: the unit directions of the corners' coordinates, and the normal of the front.
fn axes(i: u32) -> mat3x3f {
    return plane_axes(instances[i].direction, instances[i].right);
}

/// All corners, in the plane.
fn corners(i: u32) -> array<vec2f, 16> {
    return array<vec2f, 16>(
        instances[i].p0, instances[i].p1, instances[i].p2, instances[i].p3, instances[i].p4, instances[i].p5, instances[i].p6, instances[i].p7,
        instances[i].p8, instances[i].p9, instances[i].p10, instances[i].p11, instances[i].p12, instances[i].p13, instances[i].p14, instances[i].p15,
    );
}

/// How many of them count.
fn corner_count(i: u32) -> u32 {
    return clamp(instances[i].corners, 3u, 16u);
}

/// The polygon in numbers.
struct Outline {
    /// Signed area, m2: positive where the corners turn counterclockwise.
    area: f32,
    /// Area of the triangles that its fan around the first corner has, each counted positive, m2. More than `area` where it is not convex.
    fan: f32,
    /// Centre of its area.
    centre: vec2f,
    /// Largest distance of a corner from the centre, m.
    extent: f32,
}

fn outline(i: u32) -> Outline {
    var p = corners(i);
    let count = corner_count(i);
    var found: Outline;
    var moment = vec2f(0.0);
    for (var k = 1u; k + 1u < count; k++) {
        let a = p[k] - p[0];
        let b = p[k + 1u] - p[0];
        let twice = a.x * b.y - a.y * b.x;
        found.area += 0.5 * twice;
        found.fan += 0.5 * abs(twice);
        moment += (a + b) * (twice / 6.0);
    }
    let floor = select(-1e-12, 1e-12, found.area >= 0.0);
    found.centre = p[0] + moment / select(found.area, floor, abs(found.area) < 1e-12);
    for (var k = 0u; k < count; k++) {
        found.extent = max(found.extent, length(p[k] - found.centre));
    }
    return found;
}

/// How often the fan's triangles cover the point, and how often the outline goes around it: the same for a convex polygon.
fn cover(i: u32, at: vec2f) -> vec2i {
    var p = corners(i);
    var covers = vec2i(0);
    for (var k = 1u; k + 1u < corner_count(i); k++) {
        let turn = triangle_turn(p[0] - at, p[k] - at, p[k + 1u] - at);
        covers += vec2i(abs(turn), turn);
    }
    return covers;
}

/// Luminance, or a flux spread over all that shines: phi / (pi A); no less than 1e-12 m2.
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    let area = max(abs(outline(i).area), 1e-12) * select(1.0, 2.0, params.two_sided);
    return instances[i].color * select(instances[i].luminance, instances[i].flux / (PI * area), instances[i].flux > 0.0);
}

fn shape_centre(i: u32) -> vec3f {
    return plane_point(instances[i].position, axes(i), outline(i).centre);
}

fn shape_radius(i: u32) -> f32 {
    return sqrt(abs(outline(i).area) * INV_PI);
}

fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    let cosine = dot(unit_or(origin - shape_centre(i), vec3f(0.0)), axes(i)[2]);
    return abs(outline(i).area * cosine) * plane_shines(cosine, params.two_sided);
}

/// Evenly over the triangles of the fan around the first corner. Where the polygon is not convex some of them reach beyond it.
fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    let frame = axes(i);
    var p = corners(i);
    var left = u.x * outline(i).fan;
    var at = p[0];
    for (var k = 1u; k + 1u < corner_count(i); k++) {
        let a = p[k] - p[0];
        let b = p[k + 1u] - p[0];
        let area = 0.5 * abs(a.x * b.y - a.y * b.x);
        if left < area || k + 2u == corner_count(i) {
            // Turk 1990: even over a triangle.
            let root = sqrt(clamp(left / max(area, 1e-30), 0.0, 1.0));
            at = p[0] + a * (root * (1.0 - u.y)) + b * (root * u.y);
            break;
        }
        left -= area;
    }
    return unit_or(instances[i].position - origin + frame[0] * at.x + frame[1] * at.y, -frame[2]);
}

/// What a ray from the origin along l meets: how often the fan covers it, how often the outline goes around it, and d^2 / cos.
fn met(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    let frame = axes(i);
    let c = (instances[i].position - origin) * frame;
    let ray = l * frame;
    let distance = plane_distance(c, ray);
    if distance <= 0.0 {
        return vec3f(0.0);
    }
    let covers = cover(i, ray.xy * distance - c.xy);
    return vec3f(vec2f(covers), distance * distance / abs(ray.z));
}

/// d^2 / (A cos), 1/sr, for each triangle of the fan where l meets it.
fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    let ray = met(i, origin, l);
    return ray.x * ray.z / max(outline(i).fan, 1e-12);
}

fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return shape_luminance(i, origin, l, l, 0.0) * (plane_shines(-dot(l, axes(i)[2]), params.two_sided) * abs(met(i, origin, l).y));
}

fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    return shape_form_factor(i, origin, transpose(frame_of(n)));
}

/// The form factor of a polygon that is small for its distance: the triangles of the fan around the first corner above the horizon, of which each is
/// as good as a point. Their areas come from the plane's coordinates, so nothing cancels.
fn far_factor(i: u32, c: vec3f, a: vec3f, b: vec3f) -> f32 {
    var p = corners(i);
    let count = corner_count(i);
    let volume = -dot(c, cross(a, b));
    var first = vec2f(0.0);
    var last = vec2f(0.0);
    var found = 0u;
    var sum = 0.0;
    for (var k = 0u; k < count; k++) {
        let q = p[k];
        let next = p[select(k + 1u, 0u, k + 1u == count)];
        let height = c.z + a.z * q.x + b.z * q.y;
        let next_height = c.z + a.z * next.x + b.z * next.y;
        var at = array<vec2f, 2>(q, q);
        var some = select(0u, 1u, height >= 0.0);
        if (height >= 0.0) != (next_height >= 0.0) {
            at[some] = q + (next - q) * (height / (height - next_height));
            some++;
        }
        for (var which = 0u; which < some; which++) {
            if found == 0u {
                first = at[which];
            }
            let u = last - first;
            let w = at[which] - first;
            if found > 1u {
                let at_middle = first + (u + w) / 3.0;
                let middle = c + a * at_middle.x + b * at_middle.y;
                let square = dot(middle, middle);
                sum += 0.5 * (u.x * w.y - u.y * w.x) * volume * middle.z / max(square * square, 1e-37);
            }
            last = at[which];
            found++;
        }
    }
    return sum * INV_PI;
}

/// By its outline, edge by edge, whether convex or not. Seen so far away that the edges' terms cancel, it is flat: at an extent of a hundredth of the
/// distance either way is off by less than 1e-4.
fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    let frame = axes(i);
    var p = corners(i);
    let count = corner_count(i);
    let whole = outline(i);
    let c = local * (instances[i].position - origin);
    let a = local * frame[0];
    let b = local * frame[1];
    let middle = c + a * whole.centre.x + b * whole.centre.y;
    let volume = -dot(c, cross(a, b)) * sign(whole.area);
    var factor = 0.0;
    if whole.extent * max(length(a), length(b)) < 1e-2 * length(middle) {
        factor = far_factor(i, c, a, b);
    } else if volume != 0.0 {
        var rim = vec2f(0.0);
        var q = p[count - 1u];
        var at = c + a * q.x + b * q.y;
        for (var k = 0u; k < count; k++) {
            let step = p[k] - q;
            let next = c + a * p[k].x + b * p[k].y;
            factor -= edge_above(at, next, a * step.x + b * step.y, &rim);
            q = p[k];
            at = next;
        }
        factor *= 0.159154943091895;
    }
    // Positive in front, for corners in either order; a mirroring map turns the outline around.
    let signed = factor * sign(whole.area * determinant(local));
    return select(max(signed, 0.0), abs(signed), params.two_sided);
}

/// Where the ray meets the plane; if that is outside, the nearest point of the outline.
fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    let frame = axes(i);
    var p = corners(i);
    let count = corner_count(i);
    let track = plane_track((instances[i].position - origin) * frame, along * frame);
    var at = track;
    if cover(i, track).y == 0 {
        var best = 3e38;
        var q = p[count - 1u];
        for (var k = 0u; k < count; k++) {
            let edge = p[k] - q;
            let near = q + edge * clamp(dot(track - q, edge) / max(dot(edge, edge), 1e-30), 0.0, 1.0);
            let far = dot(near - track, near - track);
            at = select(at, near, far < best);
            best = min(best, far);
            q = p[k];
        }
    }
    return instances[i].position - origin + frame[0] * at.x + frame[1] * at.y;
}

fn shape_corners(i: u32, origin: vec3f) -> u32 {
    return select(0u, corner_count(i), plane_shines(dot(origin - instances[i].position, axes(i)[2]), params.two_sided) > 0.0);
}

fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    var p = corners(i);
    return plane_point(instances[i].position - origin, axes(i), p[k]);
}

/// Radiance toward v because of all polygons, cd/m2.
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
