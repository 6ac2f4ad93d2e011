//! What takes longer than a frame of the window is done beside it: jobs, and the lanes that they are done in.
//!
//! A job is done in steps. Natively a lane has a thread that does them; on a web page, where there are none, each frame of the page does some. A lane
//! holds one job of a kind at most: a newer one takes the place of one that waits, and ends one that runs after its step. So nothing piles up while
//! somebody turns a knob.

mod bench;
mod beside;
mod inspect;
mod lane;
mod legal;
mod listing;
mod measure;
mod pace;
mod paint;
mod places;
mod reading;
mod reference;
mod sheet;
mod sweep;
#[cfg(test)]
mod tests;
mod thumbnail;

use std::path::PathBuf;
use std::sync::Arc;

use shadewright_compiler::{Catalog, Report};
use shadewright_runtime::scene::SceneFile;

use crate::files::Found;

pub use bench::Bench;
pub use beside::{DrawBeside, LoadTruths, PaintHeat, Sent};
pub use inspect::{Inspect, Inspected, Language, Made, View, inspect};
pub use lane::{Job, Lane, Progress, Step};
pub use legal::{Legal, Try, Verdict, links, reason};
pub use listing::{Line, Listing};
pub use measure::Measure;
pub use paint::{Paint, Painted, Times, paint, wrong};
pub use places::{Concerned, Places};
pub use reading::Reading;
pub use reference::Refine;
pub use sheet::WriteSheet;
pub use sweep::{Alternative, Change, MOST, Measured, Sweep};
pub use thumbnail::{DrawThumbnail, picture};

/// A scene at one moment, with the library that it is linked from.
#[derive(Clone)]
pub struct Shot {
    /// The scene.
    pub scene: SceneFile,
    /// The library.
    pub catalog: Arc<Catalog>,
    /// Grows with every change of either.
    pub version: u64,
}

/// What jobs tell.
#[derive(Debug)]
pub enum News {
    /// The picture of the viewport.
    Painted(Box<Painted>),
    /// A job could not be done, because the scene or a module is wrong.
    Wrong {
        /// Of which shot.
        version: u64,
        /// What is wrong.
        report: Report,
    },
    /// A job could not be done, for another reason: the GPU's.
    Failed {
        /// What was being done.
        what: &'static str,
        /// Why.
        message: String,
    },
    /// Which choices are legal in a place.
    Legal(Legal),
    /// Linked code.
    Inspected(Box<Inspected>),
    /// Which rows of the tree problems concern.
    Concerned(Concerned),
    /// Of comparing.
    Compare(crate::compare::Told),
    /// What a file holds.
    Found(Found),
    /// What the scene's file holds after another program has changed it.
    OnDisk {
        /// The file.
        path: PathBuf,
        /// What it holds.
        text: Arc<str>,
    },
    /// A library that was read, or what is wrong with it.
    Library(Result<Arc<Catalog>, Report>),
    /// Something was done.
    Said(String),
}
