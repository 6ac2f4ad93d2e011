//! What the modules approximate: the integral over the disc. Alone, a disc falls on a white Lambertian surface.

use std::f64::consts::PI;

use crate::oracles::lights::disc_cosine;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("disc", disc)];

/// The cosine law over the disc, its part below the horizon left out.
fn disc(at: &At) -> Vec<f64> {
    vec![disc_cosine(at.vector("s.normal"), at.vector("l"), at.number("radius")) / PI; 3]
}
