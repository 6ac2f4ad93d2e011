//! The windowed inverse square with a sum in the denominator.

use crate::oracles::lights::window as window_to;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("falloff", window)];

/// Karis 2013, eq. 9, in metres: what is added to the squared distance is the squared size.
fn window(at: &At) -> Vec<f64> {
    let (distance, size) = (at.number("distance"), at.number("size"));
    vec![window_to(distance, at.number("range")) / (distance.powi(2) + size.powi(2))]
}
