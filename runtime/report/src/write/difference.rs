//! How far a picture is from another one of the same scene.

use super::number::{count, number};

/// An error of this share has the full colour, where nothing else is said.
pub const FULL: f64 = 0.5;
/// Where a picture has no number.
const BROKEN: [u8; 4] = [255, 0, 255, 255];
/// Luminance of linear Rec.709 (ITU-R BT.709, 3.2).
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// Errors of the luminance, each as a share of the true luminance there plus the true picture's mean: so an error in a shadow counts as much as one
/// of the same height in mean light, and one in a highlight by the share of the highlight.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// sRGB-encoded RGBA: black without an error, red where it is too bright, blue where it is too dark, full at a half.
    pub pixels: Vec<u8>,
    /// Root of the mean square.
    pub rms: f64,
    /// The largest, either way.
    pub largest: f64,
    /// Pixels in which either picture has no finite number. They do not count in the others.
    pub broken: usize,
}

impl Difference {
    /// Of the [`errors`] of a picture, with the full colour at this one.
    pub fn of(errors: &[f64], full: f64) -> Self {
        let finite = || errors.iter().filter(|error| error.is_finite());
        let squares = finite().map(|error| error.powi(2)).sum::<f64>();
        let count = finite().count();
        Self {
            pixels: errors.iter().flat_map(|error| colour(*error, full)).collect(),
            rms: (squares / count.max(1) as f64).sqrt(),
            largest: finite().map(|error| error.abs()).fold(0.0, f64::max),
            broken: errors.len() - count,
        }
    }

    /// The numbers in words: `RMS 1.2 %, largest 30 %`.
    pub fn summary(&self) -> String {
        let mut text = format!("RMS {} %, largest {} %", number(100.0 * self.rms), number(100.0 * self.largest));
        if self.broken > 0 {
            text += &format!(", {} not finite", count(self.broken, "pixel"));
        }
        text
    }
}

/// Compares two linear pictures of one size.
pub fn difference(found: &[[f32; 4]], truth: &[[f32; 4]]) -> Difference {
    Difference::of(&errors(found, truth), FULL)
}

/// Luminance of linear Rec.709, in the unit of its channels.
pub fn luminance(texel: &[f32; 4]) -> f64 {
    (0..3).map(|c| LUMINANCE[c] * f64::from(texel[c])).sum()
}

/// The error of each pixel, on [`Difference`]'s scale: above 0 where `found` is too bright. NaN where either picture has no finite number.
pub fn errors(found: &[[f32; 4]], truth: &[[f32; 4]]) -> Vec<f64> {
    let pairs: Vec<[f64; 2]> = found.iter().zip(truth).map(|(a, b)| [luminance(a), luminance(b)]).collect();
    let is_finite = |[a, b]: &[f64; 2]| a.is_finite() && b.is_finite();
    let finite = || pairs.iter().filter(|pair| is_finite(pair));
    let count = finite().count().max(1) as f64;
    let mean = finite().map(|[_, b]| b).sum::<f64>() / count;
    // A picture that is black everywhere has no scale of its own: errors are in its unit then.
    let scale = if mean > 0.0 { mean } else { 1.0 };
    let error = |[a, b]: &[f64; 2]| (a - b) / (b.max(0.0) + scale);
    pairs
        .iter()
        .map(|pair| if is_finite(pair) { error(pair) } else { f64::NAN })
        .collect()
}

/// The colour of an error, sRGB-encoded RGBA: full where it is `full` or more, either way.
pub fn colour(error: f64, full: f64) -> [u8; 4] {
    if !error.is_finite() {
        return BROKEN;
    }
    let height = (255.0 * (error.abs() / full).min(1.0)).round() as u8;
    let pale = height / 3;
    if error > 0.0 {
        [height, pale, pale, 255]
    } else {
        [pale, pale, height, 255]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a sign that is turned round, a channel that counts as another, a scale that a shadow blows up, and a NaN that gets into the numbers.
    #[test]
    fn errors_have_a_sign_and_a_scale() {
        let grey = |x: f32| [x, x, x, 1.0];
        let truth = [grey(1.0), grey(3.0), grey(0.0), grey(4.0), grey(0.0)];
        let found = [grey(1.0), [3.0 + 2.5 / 0.7152, 3.0, 3.0, 1.0], grey(1.0), grey(1.0), grey(f32::NAN)];
        let all = difference(&found, &truth);
        // The mean is that of the four: 2.
        let red = 0.2126 * 2.5 / 0.7152 / 5.0;
        let errors = [0.0, red, 0.5, -0.5];
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / 4.0).sqrt();
        assert!((all.rms - rms).abs() < 1e-7, "{}", all.rms);
        assert!((all.largest - 0.5).abs() < 1e-12 && all.broken == 1);
        let height = (255.0 * red / 0.5).round() as u8;
        let expected = [
            [0, 0, 0, 255],
            [height, height / 3, height / 3, 255],
            [255, 85, 85, 255],
            [85, 85, 255, 255],
            BROKEN,
        ];
        assert_eq!(all.pixels, expected.concat());
        assert_eq!(all.summary(), "RMS 36.1 %, largest 50.0 %, 1 pixel not finite");
    }

    /// Catches a division by a mean of 0.
    #[test]
    fn black_pictures_agree() {
        let black = [[0.0_f32, 0.0, 0.0, 1.0]; 2];
        let none = difference(&black, &black);
        assert_eq!((none.rms, none.largest, none.broken), (0.0, 0.0, 0));
        assert_eq!(none.pixels, [[0, 0, 0, 255]; 2].concat());
    }
}
