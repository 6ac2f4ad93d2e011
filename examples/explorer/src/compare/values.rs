//! Numbers of pictures: linear values of each pixel, and how far those of one picture are from another's.

use eframe::egui::{Color32, ColorImage};
use shadewright_report::write::{Difference, colour, errors, luminance};

/// A picture before it was made to be seen: cd/m² for red, green and blue, rows from the top.
#[derive(Clone, Debug)]
pub struct Values {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// As many as pixels.
    pub texels: Vec<[f32; 4]>,
}

/// What of a picture is too bright, and what too dark: see [`Difference`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// A share for each pixel, above 0 where it is too bright; NaN where there is no finite number.
    pub values: Vec<f64>,
    /// Root of the mean square, as a share.
    pub rms: f64,
    /// The largest, either way.
    pub largest: f64,
    /// In words.
    pub summary: String,
}

/// Number of the pixel at a place of a picture, a share of each side from its upper left corner.
fn index([width, height]: [u32; 2], [x, y]: [f32; 2]) -> Option<usize> {
    if !((0.0..1.0).contains(&x) && (0.0..1.0).contains(&y)) {
        return None;
    }
    let pixel = |share: f32, side: u32| ((share * side as f32) as u32).min(side.saturating_sub(1)) as usize;
    Some(pixel(y, height) * width as usize + pixel(x, width))
}

impl Values {
    /// The value at a place, a share of each side from the upper left corner.
    pub fn at(&self, place: [f32; 2]) -> Option<[f32; 4]> {
        self.texels.get(index(self.size, place)?).copied()
    }
}

/// A value in words.
pub fn describe(texel: &[f32; 4]) -> String {
    let [r, g, b, _] = texel.map(f64::from);
    format!(
        "{} {} {} cd/m², luminance {}",
        short(r),
        short(g),
        short(b),
        short(luminance(texel))
    )
}

/// Three digits that count.
pub fn short(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e6).contains(&size) {
        format!("{value:.2e}")
    } else {
        let digits = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.digits$}")
    }
}

impl Errors {
    /// Of a picture against a true one; none where their sizes differ.
    pub fn of(found: &Values, truth: &Values) -> Option<Self> {
        if found.size != truth.size || found.texels.len() != truth.texels.len() {
            return None;
        }
        let values = errors(&found.texels, &truth.texels);
        let all = Difference::of(&values, 1.0);
        Some(Self {
            size: found.size,
            rms: all.rms,
            largest: all.largest,
            summary: all.summary(),
            values,
        })
    }

    /// The error at a place, a share of each side from the upper left corner.
    pub fn at(&self, place: [f32; 2]) -> Option<f64> {
        self.values.get(index(self.size, place)?).copied()
    }

    /// The heat map: red is too bright, blue too dark, with the full colour at this error.
    pub fn image(&self, full: f64) -> ColorImage {
        let colours = self.values.iter().map(|error| {
            let [r, g, b, _] = colour(*error, full);
            Color32::from_rgb(r, g, b)
        });
        ColorImage::new(self.size.map(|side| side as usize), colours.collect())
    }
}
