use std::sync::Arc;

use shadewright_compiler::diagnostics::SourceFile;
use shadewright_compiler::{Library, Report};

/// Several libraries as one. A file is the first library's that has it; folders are the union of all.
///
/// With a library of one's own first, a module there adds to the standard library, or stands before a module
/// of the same category and name.
#[derive(Clone)]
pub struct Overlay(pub Vec<Arc<dyn Library>>);

impl Library for Overlay {
    fn folders(&self, folder: &str) -> Vec<String> {
        let mut names: Vec<String> = self.0.iter().flat_map(|library| library.folders(folder)).collect();
        names.sort();
        names.dedup();
        names
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        for library in &self.0 {
            if let Some(text) = library.read(path)? {
                return Ok(Some(text));
            }
        }
        Ok(None)
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        for library in &self.0 {
            if let Some(bytes) = library.bytes(path)? {
                return Ok(Some(bytes));
            }
        }
        Ok(None)
    }

    fn file(&self, path: &str) -> Result<Option<Arc<SourceFile>>, Report> {
        for library in &self.0 {
            if let Some(file) = library.file(path)? {
                return Ok(Some(file));
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Folder, library};

    /// Catches an overlay that hides the standard library, forgets the added module, or lets the wrong file win.
    #[test]
    fn adds_and_replaces() {
        let base = tempfile::tempdir().unwrap();
        for module in ["mine", "ggx"] {
            std::fs::create_dir_all(base.path().join("ndf").join(module)).unwrap();
            std::fs::write(base.path().join("ndf").join(module).join("module.ron"), "(summary: \"mine\")").unwrap();
        }
        let both = Overlay(vec![Arc::new(Folder::new(base.path())), library()]);

        let names = both.folders("ndf");
        assert!(
            names.contains(&"mine".to_owned()) && names.iter().filter(|n| *n == "ggx").count() == 1,
            "{names:?}"
        );
        assert!(both.folders("").contains(&"brdf".to_owned()));
        assert_eq!(both.read("ndf/ggx/module.ron"), Ok(Some("(summary: \"mine\")".to_owned())));
        assert_eq!(both.read("brdf/category.ron"), library().read("brdf/category.ron"));
        assert_eq!(both.read("brdf/none"), Ok(None));
    }

    /// Catches an unreadable file of the first library being passed over in silence.
    #[test]
    fn an_error_is_not_skipped() {
        let both = Overlay(vec![Arc::new(Folder::new("/")), library()]);
        assert!(both.read("../brdf/category.ron").is_err());
    }
}
