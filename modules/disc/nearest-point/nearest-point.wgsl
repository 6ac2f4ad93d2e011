/// All of the disc's light comes from its point nearest to the mirrored view. The cosine stays that of the centre, so that the
/// illuminance does too.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    let mirrored = 2.0 * dot(s.normal, v) * s.normal - v;
    let along = dot(mirrored, l);
    // The part of the mirrored view across l; its length is the sine of the angle between them, without the loss of a cosine near 1.
    let across = mirrored - along * l;
    let sine = length(across);
    // By Taylor: a radius is below pi / 4, where the next terms are 3e-7 and 4e-6.
    let square = radius * radius;
    let rim = radius * (1.0 + square * (-0.16666667 + square * (8.3333333e-3 - square * 1.9841270e-4)));
    let inside = along > 0.0 && sine <= rim;
    let toward = l * sqrt(max(1.0 - rim * rim, 0.0)) + across * (rim / max(sine, 1e-12));
    return brdf(s, v, select(toward, mirrored, inside)) * cosine;
}
