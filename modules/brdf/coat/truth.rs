//! A coat over the module that its slot has where nothing is chosen.

use glam::DVec3;

use crate::oracles::appearance::normal_reflectance;
use crate::oracles::reflection::{Surface, angle, microfacet, schlick};
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("brdf", brdf)];

/// Walter et al. 2007, eq. 20, for the coat; below it the same with a Lambertian part, weakened by what the coat reflects of the direction of which
/// it reflects more, and by what it absorbs along the refracted ways (Snell's law).
fn brdf(at: &At) -> Vec<f64> {
    let (v, l) = (at.vector("v"), at.vector("l"));
    let (normal, coat_normal) = (at.vector("s.normal"), at.vector("s.coat_normal"));
    let (diffuse, f0) = (at.vector("s.diffuse"), at.vector("s.f0"));
    let (weight, ior) = (at.number("s.coat"), at.number("s.coat_ior"));
    let coat = Surface {
        normal: coat_normal,
        diffuse: 0.0,
        f0: normal_reflectance(ior),
        alpha: at.number("s.coat_alpha"),
    };
    let seen = |d: DVec3| schlick(coat.f0, angle(coat_normal, d).cos().max(0.0));
    let through = 1.0 - weight * seen(v).max(seen(l));
    // The module keeps cosines above 1e-3 within the coat: only a coat of index 1 has smaller ones.
    let way = |d: DVec3| 1.0 / (1.0 - (angle(coat_normal, d).sin() / ior).powi(2)).max(1e-6).sqrt();
    let ways = (way(v) + way(l)) / 2.0;
    let lit = if normal.dot(l) > 0.0 {
        weight * microfacet(&coat, v, l) * angle(coat_normal, l).cos() / angle(normal, l).cos()
    } else {
        0.0
    };
    let channel = |i: usize| {
        let below = Surface {
            normal,
            diffuse: diffuse[i],
            f0: f0[i],
            alpha: at.number("s.alpha"),
        };
        let passed = at.vector("s.coat_color")[i].max(1e-6).powf(ways);
        lit + microfacet(&below, v, l) * through * (1.0 - weight + weight * passed)
    };
    (0..3).map(channel).collect()
}
