/// Columns: unit directions along width and height, and the normal of the front.
fn axes(i: u32) -> mat3x3f {
    return plane_axes(instances[i].direction, instances[i].right);
}

/// Area, m2. The floor stands for a square of a thousandth of a millimetre, whose flux must not become an infinite luminance.
fn surface_area(i: u32) -> f32 {
    return max(instances[i].size.x * instances[i].size.y, 1e-12);
}

/// What of the picture is in the lobe around `along`.
fn pictured(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    let axis = axes(i);
    let per_size = 1.0 / max(instances[i].size, vec2f(1e-12));
    let seen = plane_footprint((instances[i].position - origin) * axis, n * axis, along * axis, alpha, 0.5 * instances[i].size);
    // Rows count from the top.
    return picture(0.5 + vec2f(seen.x, -seen.y) * per_size, seen.zw * per_size);
}

/// Luminance, or a flux spread over all that shines: phi / (pi A), over the mean of a picture.
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    var area = surface_area(i);
    if params.two_sided {
        area *= 2.0;
    }
    if params.pictured {
        // Of a black picture nothing can have a flux.
        area *= max(luminance(picture_mean()), 1e-6);
    }
    let full = instances[i].color * select(instances[i].luminance, instances[i].flux / (PI * area), instances[i].flux > 0.0);
    if params.pictured {
        return full * pictured(i, origin, n, along, alpha);
    }
    return full;
}

fn shape_centre(i: u32) -> vec3f {
    return instances[i].position;
}

/// Of the disk of the same area.
fn shape_radius(i: u32) -> f32 {
    return sqrt(surface_area(i) * INV_PI);
}

fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    let cosine = dot(unit_or(origin - instances[i].position, vec3f(0.0)), axes(i)[2]);
    return surface_area(i) * abs(cosine) * plane_shines(cosine, params.two_sided);
}

/// Evenly over the area.
fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    let frame = axes(i);
    let at = instances[i].size * (u - 0.5);
    return unit_or(instances[i].position - origin + frame[0] * at.x + frame[1] * at.y, -frame[2]);
}

/// d^2 / (A cos), 1/sr, where l meets the rectangle.
fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    let frame = axes(i);
    let c = (instances[i].position - origin) * frame;
    let ray = l * frame;
    let distance = plane_distance(c, ray);
    if distance <= 0.0 {
        return 0.0;
    }
    let offset = abs(ray.xy * distance - c.xy);
    // What was drawn on the edge may come back beyond it, by roundings of the distance.
    let slack = 1e-6 * distance;
    let is_in = all(offset <= 0.5 * instances[i].size + slack);
    return select(0.0, distance * distance / (surface_area(i) * abs(ray.z)), is_in);
}

fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return shape_luminance(i, origin, l, l, 0.0) * (plane_shines(-dot(l, axes(i)[2]), params.two_sided) * sign(shape_pdf(i, origin, l)));
}

fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    return shape_form_factor(i, origin, transpose(frame_of(n)));
}

fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    let frame = axes(i);
    let half = 0.5 * instances[i].size;
    let c = local * (instances[i].position - origin);
    // Positive in front; a mirroring map turns the contour around.
    let factor = parallelogram_factor(c, local * (frame[0] * half.x), local * (frame[1] * half.y)) * sign(determinant(local));
    return select(max(factor, 0.0), abs(factor), params.two_sided);
}

/// Where the ray meets the plane, moved to the nearest point of the rectangle.
fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    let frame = axes(i);
    let half = 0.5 * instances[i].size;
    let at = clamp(plane_track((instances[i].position - origin) * frame, along * frame), -half, half);
    return instances[i].position - origin + frame[0] * at.x + frame[1] * at.y;
}

fn shape_corners(i: u32, origin: vec3f) -> u32 {
    return select(0u, 4u, plane_shines(dot(origin - instances[i].position, axes(i)[2]), params.two_sided) > 0.0);
}

fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    let frame = axes(i);
    let is_right = k == 1u || k == 2u;
    let at = instances[i].size * vec2f(select(-0.5, 0.5, is_right), select(-0.5, 0.5, k > 1u));
    return plane_point(instances[i].position - origin, frame, at);
}

/// Radiance toward v because of all rectangles, cd/m2.
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
