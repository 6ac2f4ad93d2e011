//! How much a surface reflects, by quadrature.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use shadewright_compiler::Module;
use shadewright_compiler::manifest::Node;
use shadewright_modules::oracles::quadrature::{direction, nodes};

use super::bench::{Bench, Rows, surface};
use super::{Proof, Property};
use crate::measure::MeasureError;

/// Reflectance along the normal: what the facets do not get, the diffuse part has.
const F0: [f64; 3] = [0.0, 0.5, 1.0];
const ALPHAS: [f64; 3] = [0.05, 0.3, 1.0];
/// Degrees of the eye to the normal; 88.854 has a cosine of 0.02.
const ANGLES: [f64; 6] = [0.0, 30.0, 60.0, 80.0, 88.854, 89.9];
/// Degrees of the eye's plane to the tangent, where the surface is brushed.
const TURNS: [f64; 3] = [0.0, 45.0, 90.0];
/// What a quadrature may be above 1.
pub const MOST: f64 = 1.001;

/// A white surface and an eye.
#[derive(Clone, Copy, Debug)]
pub struct White {
    /// Reflectance along the normal; the diffuse part has the rest.
    pub f0: f64,
    /// Alpha along the tangent and across.
    pub widths: [f64; 2],
    /// Degrees of the eye to the normal.
    pub polar: f64,
    /// Degrees of the eye's plane to the tangent.
    pub turn: f64,
}

impl White {
    fn eye(&self) -> DVec3 {
        direction(self.polar.to_radians(), self.turn.to_radians())
    }

    /// Directions l with what each stands for: solid angle times cosine.
    ///
    /// Lobes lie around the facet that mirrors the eye, so the variable is that facet: the logarithm of the tangent of its angle to the normal, and its
    /// turn. The Jacobian is 4 v.h; l is above the horizon up to a tangent that has a closed form.
    fn directions(&self, fineness: usize) -> Vec<(DVec3, f64)> {
        let eye = self.eye();
        let (sine, cosine) = self.polar.to_radians().sin_cos();
        let low = f64::ln(1e-4 * self.widths[1].min(0.02));
        // Around the plane across the eye's that limit changes fast at grazing angles.
        let steps = [1.0, 0.25, 0.0625, 0.015_625, 0.0];
        let breaks: Vec<f64> = steps
            .iter()
            .map(|s| FRAC_PI_2 * (1.0 - s))
            .chain(steps.iter().rev().skip(1).map(|s| FRAC_PI_2 * (1.0 + s)))
            .collect();
        // What is not brushed is even in the turn.
        let is_even = self.widths[0] == self.widths[1];
        let mut found = Vec::new();
        for ends in breaks.windows(2) {
            for (turn, of_turn) in nodes(ends[0], ends[1], fineness) {
                let toward = sine * turn.cos();
                let high = f64::ln((toward + (toward * toward + cosine * cosine).sqrt()) / cosine);
                for (x, of_x) in nodes(low, high, fineness * (high - low).ceil().max(1.0) as usize) {
                    let tangent = x.exp();
                    let solid = of_turn * of_x * tangent * tangent / (1.0 + tangent * tangent).powf(1.5);
                    for side in [1.0, -1.0] {
                        let h = direction(tangent.atan(), self.turn.to_radians() + side * turn);
                        let l = 2.0 * eye.dot(h) * h - eye;
                        let weight = 4.0 * eye.dot(h) * solid * l.z.max(0.0);
                        found.push((l, if is_even { 2.0 * weight } else { weight }));
                        if is_even {
                            break;
                        }
                    }
                }
            }
        }
        found
    }

    /// The largest channel's albedo by a recipe's function of `s`, `v`, `l`, with so many panels of eight nodes for a part of the integral.
    ///
    /// # Errors
    /// The recipe cannot be linked, or the device fails.
    pub fn albedo(&self, bench: &Bench, node: &Node, function: &str, fineness: usize) -> Result<f64, MeasureError> {
        let directions = self.directions(fineness);
        let eye = self.eye();
        let rows = Rows::new(&surface(self.widths[0], self.widths, [self.f0; 3], [1.0 - self.f0; 3]))
            .sharing("v", serde_json::json!(eye.to_array()))
            .vectors("l", directions.iter().map(|(l, _)| *l));
        let values = bench.values(node, function, &rows)?;
        let sum = |channel: usize| -> f64 {
            let share = |((_, weight), value): (&(DVec3, f64), &Vec<f64>)| weight * value.get(channel).copied().unwrap_or(f64::NAN);
            directions.iter().zip(&values).map(share).sum()
        };
        // A channel that is NaN is the largest.
        Ok((0..3).map(sum).fold(0.0, |most, x| if x >= most || x.is_nan() { x } else { most }))
    }
}

/// Largest albedo of white surfaces, and where; with how much twice as many nodes in each direction change it.
///
/// # Errors
/// The module cannot be linked, or the device fails.
pub fn prove(bench: &Bench, module: &Module, function: &str) -> Result<Vec<Proof>, MeasureError> {
    let node = Node::new(format!("{}/{}", module.category, module.name));
    let is_isotropic = module.manifest.properties.iter().any(|p| p == Property::Isotropic.claim());
    let mut settings = Vec::new();
    for (f0, alpha) in F0.into_iter().flat_map(|f0| ALPHAS.map(|alpha| (f0, alpha))) {
        for polar in ANGLES {
            settings.push(White {
                f0,
                widths: [alpha; 2],
                polar,
                turn: 0.0,
            });
            let brushed = |turn| White {
                f0,
                widths: [alpha, 0.5 * alpha],
                polar,
                turn,
            };
            if !is_isotropic {
                settings.extend(TURNS.map(brushed));
            }
        }
    }
    let mut worst = (f64::NEG_INFINITY, settings[0]);
    for setting in settings {
        let albedo = setting.albedo(bench, &node, function, 1)?;
        if albedo > worst.0 || albedo.is_nan() {
            worst = (albedo, setting);
        }
    }
    let (coarse, setting) = worst;
    let fine = setting.albedo(bench, &node, function, 2)?;
    let brushed = if setting.widths[0] == setting.widths[1] {
        String::new()
    } else {
        format!(", {} across, turned by {}°", setting.widths[1], setting.turn)
    };
    let at = format!(
        "f0 {}, alpha {}{brushed}, v {}°; ± {:.0e}",
        setting.f0,
        setting.widths[0],
        setting.polar,
        (fine - coarse).abs()
    );
    Ok(vec![Proof::new(module, Property::Energy, fine, at, MOST)])
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Catches a Jacobian or a limit that is wrong: the cosine's integral over the hemisphere is pi, for any eye.
    #[test]
    fn the_nodes_cover_the_hemisphere() {
        for polar in ANGLES {
            for widths in [[0.05, 0.05], [1.0, 0.5]] {
                let setting = White {
                    f0: 1.0,
                    widths,
                    polar,
                    turn: 45.0,
                };
                let sum: f64 = setting.directions(1).iter().map(|(_, weight)| weight).sum();
                assert!((sum / PI - 1.0).abs() < 2e-4, "{polar} {widths:?}: {}", sum / PI);
                assert!(setting.directions(1).iter().all(|(l, _)| (l.length() - 1.0).abs() < 1e-12));
            }
        }
    }
}
