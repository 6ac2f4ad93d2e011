//! Where the compiler's input comes from.

use std::sync::Arc;

use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};

/// Read access to a library of modules: folders of text files, named by `/`-separated relative paths.
///
/// This is the only way by which the compiler reaches anything outside its arguments.
pub trait Library: Send + Sync {
    /// Names of the folders directly in `folder` (`""` is the root), in any order.
    fn folders(&self, folder: &str) -> Vec<String>;
    /// Text of the file, `None` where there is none.
    ///
    /// # Errors
    /// Says why a file that is there cannot be read.
    fn read(&self, path: &str) -> Result<Option<String>, String>;
    /// Bytes of the file, `None` where there is none. A library of texts alone has their bytes.
    ///
    /// # Errors
    /// As for [`Library::read`].
    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        Ok(self.read(path)?.map(String::into_bytes))
    }
    /// As [`Library::read`], for errors that point into the file. A library that makes a text of other files says which part is whose, and
    /// where one of them is wrong.
    ///
    /// # Errors
    /// It cannot be read or made.
    fn file(&self, path: &str) -> Result<Option<Arc<SourceFile>>, Report> {
        let text = self.read(path).map_err(|why| unreadable(path, &why))?;
        Ok(text.map(|text| SourceFile::new(path, text)))
    }
}

/// A file that is there and cannot be read.
pub(crate) fn unreadable(path: &str, why: &str) -> Report {
    Diagnostic::new(codes::UNREADABLE_FILE, format!("`{path}` cannot be read: {why}")).into()
}
