/// 1 - cos of an angle in [0, pi]: twice the square of the half angle's sine. The sine is Taylor's polynomial of degree 13, whose
/// remainder at pi / 2 is 7e-10; of its own sine WGSL promises 5e-4, and a cosine near 1 has lost the angle.
fn versine(angle: f32) -> f32 {
    let x = 0.5 * clamp(angle, 0.0, PI);
    let y = x * x;
    let tail = y * (2.7557319e-6 + y * (-2.5052108e-8 + y * 1.6059044e-10));
    let sine = x * (1.0 + y * (-0.16666667 + y * (8.3333333e-3 + y * (-1.9841270e-4 + tail))));
    return 2.0 * sine * sine;
}

/// Intensity on the axis, cd: from the flux, or the intensity itself where no flux is given.
fn axis_intensity(i: u32, inner: f32, outer: f32) -> f32 {
    return select(instances[i].intensity, instances[i].flux / spread(inner, outer), instances[i].flux > 0.0);
}

/// Radiance toward v because of all spot lights, cd/m2.
fn light(s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < arrayLength(&instances); i++) {
        let to_light = instances[i].position - s.position;
        let square = dot(to_light, to_light);
        // A surface within 1e-15 m of the light has no direction to it: l and with it n.l vanish.
        let per_distance = inverseSqrt(max(square, 1e-30));
        let l = to_light * per_distance;
        let distance = square * per_distance;

        let axis = unit_or(instances[i].direction, vec3f(0.0));
        let along = -dot(axis, l);
        let aside = cross(axis, l);
        // 1 - cos is sin^2 / (1 + cos): a difference from 1 would have lost an angle near the axis.
        let off_axis = select(1.0 - along, dot(aside, aside) / (1.0 + max(along, 0.0)), along > 0.0);
        let inner = versine(instances[i].inner);
        let outer = versine(instances[i].outer);

        let intensity = axis_intensity(i, inner, outer) * cone(off_axis, inner, outer);
        let illuminance = intensity * falloff(distance, instances[i].range, instances[i].size) * dot(s.normal, l);
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
