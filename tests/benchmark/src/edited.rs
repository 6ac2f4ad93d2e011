//! A library in which one module is edited again and again.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use shadewright_compiler::Library;

/// The standard library, one of whose files ends in another comment after each edit.
pub struct Edited {
    standard: Arc<dyn Library>,
    path: &'static str,
    edits: AtomicUsize,
}

impl Edited {
    /// The library, with the file that will be edited.
    pub fn new(path: &'static str) -> Self {
        Self {
            standard: shadewright_modules::library(),
            path,
            edits: AtomicUsize::new(0),
        }
    }

    /// Edits the file.
    pub fn edit(&self) {
        self.edits.fetch_add(1, Ordering::Relaxed);
    }
}

impl Library for Edited {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.standard.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let text = self.standard.read(path)?;
        if path != self.path {
            return Ok(text);
        }
        let number = self.edits.load(Ordering::Relaxed);
        Ok(text.map(|text| format!("{text}\n// Edit {number}.\n")))
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        self.standard.bytes(path)
    }
}
