/// The whole light as a point in its middle: what it sends there is its luminance times the area that it shows, cd.
fn illuminate(i: u32, s: Surface, v: vec3f) -> vec3f {
    let offset = shape_centre(i) - s.position;
    // Of a surface in the very middle there is no direction to it; 1e-15 m is below any distance in a scene.
    let square = max(dot(offset, offset), 1e-30);
    let l = offset * inverseSqrt(square);
    let cosine = dot(s.normal, l);
    if cosine <= 0.0 {
        return vec3f(0.0);
    }
    return shape_luminance(i, s.position, s.normal, s.normal, 0.5) * brdf(s, v, l) * (cosine * shape_projected_area(i, s.position) / square);
}
