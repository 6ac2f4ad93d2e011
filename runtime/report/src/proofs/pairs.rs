//! What is claimed of a function of two directions, over stratified and hard pairs of them.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DMat3, DVec3};
use shadewright_compiler::Module;
use shadewright_modules::oracles::quadrature::direction;

use super::bench::{Bench, Rows, surface, variants};
use super::{Proof, Property};
use crate::measure::MeasureError;

/// Stratified pairs of directions; the hard ones come on top.
pub const PAIRS: usize = 10_000;
/// The smallest alpha is the smallest that modules are for.
const ALPHAS: [f64; 6] = [1e-4, 1e-3, 0.01, 0.1, 0.5, 1.0];
/// Degrees to the normal, up to the horizon.
const ANGLES: [f64; 9] = [0.0, 0.01, 1.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.99];
/// On the horizon, below it, and along it.
const BEYOND: [f64; 8] = [0.0, 45.0, 89.0, 89.99, 90.0, 91.0, 135.0, 180.0];
/// Relative difference that claims of equality allow.
pub const EQUAL: f64 = 1e-5;
/// What is smaller is rounding of 0, in a relative difference.
const FLOOR: f64 = 1e-9;

/// A surface and two directions, numbers as a device gets them.
#[derive(Clone, Copy, Debug)]
struct Pair {
    alpha: f64,
    /// Columns tangent, bitangent and normal.
    frame: DMat3,
    v: DVec3,
    l: DVec3,
}

/// A stratified number for each step: multiples of an irrational fill the unit interval evenly.
pub(super) fn fraction(step: usize, by: f64) -> f64 {
    (step as f64 * by + 0.5).fract()
}

fn single(d: DVec3) -> DVec3 {
    d.as_vec3().as_dvec3()
}

/// Pairs above the surface: stratified, half of them mirrored about a facet of their surface, an eighth on tilted surfaces; then all combinations of hard
/// angles with all alphas, and of directions on and below the horizon.
fn pairs() -> Vec<Pair> {
    let upper = |step: usize, a: f64, b: f64| direction(f64::acos(1.0 - fraction(step, a)), TAU * fraction(step, b));
    let mut found = Vec::new();
    let mut add = |alpha: f64, frame: DMat3, v: DVec3, l: DVec3| {
        found.push(Pair {
            alpha,
            frame,
            v: single(frame * v),
            l: single(frame * l),
        });
    };
    for step in 0..PAIRS {
        let alpha = ALPHAS[step % ALPHAS.len()];
        let v = upper(step, 0.819_172_513, 0.671_043_607);
        let mut l = upper(step, 0.549_700_478, 0.450_299_522);
        if (step / ALPHAS.len()).is_multiple_of(2) {
            // Elsewhere the lobe of a smooth surface is 0.
            let slope = alpha * (-f64::ln(fraction(step, 0.324_717_957))).sqrt();
            let h = direction(slope.atan(), TAU * fraction(step, 0.450_299_522));
            let mirrored = 2.0 * v.dot(h) * h - v;
            if mirrored.z > 0.0 {
                l = mirrored;
            }
        }
        let frame = if step % 8 == 7 {
            let normal = single(direction(3.1 * fraction(step, 0.220_744_085), TAU * fraction(step, 0.245_122_334)));
            let (tangent, bitangent) = normal.any_orthonormal_pair();
            DMat3::from_cols(single(tangent), single(bitangent), normal)
        } else {
            DMat3::IDENTITY
        };
        add(alpha, frame, v, l);
    }
    for alpha in ALPHAS {
        for (angles, turns) in [(&ANGLES[..], &[0.0, 40.0, 180.0][..]), (&BEYOND[..], &[0.0, 180.0][..])] {
            for (v, l, turn) in angles
                .iter()
                .flat_map(|v| angles.iter().flat_map(move |l| turns.iter().map(move |t: &f64| (v, l, t))))
            {
                let v = direction(v.to_radians(), 0.0);
                add(alpha, DMat3::IDENTITY, v, direction(l.to_radians(), turn.to_radians()));
            }
        }
    }
    found
}

/// Some of the pairs, stratified and hard ones, and the same exchanged.
pub(super) fn some(count: usize) -> [Rows; 2] {
    let all = pairs();
    let step = all.len() / count.max(1);
    // An odd step meets all alphas.
    let some: Vec<Pair> = all.into_iter().step_by(step | 1).collect();
    let swapped: Vec<Pair> = some.iter().map(|p| Pair { v: p.l, l: p.v, ..*p }).collect();
    [rows(&some, false), rows(&swapped, false)]
}

fn rows(pairs: &[Pair], takes_half: bool) -> Rows {
    // Every other surface is brushed: who claims that it does not matter is held to that.
    let across = |(step, pair): (usize, &Pair)| if step % 2 == 0 { pair.alpha } else { (0.5 * pair.alpha).max(1e-4) };
    let rows = Rows::new(&surface(1.0, [1.0; 2], [0.04, 0.5, 1.0], [1.0, 0.5, 0.0]))
        .numbers("s.alpha", pairs.iter().map(|p| p.alpha))
        .numbers("s.coat_alpha", pairs.iter().map(|p| p.alpha))
        .numbers("s.diffuse_roughness", pairs.iter().map(|p| p.alpha.sqrt()))
        .numbers("s.fuzz_roughness", pairs.iter().map(|p| p.alpha.sqrt()))
        .numbers("s.widths.x", pairs.iter().map(|p| p.alpha))
        .numbers("s.widths.y", pairs.iter().enumerate().map(across))
        .vectors("s.normal", pairs.iter().map(|p| p.frame.z_axis))
        .vectors("s.coat_normal", pairs.iter().map(|p| p.frame.z_axis))
        .vectors("s.tangent", pairs.iter().map(|p| p.frame.x_axis))
        .vectors("v", pairs.iter().map(|p| p.v))
        .vectors("l", pairs.iter().map(|p| p.l));
    if takes_half {
        let half = |p: &Pair| single((p.v + p.l).try_normalize().unwrap_or(p.frame.z_axis));
        return rows.vectors("h", pairs.iter().map(half));
    }
    rows
}

/// What is the worst, and where.
struct Worst {
    value: f64,
    at: String,
}

/// Angles to the normal and between the planes, in degrees.
fn place(pair: &Pair, variant: &str) -> String {
    let local = |d: DVec3| pair.frame.transpose() * d;
    let (v, l) = (local(pair.v), local(pair.l));
    let polar = |d: DVec3| d.x.hypot(d.y).atan2(d.z).to_degrees();
    let turn = (l.y.atan2(l.x) - v.y.atan2(v.x)).rem_euclid(TAU).to_degrees();
    let tilted = if pair.frame == DMat3::IDENTITY { "" } else { ", tilted normal" };
    let variant = if variant.is_empty() {
        String::new()
    } else {
        format!(", {variant}")
    };
    format!(
        "alpha {}, v {:.2}°, l {:.2}°, {turn:.0}° apart{tilted}{variant}",
        pair.alpha,
        polar(v),
        polar(l)
    )
}

/// Largest relative difference of two tables' numbers.
fn differ(pairs: &[Pair], variant: &str, a: &[Vec<f64>], b: &[Vec<f64>], worst: &mut Worst) {
    for ((pair, a), b) in pairs.iter().zip(a).zip(b) {
        for (a, b) in a.iter().zip(b) {
            let error = (a - b).abs() / a.abs().max(b.abs()).max(FLOOR);
            if error > worst.value {
                *worst = Worst {
                    value: error,
                    at: place(pair, variant),
                };
            }
        }
    }
}

/// Reciprocity, isotropy, sign and finiteness of a function of `s`, `v`, `l` and, where it takes one, the `h` between them.
///
/// # Errors
/// The module cannot be linked, or the device fails.
pub fn prove(bench: &Bench, module: &Module, function: &str, takes_half: bool) -> Result<Vec<Proof>, MeasureError> {
    let pairs = pairs();
    // Rounding a turn of other directions would count as a difference.
    let upright: Vec<Pair> = pairs.iter().filter(|p| p.frame == DMat3::IDENTITY).copied().collect();
    let swapped: Vec<Pair> = pairs.iter().map(|p| Pair { v: p.l, l: p.v, ..*p }).collect();
    let quarter = |d: DVec3| DVec3::new(-d.y, d.x, d.z);
    let turned: Vec<Pair> = upright
        .iter()
        .map(|p| Pair {
            v: quarter(p.v),
            l: quarter(p.l),
            ..*p
        })
        .collect();
    let nothing = || Worst {
        value: 0.0,
        at: String::new(),
    };
    let (mut reciprocal, mut isotropic, mut infinite) = (nothing(), nothing(), nothing());
    let mut least = Worst {
        value: f64::INFINITY,
        at: String::new(),
    };
    for (variant, node) in variants(module) {
        let values = bench.values(&node, function, &rows(&pairs, takes_half))?;
        let other = bench.values(&node, function, &rows(&swapped, takes_half))?;
        differ(&pairs, &variant, &values, &other, &mut reciprocal);
        let values_upright = bench.values(&node, function, &rows(&upright, takes_half))?;
        let other = bench.values(&node, function, &rows(&turned, takes_half))?;
        differ(&upright, &variant, &values_upright, &other, &mut isotropic);
        for (pair, value) in pairs.iter().zip(&values) {
            for &x in value {
                if !x.is_finite() {
                    infinite.value += 1.0;
                    infinite.at = place(pair, &variant);
                } else if x < least.value {
                    least = Worst {
                        value: x,
                        at: place(pair, &variant),
                    };
                }
            }
        }
    }
    let proof = |property: Property, worst: Worst, bound: f64| Proof::new(module, property, worst.value, worst.at, bound);
    Ok(vec![
        proof(Property::Reciprocal, reciprocal, EQUAL),
        proof(Property::Isotropic, isotropic, EQUAL),
        proof(Property::NotNegative, least, 0.0),
        proof(Property::Finite, infinite, 0.0),
    ])
}

/// A share of the light, by its cosine: in [0, 1], and finite.
///
/// # Errors
/// As for [`prove`].
pub fn prove_share(bench: &Bench, module: &Module, function: &str) -> Result<Vec<Proof>, MeasureError> {
    // Both ends, what is near them, and what rounding puts beyond them.
    let mut cosines: Vec<f64> = (0..PAIRS).map(|step| f64::cos(FRAC_PI_2 * step as f64 / PAIRS as f64)).collect();
    cosines.extend([0.0, 1e-9, 1e-5, 1.0, 1.000_000_2, -1e-7, -0.5, -1.0]);
    let f0 = [0.0, 0.04, 0.5, 0.9, 1.0];
    let cases: Vec<(f64, f64)> = f0.iter().flat_map(|&f0| cosines.iter().map(move |&c| (f0, c))).collect();
    let mut least = (f64::INFINITY, String::new());
    let mut most = (f64::NEG_INFINITY, String::new());
    let mut infinite = (0.0, String::new());
    for (variant, node) in variants(module) {
        let rows = Rows::new(&surface(0.5, [0.5; 2], [0.0; 3], [0.5; 3]))
            .vectors("s.f0", cases.iter().map(|(f0, _)| DVec3::splat(*f0)))
            .numbers("cosine", cases.iter().map(|(_, cosine)| *cosine));
        for (&(f0, cosine), value) in cases.iter().zip(bench.values(&node, function, &rows)?) {
            let at = || {
                format!(
                    "f0 {f0}, cosine {cosine:.3e}{}{variant}",
                    if variant.is_empty() { "" } else { ", " }
                )
            };
            for x in value {
                if !x.is_finite() {
                    infinite = (infinite.0 + 1.0, at());
                } else {
                    if x < least.0 {
                        least = (x, at());
                    }
                    if x > most.0 {
                        most = (x, at());
                    }
                }
            }
        }
    }
    Ok(vec![
        Proof::new(module, Property::NotNegative, least.0, least.1, 0.0),
        Proof::new(module, Property::Finite, infinite.0, infinite.1, 0.0),
        // A unit in the last place of 1 is rounding.
        Proof::new(module, Property::Share, most.0, most.1, 1.0 + 1e-6),
    ])
}
