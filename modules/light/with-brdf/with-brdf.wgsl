/// Radiance toward v because of the lights in the slot, cd/m2. They call the BRDF of this module.
fn light(s: Surface, v: vec3f) -> vec3f {
    return each_light(s, v);
}
