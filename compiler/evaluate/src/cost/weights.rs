//! What operations cost relative to each other.

use crate::kind::{Counts, Kind};

/// The weight of one operation of a kind, in additions, by the rates at which GPUs take them.
///
/// - Reciprocal, inverse root, logarithm, power of two, sine: 32 a clock where 128 lanes add or multiply (NVIDIA, CUDA C++ Programming Guide,
///   table "Throughput of Native Arithmetic Instructions", compute capability 5.x), so 4; a division takes 4 clocks on PowerVR as well
///   (Imagination, Compute Recommendations, "Example Device"). From capability 8 on it is 16 of 128.
/// - A transcendental function is taken for two of these: `pow` is a logarithm and a power of two, the argument of `sin` is reduced first, the
///   inverse ones are polynomials.
/// - Texture: 160 units for 2560 lanes (Radeon RX 5700 XT), so 16. Other GPUs have half of that.
pub fn weight(kind: Kind) -> f64 {
    match kind {
        Kind::Add | Kind::Multiply | Kind::Select | Kind::Integer | Kind::Branch | Kind::Trip => 1.0,
        Kind::Divide | Kind::Root => 4.0,
        Kind::Transcendental => 8.0,
        Kind::Texture => 16.0,
    }
}

impl Counts {
    /// The sum of all operations with the weights of their kinds: about the clocks of one lane, if nothing waits for memory.
    pub fn weighted(&self) -> f64 {
        Kind::ALL.into_iter().map(|kind| self[kind] as f64 * weight(kind)).sum()
    }
}
