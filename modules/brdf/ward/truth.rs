//! Ward, in angles as in the paper.

use crate::oracles::lobes::{diffuse_and_lobe, lit, lobe_share, mixed, slope_density, slope_mirror_density};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf), ("brdf_pdf", brdf_pdf)];

/// Ward 1992, eq. 5a.
fn brdf(at: &At) -> Vec<f64> {
    let Some(lit) = lit(at) else {
        return vec![0.0; 3];
    };
    let root = (lit.theta_v.cos() * lit.theta_l.cos()).sqrt();
    diffuse_and_lobe(at, slope_density(at, at.vector("s.widths"), lit.v + lit.l) / (4.0 * root))
}

/// A half vector by the slopes' density, mirrored. Walter 2005, eq. 9.
fn brdf_pdf(at: &At) -> Vec<f64> {
    mixed(
        at,
        lobe_share(at, at.vector("s.f0")),
        slope_mirror_density(at, at.vector("s.widths")),
    )
}
