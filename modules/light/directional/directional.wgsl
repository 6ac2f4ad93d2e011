/// Radiance toward v because of all directional lights, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let l = unit_or(-instances[i].direction, vec3f(0.0));
        let illuminance = instances[i].illuminance * dot(s.normal, l);
        if illuminance > 0.0 {
            var ray: Ray;
            ray.light = i;
            ray.direction = l;
            sum += instances[i].color * (illuminance * visible(ray, s)) * brdf(s, v, l);
        }
    }
    return sum;
}
