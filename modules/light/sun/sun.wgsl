/// Radiance toward v because of all suns, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let l = unit_or(-instances[i].direction, vec3f(0.0));
        let radius = 0.5 * instances[i].angular_diameter;
        // Nothing of the disc is above the horizon: the sine of its radius is less than the radius.
        if instances[i].illuminance > 0.0 && dot(s.normal, l) > -radius && dot(l, l) > 0.5 {
            var ray: Ray;
            ray.light = i;
            ray.direction = l;
            sum += instances[i].color * (instances[i].illuminance * visible(ray, s)) * disc(s, v, l, radius);
        }
    }
    return sum;
}
