/// A number with all its bits mixed. O'Neill 2014, PCG, the output permutation RXS-M-XS.
fn mixed(seed: u32) -> u32 {
    let state = seed * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// Where in its cell the sample is, in [0, 1).
fn within(cell: u32, kind: u32) -> f32 {
    if params.seed == 0u {
        return 0.5;
    }
    return f32(mixed(mixed(mixed(params.seed) + cell) + kind) >> 8u) * 5.9604644775390625e-8;
}

/// What a direction drawn in either way gives: its share of the integral over the sum of both densities.
fn weighed(i: u32, s: Surface, v: vec3f, l: vec3f) -> vec3f {
    let cosine = dot(s.normal, l);
    let of_light = shape_pdf(i, s.position, l);
    // What never is drawn toward the light does not meet it.
    if cosine <= 0.0 || of_light <= 0.0 {
        return vec3f(0.0);
    }
    return shape_radiance(i, s.position, l) * brdf(s, v, l) * (cosine / (of_light + brdf_pdf(s, v, l)));
}

/// The integral of luminance times BRDF times cosine over the light, cd/m2.
fn illuminate(i: u32, s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var row = 0u; row < params.strata; row++) {
        for (var column = 0u; column < params.strata; column++) {
            let cell = 4u * (row * params.strata + column);
            let corner = vec2f(f32(column), f32(row));
            let u = (corner + vec2f(within(cell, 0u), within(cell, 1u))) / f32(params.strata);
            sum += weighed(i, s, v, shape_sample(i, s.position, u));
            let w = (corner + vec2f(within(cell, 2u), within(cell, 3u))) / f32(params.strata);
            sum += weighed(i, s, v, brdf_sample(s, v, w));
        }
    }
    return sum / f32(params.strata * params.strata);
}
