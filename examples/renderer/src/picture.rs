//! From radiance to a file.

use std::path::Path;

use crate::gpu::Error;

/// Luminance that becomes half of white, cd/m2.
const MIDDLE: f32 = 400.0;

/// What a screen shows of a channel: Reinhard's curve, sRGB-encoded.
fn shown(radiance: f32) -> u8 {
    let x = radiance / (radiance + MIDDLE);
    let encoded = if x <= 0.003_130_8 {
        12.92 * x
    } else {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    };
    (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Writes pictures of one size side by side, as PNG.
///
/// # Errors
/// The file cannot be written.
pub fn save(file: &Path, pictures: &[Vec<[f32; 4]>], width: u32, height: u32) -> Result<(), Error> {
    let mut image = image::RgbImage::new(width * pictures.len() as u32, height);
    for (x, y, pixel) in image.enumerate_pixels_mut() {
        let [r, g, b, _] = pictures[(x / width) as usize][(y * width + x % width) as usize];
        *pixel = image::Rgb([shown(r), shown(g), shown(b)]);
    }
    image
        .save(file)
        .map_err(|error| Error::File(format!("{}: {error}", file.display())))
}
