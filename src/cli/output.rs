//! Data goes to standard output, or whole into files: under a temporary name first, renamed at the end.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::failure::Failure;

/// Writes to standard output.
///
/// # Errors
/// Nobody reads any more ([`Failure::BrokenPipe`]), or the device is full.
pub fn write_stdout(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|error| match error.kind() {
        ErrorKind::BrokenPipe => Failure::BrokenPipe,
        _ => Failure::message(format!("standard output: {error}")),
    })
}

/// Writes a line or more of text to standard output, ended by one line break.
///
/// # Errors
/// As for [`write_stdout`].
pub fn say(text: &str) -> Result<(), Failure> {
    write_stdout(format!("{}\n", text.trim_end_matches('\n')).as_bytes())
}

/// Writes JSON to standard output.
///
/// # Errors
/// As for [`write_stdout`].
pub fn say_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    say(&json(value)?)
}

/// JSON as the command writes it everywhere.
///
/// # Errors
/// The value has no JSON form.
pub fn json(value: &impl serde::Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(value).map_err(|error| Failure::message(format!("this has no JSON form: {error}")))
}

/// Files of one command: all are written under temporary names beside their targets, then all are renamed.
/// Dropped before [`Outputs::commit`], nothing has happened.
#[derive(Default)]
pub struct Outputs {
    staged: Vec<Staged>,
}

enum Staged {
    /// To be renamed.
    File(NamedTempFile, PathBuf),
    /// A pipe or device, which a rename would replace by a file.
    Stream(Vec<u8>, PathBuf),
    /// `-`.
    Stdout(Vec<u8>),
}

impl Outputs {
    /// Writes bytes that will be at `path`, or on standard output for `-`.
    ///
    /// # Errors
    /// The folder is not there or cannot be written to.
    pub fn stage(&mut self, path: &Path, bytes: &[u8]) -> Result<(), Failure> {
        if path == Path::new("-") {
            self.staged.push(Staged::Stdout(bytes.to_vec()));
            return Ok(());
        }
        // A link stays a link: what it points to is replaced.
        let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        if target.is_dir() {
            return Err(Failure::message(format!("{}: is a folder", path.display())));
        }
        if target.exists() && !target.is_file() {
            self.staged.push(Staged::Stream(bytes.to_vec(), target));
            return Ok(());
        }
        let mut file = temporary_beside(&target)?;
        file.write_all(bytes).map_err(|error| cannot_write(path, &error))?;
        self.staged.push(Staged::File(file, target));
        Ok(())
    }

    /// Puts everything in its place.
    ///
    /// # Errors
    /// A file cannot be renamed, or standard output is closed.
    pub fn commit(self) -> Result<(), Failure> {
        for staged in self.staged {
            match staged {
                Staged::File(file, target) => {
                    file.persist(&target).map_err(|error| cannot_write(&target, &error.error))?;
                }
                Staged::Stream(bytes, target) => std::fs::write(&target, bytes).map_err(|error| cannot_write(&target, &error))?,
                Staged::Stdout(bytes) => write_stdout(&bytes)?,
            }
        }
        Ok(())
    }
}

/// A temporary file in the target's folder, so that the rename stays on one file system.
///
/// # Errors
/// The folder is not there or cannot be written to.
pub fn temporary_beside(target: &Path) -> Result<NamedTempFile, Failure> {
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".shadewright-");
    // As any program's output: readable as the user's umask says.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|error| cannot_write(target, &error))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::message(format!("{}: cannot be written: {error}", path.display()))
}
