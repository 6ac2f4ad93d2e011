/// What all lights of the slot make of the surface with the BRDF of the slot.
fn lit(s: Surface, v: vec3f) -> vec3f {
    return light(s, v);
}
