/// Nothing: the light is not mirrored.
fn highlight(i: u32, s: Surface, v: vec3f) -> vec3f {
    return vec3f(0.0);
}
