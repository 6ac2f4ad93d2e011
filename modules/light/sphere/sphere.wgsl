/// Luminance, or a flux spread over the surface: phi / (pi A), A = 4 pi r^2. The floor stands for a radius of a thousandth of a millimetre.
fn shape_luminance(i: u32, origin: vec3f, n: vec3f, along: vec3f, alpha: f32) -> vec3f {
    let area = 4.0 * PI * max(instances[i].radius * instances[i].radius, 1e-12);
    return instances[i].color * select(instances[i].luminance, instances[i].flux / (PI * area), instances[i].flux > 0.0);
}

fn shape_centre(i: u32) -> vec3f {
    return instances[i].position;
}

fn shape_radius(i: u32) -> f32 {
    return instances[i].radius;
}

fn shape_projected_area(i: u32, origin: vec3f) -> f32 {
    return PI * instances[i].radius * instances[i].radius;
}

fn shape_sample(i: u32, origin: vec3f, u: vec2f) -> vec3f {
    return sphere_sample(instances[i].position - origin, instances[i].radius, u);
}

fn shape_pdf(i: u32, origin: vec3f, l: vec3f) -> f32 {
    return sphere_pdf(instances[i].position - origin, instances[i].radius, l);
}

fn shape_radiance(i: u32, origin: vec3f, l: vec3f) -> vec3f {
    return select(vec3f(0.0), shape_luminance(i, origin, l, l, 0.0), shape_pdf(i, origin, l) > 0.0);
}

/// Across the horizon the segments of Nusselt's projection.
fn shape_configuration_factor(i: u32, origin: vec3f, n: vec3f) -> f32 {
    let c = instances[i].position - origin;
    let per_distance = inverseSqrt(max(dot(c, c), 1e-30));
    return sphere_factor(instances[i].radius * per_distance, dot(c, n) * per_distance, length(cross(c, n)) * per_distance);
}

fn shape_form_factor(i: u32, origin: vec3f, local: mat3x3f) -> f32 {
    return mapped_sphere_factor(instances[i].position - origin, instances[i].radius, local);
}

fn shape_toward(i: u32, origin: vec3f, along: vec3f) -> vec3f {
    return sphere_toward(instances[i].position - origin, instances[i].radius, along);
}

fn shape_corners(i: u32, origin: vec3f) -> u32 {
    return CIRCLE_CORNERS;
}

fn shape_corner(i: u32, origin: vec3f, k: u32) -> vec3f {
    return sphere_corner(instances[i].position - origin, instances[i].radius, k);
}

/// Radiance toward v because of all spheres, cd/m2.
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
