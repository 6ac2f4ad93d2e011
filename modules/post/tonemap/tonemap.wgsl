/// The exposed colour on the tone curve.
fn post(color: vec3f, at: vec2u) -> vec3f {
    return tone_curve(color * exposure());
}
