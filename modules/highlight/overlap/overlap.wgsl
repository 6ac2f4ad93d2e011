/// Angular radius of a cap by 1 - cos of it.
fn cap_angle(fall: f32) -> f32 {
    return angle_of(sqrt(fall * (2.0 - fall)), 1.0 - fall);
}

/// The lobe is a cone around the mirror direction that has its full height: of a solid angle of 4 pi alpha^2, so that a light that fills it is
/// mirrored as a whole. The light is a cone as well, as wide as a disk that shows its area. The BRDF is taken in the middle of what they share.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    let mirror = reflect(-v, s.normal);
    let offset = shape_centre(i) - s.position;
    let c = unit_or(offset, s.normal);
    let lobe_fall = min(2.0 * s.alpha * s.alpha, 1.0);
    let tangent2 = shape_projected_area(i, s.position) * INV_PI / max(dot(offset, offset), 1e-30);
    let root = sqrt(1.0 + tangent2);
    let light_fall = tangent2 / (root * (root + 1.0));
    let lobe = cap_angle(lobe_fall);
    let light = cap_angle(light_fall);
    let apart = angle_of(length(cross(mirror, c)), dot(mirror, c));
    let difference = abs(lobe - light);
    let sharing = 2.0 * PI * min(lobe_fall, light_fall) * (1.0 - smoothstep(0.0, 1.0, (apart - difference) / max(lobe + light - difference, 1e-12)));
    // Along the arc between both middles.
    let middle = 0.5 * (max(-lobe, apart - light) + min(lobe, apart + light));
    let aside = unit_or(c - mirror * dot(mirror, c), vec3f(0.0));
    let l = unit_or(mirror * cos(middle) + aside * sin(middle), mirror);
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 || sharing <= 0.0 {
        return vec3f(0.0);
    }
    // A surface mirrors no more than the light has.
    return shape_luminance(i, s.position, s.normal, mirror, s.alpha) * min(brdf(s, v, l) * (cosine * sharing), vec3f(1.0));
}
