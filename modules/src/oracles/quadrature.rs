//! Integrals over the hemisphere, by Gauss-Legendre quadrature in panels.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

/// Abscissae and weights of the 8-point Gauss-Legendre rule on [-1, 1] (Abramowitz and Stegun 1964, table 25.4).
const GAUSS: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

/// Nodes and weights of a rule with `panels` panels on [a, b].
pub fn nodes(a: f64, b: f64, panels: usize) -> Vec<(f64, f64)> {
    let half = (b - a) / (2 * panels) as f64;
    let panel = |i: usize| {
        let middle = a + half * (2 * i + 1) as f64;
        GAUSS
            .iter()
            .flat_map(move |&(x, w)| [(middle - half * x, half * w), (middle + half * x, half * w)])
    };
    (0..panels).flat_map(panel).collect()
}

/// Directions on the hemisphere around z with the solid angle each stands for, for integrands that are
/// even in y: phi runs over half a turn, counted twice.
pub fn hemisphere(theta_panels: usize, phi_panels: usize) -> Vec<(DVec3, f64)> {
    let mut directions = Vec::new();
    for (theta, wt) in nodes(0.0, FRAC_PI_2, theta_panels) {
        for (phi, wp) in nodes(0.0, PI, phi_panels) {
            directions.push((direction(theta, phi), 2.0 * wt * wp * theta.sin()));
        }
    }
    directions
}

/// Unit vector at the angle `theta` from z and `phi` from the plane of x and z, radians.
pub fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}
