//! GGX averaged over a disc, on white paper: alone, all that is reflected counts as highlight.

use std::f64::consts::PI;

use crate::oracles::lights::{directional_illuminance, disc_over_ggx};
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("disc", disc)];

/// The cosine law for the disc's centre, times what the disc does to the distribution.
fn disc(at: &At) -> Vec<f64> {
    let (n, v, l) = (at.vector("s.normal"), at.vector("v"), at.vector("l"));
    let h = v + l;
    let flat = (h.length() / 2.0).max(1e-2);
    // Of the disc's half vectors: half as wide in the plane of v and l, half over v.h across it.
    let size = (at.number("radius") / 2.0).max(1e-5);
    let turn = (l - v).try_normalize();
    let in_plane = turn.map_or(0.0, |turn| n.dot(turn));
    let across = turn.zip(h.try_normalize()).map_or(0.0, |(turn, h)| n.dot(h.cross(turn)));
    let offset = in_plane.hypot(across);
    let reach = if offset > 1e-10 {
        size * offset / in_plane.hypot(flat * across)
    } else {
        size / flat.sqrt()
    };
    let slope = if n.dot(h) > 1e-3 { angle(n, h).tan() } else { n.cross(h).length() / 1e-3 };
    let factor = disc_over_ggx(at.number("s.alpha"), slope, reach, size / flat.sqrt());
    vec![directional_illuminance(-l, 1.0, n) / PI * factor; 3]
}
