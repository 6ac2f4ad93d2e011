/// G2 / (4 n.l n.v) taken for 1 / (4 (l.h)^2) = 1 / |v + l|^2. Kelemen and Szirmay-Kalos 2001.
///
/// For v opposite to l, l.h has no digits in f32, while the sum v + l is exact. Its square below 1e-14 is the rounding of unit vectors.
fn masking(s: Surface, v: vec3f, l: vec3f, h: vec3f) -> f32 {
    let sum = v + l;
    return select(0.0, 1.0 / max(dot(sum, sum), 1e-14), above_horizon(s.normal, v, l));
}
