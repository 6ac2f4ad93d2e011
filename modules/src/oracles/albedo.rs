//! Directional albedo of GGX facets under Smith's correlated masking.
//!
//! Only additions, multiplications, divisions and roots: equal bits on every machine, so that tables can be compared byte by byte.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use super::quadrature::nodes;

/// What facets do with light from a direction, if they reflect all or a share (1 - v.h)^5 of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Albedo {
    /// Share that no facet sends out at once: 1 minus the albedo with F = 1.
    pub lost: f64,
    /// Albedo with F = (1 - v.h)^5, B of F0 A + B.
    pub grazing: f64,
}

impl Albedo {
    /// A of the albedo F0 A + B under Schlick's Fresnel term.
    pub fn scale(&self) -> f64 {
        1.0 - self.lost - self.grazing
    }
}

/// Cells in which the horizon is looked for along a meridian of the cap.
const CELLS: usize = 48;

/// A direction v and the width of the facets' slopes.
struct View {
    alpha: f64,
    cosine: f64,
    sine: f64,
    /// v stretched by alpha, unit length: x and z.
    cap: (f64, f64),
}

impl View {
    fn new(alpha: f64, cosine: f64) -> Self {
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (x, z) = (alpha * sine, cosine);
        let length = (x * x + z * z).sqrt();
        Self {
            alpha,
            cosine,
            sine,
            cap: (x / length, z / length),
        }
    }

    /// v.h and n.l of the facet at a height of the cap, on the meridian with this cosine and sine. Dupuy and Benyoub 2023, listing 3.
    fn facet(&self, z: f64, (cosine, sine): (f64, f64)) -> (f64, f64) {
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let x = self.alpha * (radius * cosine + self.cap.0);
        let y = self.alpha * radius * sine;
        let up = (z + self.cap.1).max(0.0);
        let length = (x * x + y * y + up * up).sqrt();
        if length == 0.0 {
            return (0.0, -self.cosine);
        }
        let v_dot_h = (self.sine * x + self.cosine * up) / length;
        (v_dot_h, 2.0 * v_dot_h * up / length - self.cosine)
    }

    /// 1 + 2 Lambda, Heitz 2014, eq. 72.
    fn shadow(&self, cosine: f64) -> f64 {
        (1.0 + self.alpha * self.alpha * (1.0 - cosine * cosine) / (cosine * cosine)).sqrt()
    }

    /// Heights between which light leaves above the horizon, on a meridian.
    fn open(&self, meridian: (f64, f64)) -> Vec<(f64, f64)> {
        let (low, high) = (-self.cap.1, 1.0);
        let above = |z: f64| self.facet(z, meridian).1 > 0.0;
        let place = |i: usize| {
            let t = i as f64 / CELLS as f64;
            low + (high - low) * t * t * t
        };
        let mut found = Vec::new();
        let mut start = above(low).then_some(low);
        for i in 0..CELLS {
            let (mut a, mut b) = (place(i), place(i + 1));
            let before = above(a);
            if before == above(b) {
                continue;
            }
            for _ in 0..48 {
                let middle = 0.5 * (a + b);
                if above(middle) == before {
                    a = middle;
                } else {
                    b = middle;
                }
            }
            match start.take() {
                Some(from) => found.push((from, a)),
                None => start = Some(b),
            }
        }
        found.extend(start.map(|from| (from, high)));
        found
    }
}

/// The albedo for light along the direction with this cosine to the normal, by quadrature over the facets that v sees, with `panels` panels
/// of 8 nodes for a quarter turn and for each stretch of a meridian. 4 err by some 1e-5, 8 by 1e-6.
pub fn ggx(alpha: f64, cosine: f64, panels: usize) -> Albedo {
    // At 0 the limit is meant; at a millionth of alpha it is reached.
    let view = View::new(alpha, cosine.max(1e-6 * alpha));
    let toward_v = view.shadow(view.cosine);
    let meridians = nodes(0.0, 1.0, panels);
    let heights = nodes(0.0, 1.0, panels);
    let (mut white, mut grazing, mut turn) = (0.0, 0.0, 0.0);
    for &(t, weight) in &meridians {
        let square = t * t;
        let dphi = 2.0 * weight / (1.0 + square);
        for side in [1.0, -1.0] {
            let meridian = (side * (1.0 - square) / (1.0 + square), 2.0 * t / (1.0 + square));
            turn += dphi;
            for (from, to) in view.open(meridian) {
                for &(t, weight) in &heights {
                    // Nodes gather at both ends, where the integrand is a root.
                    let z = from + (to - from) * (t * t * t * (10.0 - 15.0 * t + 6.0 * t * t));
                    let dz = (to - from) * 30.0 * t * t * (1.0 - t) * (1.0 - t) * weight;
                    let (v_dot_h, n_dot_l) = view.facet(z, meridian);
                    if n_dot_l <= 0.0 {
                        continue;
                    }
                    let passed = (1.0 + toward_v) / (toward_v + view.shadow(n_dot_l)) * dz / (1.0 + view.cap.1) * dphi;
                    let x = (1.0 - v_dot_h).clamp(0.0, 1.0);
                    white += passed;
                    grazing += passed * (x * x * x * x * x);
                }
            }
        }
    }
    Albedo {
        lost: 1.0 - white / turn,
        grazing: grazing / turn,
    }
}

/// The mean over directions, weighted with the cosine: twice the integral of the albedo times the cosine.
///
/// What was asked for is remembered: a mean is a hundred integrals, and reports ask for few widths often.
pub fn ggx_mean(alpha: f64, panels: usize) -> Albedo {
    static KNOWN: Mutex<BTreeMap<(u64, usize), Albedo>> = Mutex::new(BTreeMap::new());
    let key = (alpha.to_bits(), panels);
    if let Some(known) = KNOWN.lock().unwrap_or_else(PoisonError::into_inner).get(&key) {
        return *known;
    }
    let made = integrate_mean(alpha, panels);
    KNOWN.lock().unwrap_or_else(PoisonError::into_inner).insert(key, made);
    made
}

fn integrate_mean(alpha: f64, panels: usize) -> Albedo {
    let (mut lost, mut grazing) = (0.0, 0.0);
    for (x, weight) in nodes(0.0, 1.0, 3 * panels) {
        // All decades of the cosine count, from alpha on.
        let cosine = x * x * x * x;
        let weight = 2.0 * cosine * 4.0 * x * x * x * weight;
        let at = ggx(alpha, cosine, panels);
        lost += weight * at.lost;
        grazing += weight * at.grazing;
    }
    Albedo { lost, grazing }
}
