//! The integrals themselves, by quadrature with more nodes than the table has.

use crate::oracles::albedo::{Albedo, ggx, ggx_mean};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("facet_albedo", facet_albedo), ("facet_albedo_mean", facet_albedo_mean)];

const PANELS: usize = 6;
/// The mean averages the quadrature's errors too: 2 panels give it to 1e-5.
const MEAN_PANELS: usize = 2;

/// A, B and the lost share.
fn parts(albedo: Albedo) -> Vec<f64> {
    vec![albedo.scale(), albedo.grazing, albedo.lost]
}

fn facet_albedo(at: &At) -> Vec<f64> {
    parts(ggx(at.number("s.alpha"), at.number("cosine"), PANELS))
}

fn facet_albedo_mean(at: &At) -> Vec<f64> {
    parts(ggx_mean(at.number("s.alpha"), MEAN_PANELS))
}
