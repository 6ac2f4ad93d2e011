/// Fresnel's equations for unpolarised light, of the index that has the reflectance f0 along the normal, by channel.
fn fresnel(s: Surface, cosine: f32) -> vec3f {
    return dielectric_reflectance(s.f0, cosine);
}
