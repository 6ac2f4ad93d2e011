//! A sheet of pictures as a file.

use std::sync::atomic::AtomicBool;

use shadewright_report::write::{Tile, sheet};

use super::{Bench, Job, News, Step};
use crate::compare::Told;
use crate::files::save;

/// Writes a sheet of pictures.
pub struct WriteSheet {
    /// The pictures.
    pub tiles: Vec<Tile>,
    /// Width and height of each.
    pub size: [u32; 2],
    /// Where to.
    pub path: String,
}

impl WriteSheet {
    fn write(&self) -> Result<String, String> {
        let columns = (self.tiles.len() as f64).sqrt().ceil() as usize;
        let png = sheet(&self.tiles, self.size, columns).map_err(|error| error.to_string())?;
        let place = save(&self.path, &png)?;
        Ok(format!("wrote {place}, {} kB", png.len().div_ceil(1000)))
    }
}

impl Job for WriteSheet {
    fn kind(&self) -> &'static str {
        "sheet"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(News::Compare(Told::Sheet(self.write())));
        Step::Break(())
    }
}
