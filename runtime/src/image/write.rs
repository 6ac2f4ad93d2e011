//! Files that are there whole or not at all.

use std::io::Write;
use std::path::Path;

use super::ImageError;

/// Writes the bytes to a temporary name in the same folder and renames it, so that whoever reads `path` sees the old file or
/// the new one, never a part.
///
/// # Errors
/// The folder is not there or not writable, or the disk is full. The temporary file is removed then.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), ImageError> {
    let failed = |error| ImageError::Write {
        path: path.to_owned(),
        error,
    };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".shadewright-").suffix(".part");
    // What a person's own program would get from the umask, where a temporary file would be private.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    file.flush().map_err(failed)?;
    file.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a temporary file left behind, an old file not replaced, and one destroyed by a failed write.
    #[test]
    fn replaces_whole_files() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        write_atomically(&path, b"one").unwrap();
        write_atomically(&path, b"two").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"two");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let nowhere = folder.path().join("none/a.bin");
        let error = write_atomically(&nowhere, b"x").unwrap_err();
        assert!(error.to_string().contains("none"), "{error}");
        // A folder cannot be replaced by a file: the write fails at the rename and leaves nothing.
        std::fs::create_dir(folder.path().join("dir")).unwrap();
        assert!(write_atomically(&folder.path().join("dir"), b"x").is_err());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }
}
