//! A small picture of a pin.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use eframe::egui::ColorImage;
use shadewright_compiler::Catalog;
use shadewright_runtime::gpu::RuntimeError;
use shadewright_runtime::scene::Files;

use super::{Bench, Job, News, Step};
use crate::compare::Told;
use crate::document::State;

/// Draws a pin's small picture.
pub struct DrawThumbnail {
    /// Its id.
    pub pin: u64,
    /// What it keeps.
    pub state: State,
    /// Where its files are.
    pub files: Files,
    /// The library.
    pub catalog: Arc<Catalog>,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

impl DrawThumbnail {
    fn draw(&self, bench: &mut Bench) -> Result<ColorImage, RuntimeError> {
        let frame = self.state.parse(&self.files)?.frame(&self.catalog, Some(self.size))?;
        let targets = bench.renderer(&self.catalog).render(&frame)?;
        let pixels = targets.read_display(bench.gpu())?.unwrap_or_default();
        Ok(picture(self.size, &pixels))
    }
}

/// Pixels for the window; black where there are too few.
pub fn picture(size: [u32; 2], pixels: &[u8]) -> ColorImage {
    let sides = size.map(|side| side as usize);
    let mut rgba = pixels.to_vec();
    rgba.resize(sides[0] * sides[1] * 4, 0);
    ColorImage::from_rgba_unmultiplied(sides, &rgba)
}

impl Job for DrawThumbnail {
    fn kind(&self) -> &'static str {
        "pin"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let drawn = self.draw(bench).map_err(|error| error.to_string());
        tell(News::Compare(Told::Thumbnail(self.pin, drawn)));
        Step::Break(())
    }
}
