//! A tent over the interface's edge, which lights everything left of its place.

use crate::oracles::shadows::tent_filter;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("filter_shadow", filter_shadow)];

/// Reeves, Salesin and Cook 1987, with weights that fall linearly to 0 one texel beyond the radius.
fn filter_shadow(at: &At) -> Vec<f64> {
    let edge = at.vector("at.place").x;
    // The radius is a small whole number of texels.
    let radius = at.param("radius") as i32;
    vec![tent_filter(radius, |x, _| f64::from(x) < edge)]
}
