/// G2 = n.l n.v, which leaves V = 1/4 above the horizon.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    return select(0.0, 0.25, above_horizon(s.normal, v, l));
}
