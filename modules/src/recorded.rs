use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use shadewright_compiler::Library;

/// A library that remembers which of its files have been read, for whoever must know what a product was made of.
pub struct Recorded {
    library: Arc<dyn Library>,
    read: Mutex<BTreeSet<String>>,
}

impl Recorded {
    /// A library of which nothing has been read yet.
    pub fn new(library: Arc<dyn Library>) -> Self {
        Self {
            library,
            read: Mutex::default(),
        }
    }

    /// Paths of the files that were there and were read, or could not be, sorted.
    pub fn paths(&self) -> Vec<String> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }
}

impl Library for Recorded {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.library.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let text = self.library.read(path);
        if !matches!(text, Ok(None)) {
            self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
        }
        text
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        let bytes = self.library.bytes(path);
        if !matches!(bytes, Ok(None)) {
            self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
        }
        bytes
    }
}
