//! A drawing as SVG and as PNG, both painted by plotters in the same steps.

use std::io::Cursor;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, RgbImage, imageops};
use plotters::prelude::{BitMapBackend, Circle, DrawingArea, DrawingBackend, IntoDrawingArea, PathElement, SVGBackend, ShapeStyle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontFamily, FontTransform, IntoFont, RGBColor, TextStyle};
use plotters::{coord::Shift, drawing::DrawingAreaErrorKind};

use super::colour::Colour;
use super::{Anchor, Drawing, Figure, Mark, Raster};
use crate::write::WriteError;
use crate::write::text::clean;

/// Painted at so many units a pixel: plotters' places are whole numbers, and its shapes have no smooth edges of their own.
pub const UNITS: u32 = 4;
/// The PNG has so many pixels for one of the SVG, for dense screens and print.
pub const DENSITY: u32 = 2;
/// plotters takes a font's size for this many ems.
const EM: f64 = 1.24;
/// plotters' own glyphs sit higher than a browser's at the same place, by this part of the font's size.
const DROP: f64 = 0.13;

/// Makes the font known, which glyphs and widths come from. The same each time.
///
/// # Errors
/// The font is no font; or this is a web page, where plotters takes no font of ours.
pub fn register_font() -> Result<(), WriteError> {
    #[cfg(not(target_arch = "wasm32"))]
    let registered = plotters::style::register_font(
        FontFamily::SansSerif.as_str(),
        plotters::style::FontStyle::Normal,
        epaint_default_fonts::UBUNTU_LIGHT,
    );
    #[cfg(target_arch = "wasm32")]
    let registered = Err::<(), ()>(());
    registered.map_err(|_| WriteError::Draw("the font cannot be read".to_owned()))
}

/// Width of a text in pixels, with room for another font than ours.
///
/// # Errors
/// No font is registered.
pub fn width(text: &str, size: f64) -> Result<f64, WriteError> {
    let font = (FontFamily::SansSerif, size * EM * f64::from(UNITS)).into_font();
    let ((left, _), (right, _)) = font.layout_box(text).map_err(|error| WriteError::Draw(error.to_string()))?;
    Ok(f64::from(right - left) / f64::from(UNITS) * 1.05)
}

/// Both forms of a drawing.
///
/// # Errors
/// See [`WriteError`].
pub fn figure(name: String, drawing: &Drawing) -> Result<Figure, WriteError> {
    Ok(Figure {
        name,
        svg: svg(drawing)?,
        png: png(drawing)?,
    })
}

/// A pixel's place in units.
fn units(at: f64) -> i32 {
    (at * f64::from(UNITS)).round() as i32
}

fn place([x, y]: [f64; 2]) -> (i32, i32) {
    (units(x), units(y))
}

fn solid(colour: Colour) -> RGBColor {
    let [r, g, b] = colour.rgb();
    RGBColor(r, g, b)
}

fn stroke(colour: Colour, width: f64) -> ShapeStyle {
    ShapeStyle {
        color: solid(colour).into(),
        filled: false,
        stroke_width: units(width).unsigned_abs().max(1),
    }
}

/// Paints marks. `drop` moves texts down by this part of their size.
fn paint<DB: DrawingBackend>(area: &DrawingArea<DB, Shift>, marks: &[Mark], drop: f64) -> Result<(), DrawingAreaErrorKind<DB::ErrorType>> {
    for mark in marks {
        match mark {
            Mark::Line { points, colour, width } => {
                let points: Vec<(i32, i32)> = points.iter().copied().map(place).collect();
                area.draw(&PathElement::new(points, stroke(*colour, *width)))?;
            }
            Mark::Disc { centre, radius, colour } => {
                let filled = stroke(*colour, 0.0).filled();
                area.draw(&Circle::new(place(*centre), units(*radius), filled))?;
            }
            Mark::Ring {
                centre,
                radius,
                colour,
                width,
            } => area.draw(&Circle::new(place(*centre), units(*radius), stroke(*colour, *width)))?,
            Mark::Text {
                at: [x, y],
                text,
                size,
                colour,
                anchor,
                turned,
            } => {
                let across = match anchor {
                    Anchor::Start => HPos::Left,
                    Anchor::Middle => HPos::Center,
                    Anchor::End => HPos::Right,
                };
                let down = size * drop * EM;
                let (transform, at) = if *turned {
                    (FontTransform::Rotate270, [x + down, *y])
                } else {
                    (FontTransform::None, [*x, y + down])
                };
                let font = (FontFamily::SansSerif, size * EM * f64::from(UNITS))
                    .into_font()
                    .transform(transform);
                let colour = solid(*colour);
                let style = TextStyle::from(font).color(&colour).pos(Pos::new(across, VPos::Center));
                area.draw(&Text::new(clean(text), place(at), style))?;
            }
        }
    }
    Ok(())
}

fn failed<E: std::error::Error + Send + Sync>(error: DrawingAreaErrorKind<E>) -> WriteError {
    WriteError::Draw(error.to_string())
}

/// An SVG that stands in a page as it stands in a file: sizes in pixels, what is drawn in units.
///
/// # Errors
/// See [`WriteError`].
pub fn svg(drawing: &Drawing) -> Result<String, WriteError> {
    let [wide, high] = [drawing.width * UNITS, drawing.height * UNITS];
    let mut painted = String::new();
    {
        let area = SVGBackend::with_string(&mut painted, (wide, high)).into_drawing_area();
        paint(&area, &drawing.marks, 0.0).map_err(failed)?;
        area.present().map_err(failed)?;
    }
    // The frame is ours: it has a size in pixels, a name, and what plotters has no marks for under and over its own.
    let start = painted.find(">\n").map_or(0, |end| end + 2);
    let end = painted.rfind("</svg>").unwrap_or(painted.len());
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {wide} {high}\" width=\"{}\" height=\"{}\" role=\"group\" aria-label=\"{}\">\n",
        drawing.width,
        drawing.height,
        escape(&drawing.description),
    );
    text += &format!("<rect width=\"{wide}\" height=\"{high}\" fill=\"{}\"/>\n", Colour::Paper.hex());
    for raster in &drawing.rasters {
        text += &embedded(raster)?;
    }
    // A text's line break is a space to a browser, which moves what is anchored at its end.
    text += &painted
        .get(start..end)
        .unwrap_or_default()
        .replace("\">\n", "\">")
        .replace("\n</text>", "</text>");
    for target in &drawing.targets {
        let (x, y) = place(target.at);
        let (title, name) = (escape(&target.name), escape(&target.name.replace('\n', "; ")));
        text += &format!(
            "<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" fill-opacity=\"0\" role=\"img\" aria-label=\"{name}\"><title>{title}</title></circle>\n",
            units(11.0)
        );
    }
    text += "</svg>\n";
    Ok(text)
}

/// For elements and attributes of XML.
fn escape(text: &str) -> String {
    text.split('\n')
        .map(|line| {
            clean(line)
                .replace('&', "&amp;")
                .replace('<', "&lt;")
                .replace('>', "&gt;")
                .replace('"', "&quot;")
        })
        .collect::<Vec<_>>()
        .join("\n")
}

fn embedded(raster: &Raster) -> Result<String, WriteError> {
    let rows = raster.pixels.len() as u32 / raster.columns.max(1);
    let mut image = RgbImage::new(raster.columns, rows);
    for (to, from) in image.pixels_mut().zip(&raster.pixels) {
        to.0 = *from;
    }
    let (x, y) = place(raster.at);
    let [width, height] = [raster.cell[0] * f64::from(raster.columns), raster.cell[1] * f64::from(rows)].map(units);
    Ok(format!(
        "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\" \
         href=\"data:image/png;base64,{}\"/>\n",
        STANDARD.encode(encoded(&image)?)
    ))
}

/// A PNG of the same, [`DENSITY`] pixels to each of the SVG's.
///
/// # Errors
/// See [`WriteError`].
pub fn png(drawing: &Drawing) -> Result<Vec<u8>, WriteError> {
    encoded(&painted(drawing)?)
}

/// The pixels of [`png`].
///
/// # Errors
/// See [`WriteError`].
pub fn painted(drawing: &Drawing) -> Result<RgbImage, WriteError> {
    let [wide, high] = [drawing.width * UNITS, drawing.height * UNITS];
    let mut fine = RgbImage::from_pixel(wide, high, image::Rgb(Colour::Paper.rgb()));
    for raster in &drawing.rasters {
        for (index, pixel) in raster.pixels.iter().enumerate() {
            let cell = [index as u32 % raster.columns.max(1), index as u32 / raster.columns.max(1)];
            // Edges of cells, lest rounded sizes add up.
            let edge = |axis: usize, cell: u32| units(raster.at[axis] + f64::from(cell) * raster.cell[axis]).unsigned_abs();
            for y in edge(1, cell[1])..edge(1, cell[1] + 1).min(high) {
                for x in edge(0, cell[0])..edge(0, cell[0] + 1).min(wide) {
                    fine.put_pixel(x, y, image::Rgb(*pixel));
                }
            }
        }
    }
    {
        let area = BitMapBackend::with_buffer(&mut fine, (wide, high)).into_drawing_area();
        paint(&area, &drawing.marks, DROP).map_err(failed)?;
        area.present().map_err(failed)?;
    }
    Ok(imageops::thumbnail(&fine, drawing.width * DENSITY, drawing.height * DENSITY))
}

/// # Errors
/// See [`WriteError`].
pub fn encoded(image: &RgbImage) -> Result<Vec<u8>, WriteError> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, ImageFormat::Png)?;
    Ok(bytes.into_inner())
}
