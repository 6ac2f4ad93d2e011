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

/// The integral of luminance times glossy part times cosine over the light, cd/m2.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var row = 0u; row < params.strata; row++) {
        for (var column = 0u; column < params.strata; column++) {
            let u = (vec2f(f32(column), f32(row)) + 0.5) / f32(params.strata);
            sum += weighed(i, s, v, shape_sample(i, s.position, u)) + weighed(i, s, v, brdf_sample(s, v, u));
        }
    }
    return sum / f32(params.strata * params.strata);
}
