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
        let illuminance = instances[i].intensity * falloff(distance, instances[i].range, instances[i].size) * dot(s.normal, l);
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
