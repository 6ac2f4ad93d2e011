/// Luminance times the area that the light shows, over the square of the distance of its middle, times the cosine, lx.
fn irradiance(i: u32, s: Surface) -> vec3f {
    let offset = shape_centre(i) - s.position;
    // Of a surface in the very middle there is no direction to it; 1e-15 m is below any distance in a scene.
    let square = max(dot(offset, offset), 1e-30);
    let cosine = max(dot(s.normal, offset), 0.0) * inverseSqrt(square);
    return shape_luminance(i, s.position, s.normal, s.normal, 0.5) * (cosine * shape_projected_area(i, s.position) / square);
}
