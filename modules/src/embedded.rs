use std::collections::BTreeSet;

use shadewright_compiler::Library;

/// Path and contents of every file of the standard library, sorted by path: texts, and files of numbers.
mod files {
    include!(concat!(env!("OUT_DIR"), "/files.rs"));
}
use files::{DATA, TEXTS};

/// The standard library, as it was when this crate was built.
#[derive(Clone, Copy, Debug, Default)]
pub struct Embedded;

impl Embedded {
    /// Path (relative, with `/`) and text of every file of text, sorted by path.
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &'static str)> {
        TEXTS.iter().copied()
    }
}

impl Library for Embedded {
    fn folders(&self, folder: &str) -> Vec<String> {
        let below = |path: &'static str| match folder {
            "" => Some(path),
            _ => path.strip_prefix(folder)?.strip_prefix('/'),
        };
        let names: BTreeSet<&str> = TEXTS
            .iter()
            .filter_map(|(path, _)| below(path)?.split_once('/'))
            .map(|(name, _)| name)
            .collect();
        names.into_iter().map(str::to_owned).collect()
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        Ok(TEXTS
            .binary_search_by_key(&path, |(name, _)| name)
            .ok()
            .map(|i| TEXTS[i].1.to_owned()))
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        match DATA.binary_search_by_key(&path, |(name, _)| name) {
            Ok(found) => Ok(Some(DATA[found].1.to_vec())),
            Err(_) => Ok(self.read(path)?.map(String::into_bytes)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches an embedding that misses a level of folders, or lists files as folders.
    #[test]
    fn folders_are_categories_then_modules() {
        let categories = Embedded.folders("");
        assert!(
            categories.contains(&"ndf".to_owned()) && categories.contains(&"pass".to_owned()),
            "{categories:?}"
        );
        assert!(!categories.contains(&"src".to_owned()));
        assert!(Embedded.folders("ndf").contains(&"ggx".to_owned()));
        assert_eq!(Embedded.folders("ndf/ggx"), Vec::<String>::new());
        // A prefix of a folder's name is no folder.
        assert_eq!(Embedded.folders("nd"), Vec::<String>::new());
    }

    /// Catches a table that is not sorted (the binary search would miss files) or holds other text than the file.
    #[test]
    fn every_file_reads_back_as_on_disk() {
        assert!(TEXTS.len() > 50);
        for (path, text) in TEXTS {
            assert_eq!(Embedded.read(path), Ok(Some((*text).to_owned())));
            let on_disk = std::fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap();
            assert_eq!(*text, on_disk);
        }
        for (path, bytes) in DATA {
            assert_eq!(Embedded.bytes(path), Ok(Some(bytes.to_vec())));
            assert_eq!(*bytes, std::fs::read(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).unwrap());
        }
        let manifest = Embedded.read("ndf/ggx/module.ron").unwrap();
        assert_eq!(Embedded.bytes("ndf/ggx/module.ron"), Ok(manifest.map(String::into_bytes)));
        assert_eq!(Embedded.bytes("ndf/none.f32"), Ok(None));
        assert_eq!(Embedded.read("ndf/none.wgsl"), Ok(None));
        assert_eq!(Embedded.read("../Cargo.toml"), Ok(None));
    }
}
