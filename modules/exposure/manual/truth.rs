//! Exposure of a camera that is set by hand.

use crate::oracles::display::saturation_luminance;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("exposure", exposure)];

/// The reciprocal of the luminance that saturates the sensor, m2/cd.
fn exposure(at: &At) -> Vec<f64> {
    vec![1.0 / saturation_luminance(at.param("ev100"))]
}
