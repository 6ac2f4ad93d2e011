//! The scene's file, read again after another program has changed it.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::limits;
use shadewright_runtime::scene::Files;

use crate::work::{Bench, Job, News, Step};

/// Reads it.
pub struct Reread {
    /// The file.
    pub path: PathBuf,
    /// Where it is.
    pub files: Files,
}

impl Job for Reread {
    fn kind(&self) -> &'static str {
        "scene's file"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let bytes = self.files.bytes(&self.path, limits::FILE_SIZE as u64);
        // What is gone, or half written, is looked at when it changes again.
        if let Some(text) = bytes.ok().and_then(|bytes| String::from_utf8(bytes).ok()) {
            tell(News::OnDisk {
                path: self.path.clone(),
                text: text.into(),
            });
        }
        Step::Break(())
    }
}
