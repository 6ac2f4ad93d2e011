/// The mean of luminance times cosine over density, lx.
fn irradiance(i: u32, s: Surface) -> vec3f {
    var sum = vec3f(0.0);
    for (var row = 0u; row < params.strata; row++) {
        for (var column = 0u; column < params.strata; column++) {
            let u = (vec2f(f32(column), f32(row)) + 0.5) / f32(params.strata);
            let l = shape_sample(i, s.position, u);
            let density = shape_pdf(i, s.position, l);
            let cosine = dot(s.normal, l);
            // Where rounding has put a sample beside the shape there is no density.
            if cosine > 0.0 && density > 0.0 {
                sum += shape_radiance(i, s.position, l) * (cosine / density);
            }
        }
    }
    return sum / f32(params.strata * params.strata);
}
