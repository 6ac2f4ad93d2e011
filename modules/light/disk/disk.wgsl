/// Columns: two unit directions in the disk, and the normal of its front.
fn axes(i: u32) -> mat3x3f {
    return frame_of(unit_or(instances[i].direction, vec3f(0.0, 0.0, 1.0)));
}

/// Area, m2. The floor stands for a radius of a thousandth of a millimetre, whose flux must not become an infinite luminance.
fn surface_area(i: u32) -> f32 {
    return PI * max(instances[i].radius * instances[i].radius, 1e-12);
}

/// Luminance, or a flux spread over all that shines: phi / (pi A).
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    var area = surface_area(i);
    if params.two_sided {
        area *= 2.0;
    }
    return instances[i].color * select(instances[i].luminance, instances[i].flux / (PI * area), instances[i].flux > 0.0);
}

fn shape_centre(i: u32) -> vec3f {
    return instances[i].position;
}

fn shape_radius(i: u32) -> f32 {
    return instances[i].radius;
}

fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    let cosine = dot(unit_or(origin - instances[i].position, vec3f(0.0)), axes(i)[2]);
    return surface_area(i) * abs(cosine) * plane_shines(cosine, params.two_sided);
}

/// Evenly over the area.
fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    let frame = axes(i);
    let out = instances[i].radius * sqrt(u.x);
    // Of angles beyond pi WGSL promises no sine.
    let turn = PI * (2.0 * u.y - 1.0);
    return unit_or(instances[i].position - origin + frame[0] * (out * cos(turn)) + frame[1] * (out * sin(turn)), -frame[2]);
}

/// d^2 / (A cos), 1/sr, where l meets the disk.
fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    let frame = axes(i);
    let c = (instances[i].position - origin) * frame;
    let ray = l * frame;
    let distance = plane_distance(c, ray);
    if distance <= 0.0 {
        return 0.0;
    }
    // What was drawn on the rim may come back beyond it, by roundings of the distance.
    let is_in = length(ray.xy * distance - c.xy) <= instances[i].radius + 1e-6 * distance;
    return select(0.0, distance * distance / (surface_area(i) * abs(ray.z)), is_in);
}

fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return shape_luminance(i, origin, l, l, 0.0) * (plane_shines(-dot(l, axes(i)[2]), params.two_sided) * sign(shape_pdf(i, origin, l)));
}

fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    let normal = axes(i)[2];
    let c = instances[i].position - origin;
    return disk_factor(c, normal, instances[i].radius, n) * plane_shines(-dot(c, normal), params.two_sided);
}

fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    let frame = axes(i);
    let c = instances[i].position - origin;
    let factor = ellipse_factor(local * c, local * (frame[0] * instances[i].radius), local * (frame[1] * instances[i].radius));
    return factor * plane_shines(-dot(c, frame[2]), params.two_sided);
}

/// Where the ray meets the plane, moved to the nearest point of the disk.
fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    let frame = axes(i);
    let track = plane_track((instances[i].position - origin) * frame, along * frame);
    let at = track * min(instances[i].radius / max(length(track), 1e-15), 1.0);
    return instances[i].position - origin + frame[0] * at.x + frame[1] * at.y;
}

fn shape_corners(i: u32, origin: vec3f) -> u32 {
    return select(0u, CIRCLE_CORNERS, plane_shines(dot(origin - instances[i].position, axes(i)[2]), params.two_sided) > 0.0);
}

fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    let frame = axes(i);
    let at = circle_corner(k) * instances[i].radius;
    return plane_point(instances[i].position - origin, frame, at);
}

/// Radiance toward v because of all disks, cd/m2.
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
