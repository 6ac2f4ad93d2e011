/// The comparison at the receiver itself.
fn filter_shadow(at: Receiver) -> f32 {
    return shadow_compare(at, vec2f(0.0));
}
