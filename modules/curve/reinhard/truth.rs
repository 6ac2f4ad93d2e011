//! The extended operator on luminance.

use crate::oracles::display::reinhard_color;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("tone_curve", tone_curve)];

/// Reinhard et al. 2002, eq. 4, with the colour scaled as its luminance.
fn tone_curve(at: &At) -> Vec<f64> {
    reinhard_color(at.vector("c"), at.param("white")).to_array().to_vec()
}
