use std::fs;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use shadewright_compiler::Library;

/// No module needs more; keeps a mistaken path from filling the memory.
const MAX_BYTES: u64 = 16 << 20;

/// A library in a folder of the file system, read anew at every call.
#[derive(Clone, Debug)]
pub struct Folder {
    root: PathBuf,
}

impl Folder {
    /// The library in `root`. A folder that does not exist is an empty library.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self { root: root.into() }
    }

    /// The folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The place of a path of the library; `None` where it does not exist.
    ///
    /// # Errors
    /// It is outside the root, by `..`, by being absolute, or behind a link.
    fn place(&self, path: &str) -> Result<Option<PathBuf>, String> {
        let outside = || format!("`{path}` is outside the library's folder {}", self.root.display());
        if !Path::new(path).components().all(|c| matches!(c, Component::Normal(_))) {
            return Err(outside());
        }
        let found = |place: &Path| match fs::canonicalize(place) {
            Ok(real) => Ok(Some(real)),
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
            Err(e) => Err(format!("{}: {e}", place.display())),
        };
        let (Some(root), Some(real)) = (found(&self.root)?, found(&self.root.join(path))?) else {
            return Ok(None);
        };
        if real.starts_with(&root) { Ok(Some(real)) } else { Err(outside()) }
    }
}

impl Library for Folder {
    fn folders(&self, folder: &str) -> Vec<String> {
        let Ok(Some(place)) = self.place(folder) else {
            return Vec::new();
        };
        let Ok(entries) = fs::read_dir(place) else {
            return Vec::new();
        };
        let mut names: Vec<String> = entries
            .filter_map(Result::ok)
            .filter(|e| e.path().is_dir())
            .filter_map(|e| e.file_name().into_string().ok())
            .collect();
        names.sort();
        names
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        let text = |bytes| String::from_utf8(bytes).map_err(|error| format!("{path}: is no UTF-8 text: {error}"));
        self.bytes(path)?.map(text).transpose()
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        let Some(place) = self.place(path)? else {
            return Ok(None);
        };
        let said = |e: std::io::Error| format!("{}: {e}", place.display());
        let about = fs::metadata(&place).map_err(said)?;
        if !about.is_file() {
            return Ok(None);
        }
        if about.len() > MAX_BYTES {
            return Err(format!(
                "{}: {} bytes, more than the {MAX_BYTES} that a file may have",
                place.display(),
                about.len()
            ));
        }
        fs::read(&place).map(Some).map_err(said)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> (tempfile::TempDir, Folder) {
        let base = tempfile::tempdir().unwrap();
        fs::create_dir_all(base.path().join("lib/ndf/mine")).unwrap();
        fs::write(base.path().join("secret.ron"), "secret").unwrap();
        fs::write(base.path().join("lib/ndf/mine/module.ron"), "()").unwrap();
        let folder = Folder::new(base.path().join("lib"));
        (base, folder)
    }

    #[test]
    fn reads_files_and_lists_folders() {
        let (_base, folder) = sample();
        assert_eq!(folder.folders(""), ["ndf"]);
        assert_eq!(folder.folders("ndf"), ["mine"]);
        assert_eq!(folder.read("ndf/mine/module.ron"), Ok(Some("()".to_owned())));
        assert_eq!(folder.read("ndf/mine/none.ron"), Ok(None));
        assert_eq!(folder.read("ndf/mine/module.ron/deeper"), Ok(None));
        assert_eq!(folder.read("ndf"), Ok(None));
        assert_eq!(Folder::new("/no/such/folder").folders(""), Vec::<String>::new());
        assert_eq!(Folder::new("/no/such/folder").read("a.ron"), Ok(None));
    }

    /// Catches a path that walks out of the library.
    #[test]
    fn refuses_paths_that_leave() {
        let (base, folder) = sample();
        let absolute = base.path().join("secret.ron").display().to_string();
        for path in ["../secret.ron", "ndf/../../secret.ron", absolute.as_str(), "./ndf/mine/module.ron"] {
            assert!(folder.read(path).unwrap_err().contains("outside the library"), "{path}");
        }
        assert_eq!(folder.folders(".."), Vec::<String>::new());
    }

    /// Catches a link that leads out of the library, which a look at the path alone cannot see.
    #[cfg(unix)]
    #[test]
    fn refuses_links_that_leave() {
        let (base, folder) = sample();
        std::os::unix::fs::symlink(base.path().join("secret.ron"), base.path().join("lib/ndf/link.ron")).unwrap();
        assert!(folder.read("ndf/link.ron").unwrap_err().contains("outside the library"));
    }

    #[test]
    fn says_which_file_is_no_text() {
        let (base, folder) = sample();
        fs::write(base.path().join("lib/ndf/bad.wgsl"), [0xff, 0xfe, 0x00]).unwrap();
        assert!(folder.read("ndf/bad.wgsl").unwrap_err().contains("bad.wgsl"));
        assert_eq!(folder.bytes("ndf/bad.wgsl"), Ok(Some(vec![0xff, 0xfe, 0x00])));
        assert!(folder.bytes("../bad.wgsl").is_err());
    }
}
