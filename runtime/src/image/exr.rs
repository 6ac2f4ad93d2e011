//! OpenEXR: the linear HDR frame in physical units.

use std::io::Cursor;

use exr::meta::attribute::Text;
use exr::prelude::*;

use super::{Hdr, ImageError, check_limits, check_size};

/// Encodes the picture as OpenEXR: scan lines, lossless compression, channels R, G, B and A of 32-bit floats. The values are as they stand,
/// cd/m2; the attribute `whiteLuminance` is 1 (a value of 1 is one cd/m2), chromaticities are those of Rec.709.
///
/// # Errors
/// The number of texels is not width times height.
pub fn encode_exr(picture: &Hdr) -> std::result::Result<Vec<u8>, ImageError> {
    check_size(picture.width, picture.height, picture.texels.len())?;
    let width = picture.width as usize;
    let channels = SpecificChannels::rgba(|at: Vec2<usize>| {
        let [r, g, b, a] = picture.texels[at.y() * width + at.x()];
        (r, g, b, a)
    });
    let encoding = Encoding {
        // Lossless for 32-bit floats, as the physical values are compared with closed forms.
        compression: Compression::ZIP16,
        ..Encoding::SMALL_LOSSLESS
    };
    let mut layer = Layer::new(
        (picture.width as usize, picture.height as usize),
        LayerAttributes::default(),
        encoding,
        channels,
    );
    layer.attributes.software_name = Some(Text::from("shadewright"));
    layer.attributes.white_luminance = Some(1.0);
    // The one text: the crate keeps attributes of other names in a hash map, and equal pictures must give equal bytes.
    layer.attributes.comments = Text::new_or_none(&picture.comment);
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(attribute::Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    let mut out = Cursor::new(Vec::new());
    image
        .write()
        .non_parallel()
        .to_buffered(&mut out)
        .map_err(|e| ImageError::Encode(e.to_string()))?;
    Ok(out.into_inner())
}

/// Decodes the first layer with the channels R, G and B; missing alpha is opaque.
///
/// # Errors
/// The bytes are no OpenEXR with these channels, or damaged, or the picture is larger than the limits.
pub fn decode_exr(bytes: &[u8]) -> std::result::Result<Hdr, ImageError> {
    exr_sizes(bytes)?;
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| Hdr {
                width: size.width() as u32,
                height: size.height() as u32,
                texels: vec![[0.0; 4]; size.width() * size.height()],
                comment: String::new(),
            },
            |picture: &mut Hdr, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let width = picture.width as usize;
                picture.texels[at.y() * width + at.x()] = [r, g, b, a];
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(|e| ImageError::Decode(e.to_string()))?;
    let layer = image.layer_data;
    let mut picture = layer.channel_data.pixels;
    if let Some(comment) = &layer.attributes.comments {
        picture.comment = comment.to_string();
    }
    Ok(picture)
}

/// Width and height of each layer as the header says, before memory is taken for it.
///
/// # Errors
/// As for [`decode_exr`], of what is in the header.
pub(crate) fn exr_sizes(bytes: &[u8]) -> std::result::Result<Vec<(u32, u32)>, ImageError> {
    let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).map_err(|e| ImageError::Decode(e.to_string()))?;
    let size = |size: Vec2<usize>| -> std::result::Result<_, ImageError> {
        check_limits(size.width() as u64, size.height() as u64)?;
        Ok((size.width() as u32, size.height() as u32))
    };
    meta.headers.iter().map(|header| size(header.layer_size)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Hdr {
        Hdr {
            width: 3,
            height: 2,
            texels: vec![
                [0.0, 1.0, 2.0, 1.0],
                [65504.0, 1e9, 1e-30, 0.5],
                [0.1, 0.2, 0.3, 0.0],
                [std::f32::consts::PI, -1.0, 7.0, 1.0],
                [f32::MIN_POSITIVE, f32::MAX, 0.5, 1.0],
                [9.0, 8.0, 7.0, 6.0],
            ],
            comment: "recipe 0123456789abcdef, cd/m2".to_owned(),
        }
    }

    /// Catches half floats (65504 and pi would change), swapped rows or channels, and a lost comment.
    #[test]
    fn round_trip_is_exact() {
        let picture = sample();
        let bytes = encode_exr(&picture).unwrap();
        assert_eq!(decode_exr(&bytes).unwrap(), picture);
        assert_eq!(bytes, encode_exr(&picture).unwrap());
        let meta = MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
        let names: Vec<String> = meta.headers[0].channels.list.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(names, ["A", "B", "G", "R"]);
        assert_eq!(meta.headers[0].own_attributes.white_luminance, Some(1.0));
    }

    /// Catches a panic on damaged files.
    #[test]
    fn damaged_files_are_errors() {
        let bytes = encode_exr(&sample()).unwrap();
        for cut in 0..bytes.len() {
            let _ = decode_exr(&bytes[..cut]);
        }
        assert!(decode_exr(b"no picture").is_err());
        let mut wrong = sample();
        wrong.texels.pop();
        assert!(matches!(encode_exr(&wrong), Err(ImageError::Size { .. })));
    }
}
