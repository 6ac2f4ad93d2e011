/// The mean over the disc, in `strata` x `strata` parts of equal size, each by its middle. A uniform disc of radiance L gives a surface perpendicular
/// to its centre L pi sin^2(radius), and seen along that axis it is a flat disc, so every part of the flat one weighs as much over its own cosine.
fn disc(s: Surface, v: vec3f, l: vec3f, radius: f32) -> vec3f {
    let square = radius * radius;
    let rim = radius * (1.0 + square * (-0.16666667 + square * (8.3333333e-3 - square * 1.9841270e-4)));
    let frame = frame_of(l);
    var sum = vec3f(0.0);
    for (var i = 0u; i < params.strata; i++) {
        // Rings of equal area.
        let r = rim * sqrt((f32(i) + 0.5) / f32(params.strata));
        let height = sqrt(max(1.0 - r * r, 0.0));
        // A sum of its own for each ring: one long sum in f32 would drift.
        var ring = vec3f(0.0);
        for (var k = 0u; k < params.strata; k++) {
            // Neighbouring rings are turned against each other, by the golden section.
            let turn = PI * (2.0 * fract((f32(k) + 0.5) / f32(params.strata) + 0.61803399 * f32(i)) - 1.0);
            let at = frame * vec3f(r * cos(turn), r * sin(turn), height);
            let cosine = dot(s.normal, at);
            if cosine > 0.0 {
                ring += brdf(s, v, at) * (cosine / height);
            }
        }
        sum += ring;
    }
    return sum / f32(params.strata * params.strata);
}
