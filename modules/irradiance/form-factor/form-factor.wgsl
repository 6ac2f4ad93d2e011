/// pi times luminance times form factor, lx: exact for a shape of one luminance.
fn irradiance(i: u32, s: Surface) -> vec3f {
    return shape_luminance(i, s.position, s.normal, s.normal, 0.5) * (PI * shape_configuration_factor(i, s.position, s.normal));
}
