//! Pictures as numbers: PNG, JPEG or OpenEXR, linear Rec.709, with all smaller levels. The format `picture` among [the formats of data](super::FORMATS).
//!
//! | vec4f | |
//! |---|---|
//! | 1 | width, height, number of levels, 0 |
//! | one for each level | its width, its height, number of its first texel among all `vec4f`, 0 |
//! | one for each texel | red, green, blue, 0: rows from the top, levels from the largest to the single texel that is the mean of the picture |

use crate::image::{decode_exr, decode_texture, exr_sizes, halved, srgb_to_linear, texture_size};

/// Most texels along one side.
pub const MAX_PICTURE_SIDE: u32 = 4096;
/// Most texels: with their levels they take 90 MB, and WebGPU's smallest limit of a storage buffer is 134 MB.
pub const MAX_PICTURE_TEXELS: u64 = 4 << 20;
/// Largest number of a channel: times any luminance it is still finite.
const MAX_CHANNEL: f32 = 1e6;

const EXR: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// The decoder of the format `picture`. What of a texel is transparent does not shine.
pub(super) fn decode(bytes: &[u8]) -> Result<Vec<f32>, String> {
    let (width, height, texels) = if bytes.starts_with(&EXR) { exr(bytes)? } else { encoded(bytes)? };
    levels(width, height, texels)
}

type Texels = (u32, u32, Vec<[f32; 4]>);

/// Its colours have been multiplied by the coverage already, as the format wants it. Below 0 is what Rec.709 cannot hold; it is taken for 0.
fn exr(bytes: &[u8]) -> Result<Texels, String> {
    for (width, height) in exr_sizes(bytes).map_err(|why| why.to_string())? {
        check(width, height)?;
    }
    let picture = decode_exr(bytes).map_err(|why| why.to_string())?;
    let texels = picture.texels.iter().map(|&[r, g, b, _]| [r, g, b, 0.0]).collect();
    Ok((picture.width, picture.height, texels))
}

/// Eight bits a channel, sRGB-encoded.
fn encoded(bytes: &[u8]) -> Result<Texels, String> {
    let (width, height) = texture_size(bytes).map_err(|why| why.to_string())?;
    check(width, height)?;
    let picture = decode_texture(bytes).map_err(|why| why.to_string())?;
    let light: Vec<f32> = (0..=u8::MAX).map(|code| srgb_to_linear(f32::from(code) / 255.0)).collect();
    let texel = |t: &[u8]| {
        let coverage = f32::from(t[3]) / 255.0;
        let [r, g, b] = [0, 1, 2].map(|channel| light[usize::from(t[channel])] * coverage);
        [r, g, b, 0.0]
    };
    Ok((picture.width, picture.height, picture.rgba.chunks_exact(4).map(texel).collect()))
}

/// Said of a header: a picture that is too large is refused before memory is taken for it.
fn check(width: u32, height: u32) -> Result<(), String> {
    if width > MAX_PICTURE_SIDE || height > MAX_PICTURE_SIDE || u64::from(width) * u64::from(height) > MAX_PICTURE_TEXELS {
        return Err(format!(
            "{width} x {height} texels, more than {MAX_PICTURE_SIDE} a side or {MAX_PICTURE_TEXELS} in all"
        ));
    }
    Ok(())
}

#[allow(clippy::cast_precision_loss)] // counts are below 2^24
fn levels(width: u32, height: u32, mut texels: Vec<[f32; 4]>) -> Result<Vec<f32>, String> {
    let (mut w, mut h) = (width as usize, height as usize);
    for (index, texel) in texels.iter_mut().enumerate() {
        if let Some(channel) = texel.iter().find(|channel| !channel.is_finite() || **channel > MAX_CHANNEL) {
            let (x, y) = (index % w, index / w);
            return Err(format!(
                "{channel} in the texel {x} from the left and {y} from the top: at most {MAX_CHANNEL} is taken"
            ));
        }
        *texel = texel.map(|channel| channel.max(0.0));
    }
    let count = width.max(height).ilog2() as usize + 1;
    let mut first = 1 + count;
    let mut head = vec![width as f32, height as f32, count as f32, 0.0];
    let mut rest: Vec<f32> = Vec::new();
    loop {
        head.extend([w as f32, h as f32, first as f32, 0.0]);
        first += texels.len();
        rest.extend_from_slice(texels.as_flattened());
        if w == 1 && h == 1 {
            break;
        }
        (w, h, texels) = halved(w, h, &texels);
    }
    head.extend(rest);
    Ok(head)
}

#[cfg(test)]
mod tests;
