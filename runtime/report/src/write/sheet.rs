//! A contact sheet: pictures of one size side by side, each with its name beneath.

use image::{RgbImage, RgbaImage, imageops};

use super::WriteError;
use super::drawing::colour::Colour;
use super::drawing::paint::{self, DENSITY};
use super::drawing::{Anchor, Drawing, Mark};

/// A picture and its name.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// Written beneath.
    pub name: String,
    /// sRGB-encoded RGBA, rows from the top.
    pub pixels: Vec<u8>,
}

/// Height of a name's strip, in pixels of the sheet.
const STRIP: u32 = 24;
/// Free space around a tile, in pixels of the sheet.
const GAP: u32 = 4;
/// Size of the letters, in pixels of a drawing; a name that is too long for its tile gets smaller ones.
const LETTERS: f64 = 7.5;

/// Width and height of a sheet with so many tiles of this size.
pub fn sheet_size(tiles: usize, [width, height]: [u32; 2], columns: usize) -> [u64; 2] {
    let [across, down] = [columns.min(tiles), tiles.div_ceil(columns.max(1))].map(|n| n as u64);
    [
        across * (u64::from(width) + u64::from(GAP)) + u64::from(GAP),
        down * (u64::from(height) + u64::from(STRIP)) + u64::from(GAP),
    ]
}

/// The sheet as PNG: tiles of `size` pixels in rows of `columns`, in their order. Equal tiles give equal bytes.
///
/// # Errors
/// A tile has another number of bytes than its size says, or see [`WriteError`].
pub fn sheet(tiles: &[Tile], size: [u32; 2], columns: usize) -> Result<Vec<u8>, WriteError> {
    paint::register_font()?;
    let [width, height] = size;
    let columns = columns.max(1);
    let [across, down] = sheet_size(tiles.len(), size, columns).map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    let mut all = RgbImage::from_pixel(across, down, image::Rgb(Colour::Paper.rgb()));
    for (index, tile) in tiles.iter().enumerate() {
        let wrong = || WriteError::Draw(format!("the picture `{}` should have {width} x {height} pixels", tile.name));
        // The image takes a longer list as well.
        let exact = tile.pixels.len() as u64 == 4 * u64::from(width) * u64::from(height);
        let picture = exact
            .then(|| RgbaImage::from_raw(width, height, tile.pixels.clone()))
            .flatten()
            .ok_or_else(wrong)?;
        let x = GAP + (index % columns) as u32 * (width + GAP);
        let y = GAP + (index / columns) as u32 * (height + STRIP);
        imageops::replace(&mut all, &image::DynamicImage::from(picture).to_rgb8(), x.into(), y.into());
        imageops::replace(&mut all, &strip(&tile.name, width)?, x.into(), (y + height).into());
    }
    paint::encoded(&all)
}

/// A name in the middle of a strip.
fn strip(name: &str, width: u32) -> Result<RgbImage, WriteError> {
    let drawn = width.div_ceil(DENSITY);
    let natural = paint::width(name, LETTERS)?;
    let drawing = Drawing {
        width: drawn,
        height: STRIP / DENSITY,
        marks: vec![Mark::Text {
            at: [f64::from(drawn) / 2.0, f64::from(STRIP / DENSITY) / 2.0],
            text: name.to_owned(),
            size: LETTERS * (f64::from(drawn) / natural.max(1.0)).min(1.0),
            colour: Colour::Ink,
            anchor: Anchor::Middle,
            turned: false,
        }],
        ..Drawing::default()
    };
    let strip = paint::painted(&drawing)?;
    Ok(imageops::crop_imm(&strip, 0, 0, width, STRIP).to_image())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(name: &str, colour: [u8; 4], [width, height]: [u32; 2]) -> Tile {
        Tile {
            name: name.to_owned(),
            pixels: colour.repeat((width * height) as usize),
        }
    }

    fn decoded(png: &[u8]) -> RgbImage {
        image::load_from_memory(png).unwrap().to_rgb8()
    }

    /// Catches tiles in another order, a row too few, names under the wrong picture or none, and a long name that runs into its neighbour.
    #[test]
    fn tiles_stand_in_rows_over_their_names() {
        let size = [60, 20];
        let tiles = [
            tile("a", [255, 0, 0, 255], size),
            tile("", [0, 255, 0, 255], size),
            tile("a name that is far longer than its picture is wide", [0, 0, 255, 255], size),
        ];
        let found = decoded(&sheet(&tiles, size, 2).unwrap());
        assert_eq!([found.width(), found.height()].map(u64::from), sheet_size(3, size, 2));
        let rows = size[1] + STRIP;
        for (at, colour) in [
            ([0, 0], [255, 0, 0]),
            ([1, 0], [0, 255, 0]),
            ([0, 1], [0, 0, 255]),
            ([1, 1], [255; 3]),
        ] {
            let [x, y] = [GAP + at[0] * (size[0] + GAP), GAP + at[1] * rows];
            assert_eq!(found.get_pixel(x, y).0, colour);
            assert_eq!(found.get_pixel(x + size[0] - 1, y + size[1] - 1).0, colour);
        }
        let dark = |from: [u32; 2], to: [u32; 2]| {
            let all = (from[1]..to[1]).flat_map(|y| (from[0]..to[0]).map(move |x| (x, y)));
            all.filter(|(x, y)| found.get_pixel(*x, *y).0[0] < 200).count()
        };
        let below = GAP + size[1];
        assert!(dark([GAP, below], [GAP + size[0], below + STRIP]) > 10, "the name `a`");
        let beside = GAP + size[0] + GAP;
        assert_eq!(dark([beside, below], [beside + size[0], below + STRIP]), 0, "no name");
        let [left, top] = [GAP, below + rows];
        assert!(dark([left, top], [left + size[0], top + STRIP]) > 30, "the long name");
        assert_eq!(
            dark([left + size[0], top], [found.width(), top + STRIP]),
            0,
            "its neighbour's place"
        );
    }

    /// Catches a panic, or a sheet with a hole, where a picture is not of the size that was said.
    #[test]
    fn a_picture_of_another_size_is_refused() {
        let error = sheet(&[tile("wide", [0; 4], [3, 2])], [2, 2], 1).unwrap_err();
        assert_eq!(
            error.to_string(),
            "a plot cannot be drawn: the picture `wide` should have 2 x 2 pixels"
        );
    }
}
