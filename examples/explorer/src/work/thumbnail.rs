//! A small picture of a pin.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use eframe::egui::ColorImage;
use shadewright_compiler::Catalog;
use shadewright_runtime::frame::DisplayReading;
use shadewright_runtime::gpu::RuntimeError;
use shadewright_runtime::scene::Files;

use super::{Bench, Job, News, Progress, Step};
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
    /// The picture on its way from the GPU: `None` at first.
    pub reading: Option<DisplayReading>,
}

impl DrawThumbnail {
    /// Draws it and has it sent.
    fn start(&self, bench: &mut Bench) -> Result<Option<DisplayReading>, RuntimeError> {
        let frame = self.state.parse(&self.files)?.frame(&self.catalog, Some(self.size))?;
        let targets = bench.renderer(&self.catalog).render(&frame)?;
        targets.start_read_display(bench.gpu())
    }

    fn advance(&mut self, bench: &mut Bench) -> Result<Option<ColorImage>, RuntimeError> {
        if self.reading.is_none() {
            self.reading = self.start(bench)?;
        }
        let pixels = match &mut self.reading {
            // A scene that is not made for the screen.
            None => Some(Vec::new()),
            Some(reading) => {
                // A page waits for nothing, and asks again in its next frame.
                bench.gpu().wait()?;
                reading.take(bench.gpu()).transpose()?
            }
        };
        Ok(pixels.map(|pixels| picture(self.size, &pixels)))
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
        let drawn = match self.advance(bench) {
            Ok(None) => {
                return Step::Continue(Progress {
                    what: "drawing a pin".into(),
                    done: 1,
                    of: 2,
                });
            }
            Ok(Some(drawn)) => Ok(drawn),
            Err(error) => Err(error.to_string()),
        };
        tell(News::Compare(Told::Thumbnail(self.pin, drawn)));
        Step::Break(())
    }
}
