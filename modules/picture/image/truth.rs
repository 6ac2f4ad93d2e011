//! The mean of the sample over a Gaussian, by the definition: the picture between its texels, in double precision.

use crate::oracles::{At, Truth};

pub(super) const TRUTHS: &[(&str, Truth)] = &[("picture", picture), ("picture_mean", picture_mean)];

/// Texels of `sample.png` along a side.
const SIDE: usize = 16;
/// Steps across a Gaussian, up to six deviations to either side.
const STEPS: usize = 600;

/// What `sample.png` says, as light (IEC 61966-2-1).
fn texel(x: usize, y: usize) -> [f64; 3] {
    let blue = if (x / 4 + y / 4).is_multiple_of(2) { 255 } else { 40 };
    [17 * x, 17 * y, blue].map(|code| {
        let c = code as f64 / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    })
}

/// Shares of the texels of a row in a Gaussian.
fn shares(at: f64, deviation: f64) -> [f64; SIDE] {
    let mut shares = [0.0; SIDE];
    let mut sum = 0.0;
    for step in 0..STEPS {
        let t = 12.0 * ((step as f64 + 0.5) / STEPS as f64 - 0.5);
        let weight = (-0.5 * t * t).exp();
        let place = ((at + deviation * t) * SIDE as f64 - 0.5).clamp(0.0, (SIDE - 1) as f64);
        let low = (place.floor() as usize).min(SIDE - 2);
        let part = place - low as f64;
        shares[low] += weight * (1.0 - part);
        shares[low + 1] += weight * part;
        sum += weight;
    }
    shares.map(|share| share / sum)
}

fn weighed(columns: [f64; SIDE], rows: [f64; SIDE]) -> Vec<f64> {
    let mut sum = [0.0; 3];
    for (y, row) in rows.iter().enumerate() {
        for (x, column) in columns.iter().enumerate() {
            for (sum, channel) in sum.iter_mut().zip(texel(x, y)) {
                *sum += row * column * channel;
            }
        }
    }
    sum.to_vec()
}

fn picture(at: &At) -> Vec<f64> {
    let (place, deviation) = (at.vector("at"), at.vector("deviation"));
    weighed(shares(place.x, deviation.x), shares(place.y, deviation.y))
}

fn picture_mean(_: &At) -> Vec<f64> {
    weighed([1.0 / SIDE as f64; SIDE], [1.0 / SIDE as f64; SIDE])
}
