//! PNG and JPEG: eight bits a channel, sRGB-encoded.

use std::io::Cursor;

use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader, Limits};

use super::{ImageError, MAX_SIDE, check_limits, check_size};
use crate::frame::Texture;

/// Encodes sRGB-encoded RGBA bytes, rows from the top, as PNG.
///
/// # Errors
/// The number of bytes is not `width * height * 4`.
pub fn encode_png(width: u32, height: u32, rgba: &[u8]) -> Result<Vec<u8>, ImageError> {
    check_size(width, height, rgba.len() / 4)?;
    let mut out = Vec::new();
    image::codecs::png::PngEncoder::new(&mut out)
        .write_image(&rgba[..rgba.len() / 4 * 4], width, height, ExtendedColorType::Rgba8)
        .map_err(|e| ImageError::Encode(e.to_string()))?;
    Ok(out)
}

/// Decodes a PNG or JPEG to RGBA bytes; wider channels are narrowed to eight bits, missing alpha is opaque.
///
/// # Errors
/// The bytes are neither, or damaged, or the picture is larger than the limits.
pub fn decode_texture(bytes: &[u8]) -> Result<Texture, ImageError> {
    texture_size(bytes)?;
    let image = open(bytes)?.decode().map_err(failed)?.into_rgba8();
    Ok(Texture {
        width: image.width(),
        height: image.height(),
        rgba: image.into_raw(),
    })
}

/// Width and height as the header says, before memory is taken for the picture.
///
/// # Errors
/// As for [`decode_texture`], of what is in the header.
pub(crate) fn texture_size(bytes: &[u8]) -> Result<(u32, u32), ImageError> {
    let (width, height) = open(bytes)?.into_dimensions().map_err(failed)?;
    check_limits(width.into(), height.into())?;
    Ok((width, height))
}

fn open(bytes: &[u8]) -> Result<ImageReader<Cursor<&[u8]>>, ImageError> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| ImageError::Decode(e.to_string()))?;
    if !matches!(reader.format(), Some(ImageFormat::Png | ImageFormat::Jpeg)) {
        return Err(ImageError::Decode("neither PNG nor JPEG".to_owned()));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    Ok(reader)
}

#[allow(clippy::needless_pass_by_value)] // as `map_err` passes it
fn failed(error: image::ImageError) -> ImageError {
    ImageError::Decode(error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches swapped channels, rows upside down, and lost alpha.
    #[test]
    fn png_round_trip() {
        let rgba: Vec<u8> = (0..2 * 3 * 4).map(|i| i * 10).collect();
        let bytes = encode_png(2, 3, &rgba).unwrap();
        let back = decode_texture(&bytes).unwrap();
        assert_eq!((back.width, back.height, back.rgba), (2, 3, rgba));
        assert!(matches!(encode_png(2, 2, &[0; 12]), Err(ImageError::Size { .. })));
        assert!(matches!(encode_png(0, 2, &[]), Err(ImageError::Size { .. })));
    }

    /// Catches a panic, or memory taken on a header's word.
    #[test]
    fn damaged_pictures_are_errors() {
        let bytes = encode_png(16, 16, &[77; 16 * 16 * 4]).unwrap();
        for cut in 0..bytes.len() - 12 {
            let _ = decode_texture(&bytes[..cut]);
        }
        for at in 0..bytes.len() {
            for bit in [0x01, 0x80] {
                let mut damaged = bytes.clone();
                damaged[at] ^= bit;
                let _ = decode_texture(&damaged);
            }
        }
        assert!(decode_texture(b"GIF89a").is_err());
        assert!(decode_texture(b"").is_err());
        // IHDR of 65536 x 65536 with its right checksum.
        let mut huge = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\x01\0\0\0\x01\0\0\x08\x06\0\0\0".to_vec();
        huge.extend(0x9d8d_55cb_u32.to_be_bytes());
        assert!(decode_texture(&huge).is_err());
    }
}
