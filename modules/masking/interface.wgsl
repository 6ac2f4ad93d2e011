/// G2(l, v, h) / (4 n.l n.v), for l and v on the side of the normal, 1/sr-free.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    return 0.0;
}
