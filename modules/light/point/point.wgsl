/// Illuminance of a perpendicular surface for an intensity of 1 cd, 1/m2.
///
/// The window takes the light to 0 at its range; a range of 0 leaves the inverse square alone. Within `size` of the
/// light the inverse square, meant for a point, would grow without bound.
fn attenuation(i: u32, distance: f32) -> f32 {
    let nearest = max(distance, instances[i].size);
    let x = min(distance, instances[i].range) / max(instances[i].range, 1e-15);
    let window = 1.0 - x * x * x * x;
    return window * window / (nearest * nearest);
}

/// Radiance toward v because of all point lights, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let to_light = instances[i].position - s.position;
        let square = dot(to_light, to_light);
        // A surface within 1e-15 m of the light has no direction to it: l and with it n.l vanish.
        let per_distance = inverseSqrt(max(square, 1e-30));
        let l = to_light * per_distance;
        let distance = square * per_distance;
        let illuminance = instances[i].intensity * attenuation(i, distance) * dot(s.normal, l);
        if illuminance > 0.0 {
            var ray: Ray;
            ray.light = i;
            ray.direction = l;
            ray.distance = distance;
            sum += instances[i].color * (illuminance * visible(ray, s)) * brdf(s, v, l);
        }
    }
    return sum;
}
