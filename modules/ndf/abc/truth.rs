//! The distribution itself, normalised: the shader computes it in another form.

use std::f64::consts::PI;

use crate::oracles::lobes::multiplicity;
use crate::oracles::reflection::angle;
use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("distribution", distribution), ("facet_pdf", facet_pdf)];

/// Löw et al. 2012, with A such that the integral of D n.h is 1.
fn distribution(at: &At) -> Vec<f64> {
    let (alpha, c) = (at.number("s.alpha"), at.param("c"));
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let b = 2.0 / (alpha * alpha);
    // With w = 1 + b (1 - cos): 1 / A = 2 pi / b^2 times the integral of (1 + b - w) w^-c over w from 1 to 1 + b.
    let integral = (1.0 + b) * power_integral(-c, 1.0 + b) - power_integral(1.0 - c, 1.0 + b);
    vec![falloff(b, c, angle(n, h)) * b * b / (2.0 * PI * integral)]
}

/// By the distribution without the cosine, over its own integral, turned toward the viewer.
fn facet_pdf(at: &At) -> Vec<f64> {
    let (alpha, c) = (at.number("s.alpha"), at.param("c"));
    let (n, h) = (at.vector("s.normal"), at.vector("h"));
    if n.dot(h) <= 0.0 {
        return vec![0.0];
    }
    let b = 2.0 / (alpha * alpha);
    vec![falloff(b, c, angle(n, h)) * b / (2.0 * PI * power_integral(-c, 1.0 + b)) * multiplicity(at)]
}

/// (1 + B (1 - cos))^-C.
fn falloff(b: f64, c: f64, theta: f64) -> f64 {
    let one_minus_cos = 2.0 * (0.5 * theta).sin().powi(2);
    (1.0 + b * one_minus_cos).powf(-c)
}

/// Integral of x^n over x from 1 to `end`.
fn power_integral(n: f64, end: f64) -> f64 {
    let p = n + 1.0;
    if p.abs() < 1e-14 { end.ln() } else { (p * end.ln()).exp_m1() / p }
}
