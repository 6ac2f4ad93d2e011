//! Files of data: what fills storage buffers of kind `Data`.
//!
//! A decoder turns the bytes of a format into 32-bit floats. [`FORMATS`] is the list of them; a module's manifest names one.

pub mod photometry;
mod picture;

use std::collections::HashMap;
use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

use shadewright_compiler::data::{self, Data, Origin, fits};
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::program::Program;

use crate::measured::{Merl, Rgl};

pub use picture::{MAX_PICTURE_SIDE, MAX_PICTURE_TEXELS};

/// Largest file of data, bytes.
pub const MAX_DATA: u64 = 256 << 20;

/// A decoder: the numbers of a file's bytes, or why there are none.
pub type Decoder = fn(&[u8]) -> Result<Vec<f32>, String>;

/// Little-endian 32-bit floats as they stand: the format of files for which none is named.
pub const PLAIN: &str = "f32";

/// Every format by name.
pub const FORMATS: &[(&str, Decoder)] = &[
    (PLAIN, data::numbers),
    ("merl", |bytes| {
        Merl::read(bytes).map(|table| table.floats()).map_err(|why| why.to_string())
    }),
    ("rgl", |bytes| {
        Rgl::read(bytes).map(|table| table.floats()).map_err(|why| why.to_string())
    }),
    ("photometry", photometry::decode),
    ("picture", picture::decode),
];

/// Why bytes are no numbers.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DecodeError {
    /// There is no decoder of this name.
    #[error("no decoder reads the format `{0}`")]
    UnknownFormat(String),
    /// What the decoder says of the bytes.
    #[error("{0}")]
    Damaged(String),
}

/// The decoder of a format.
///
/// # Errors
/// There is none.
pub(crate) fn decoder(format: &str) -> Result<Decoder, DecodeError> {
    let found = FORMATS.iter().find(|(name, _)| *name == format);
    found
        .map(|(_, decoder)| *decoder)
        .ok_or_else(|| DecodeError::UnknownFormat(format.to_owned()))
}

/// The numbers in a file's bytes: at least one, all finite.
///
/// # Errors
/// There is no such format, or the bytes are not of it.
pub fn decode(format: &str, bytes: &[u8]) -> Result<Vec<f32>, DecodeError> {
    let numbers = decoder(format)?(bytes).map_err(DecodeError::Damaged)?;
    data::finite(&numbers).map_err(DecodeError::Damaged)?;
    Ok(numbers)
}

/// The numbers of a file.
///
/// # Errors
/// As for [`decode`]; the file cannot be read, or is larger than [`MAX_DATA`].
pub fn read(path: &Path, format: &str) -> Result<Vec<f32>, DecodeError> {
    // Said before the file is looked for: what is wrong is the module, whatever the file.
    decoder(format)?;
    decode(format, &read_bytes(path, MAX_DATA).map_err(DecodeError::Damaged)?)
}

/// The bytes of a file on disk.
///
/// # Errors
/// Says why it cannot be read, or that it has more than `most` bytes.
pub(crate) fn read_bytes(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let failed = |error: std::io::Error| error.to_string();
    if path.is_dir() {
        return Err("is a folder".to_owned());
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    // Asked before, so that nothing is read of what is too large; and after, because not every file knows how long it is.
    let length = file.metadata().map_err(failed)?.len();
    if length <= most {
        file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    }
    if length.max(bytes.len() as u64) > most {
        return Err(format!("longer than the {most} bytes that a file may have"));
    }
    Ok(bytes)
}

/// The error about a file that somebody names, from a diagnostic that is made of code, message and label.
pub fn diagnose(file: &str, error: &DecodeError, located: impl FnOnce(&'static str, String, String) -> Diagnostic) -> Diagnostic {
    match error {
        DecodeError::UnknownFormat(format) => located(codes::UNKNOWN_FORMAT, error.to_string(), format!("`{file}` is to be read so"))
            .suggest(format, "formats", FORMATS.iter().map(|(name, _)| *name)),
        DecodeError::Damaged(why) => located(codes::BAD_DATA_FILE, format!("the file `{file}` cannot be used"), why.clone()),
    }
}

/// The numbers that fill a binding, read from the module's folder or from the file that the recipe names.
///
/// # Errors
/// There is no file, it is not of its format, or does not fill the buffer.
pub fn load(data: &Data) -> Result<Arc<[f32]>, Diagnostic> {
    let format = data.format.unwrap_or(PLAIN);
    let (file, numbers) = match &data.origin {
        Origin::Nobody => return Err(data.unnamed()),
        Origin::Module { path, bytes } => (path.as_str(), decode(format, bytes)),
        Origin::Recipe(path) => (*path, read(Path::new(path), format)),
    };
    let numbers = numbers.and_then(|numbers| {
        fits(data.layout, numbers.len()).map_err(DecodeError::Damaged)?;
        Ok(numbers)
    });
    match numbers {
        Ok(numbers) => Ok(numbers.into()),
        Err(error) => Err(diagnose(file, &error, |code, message, label| data.wrong(code, message, label))),
    }
}

/// Numbers by group and binding.
pub type Tables = HashMap<(u32, u32), Arc<[f32]>>;

/// The numbers of every binding of kind `Data` that a program has.
///
/// # Errors
/// As for [`load`].
pub fn load_all(program: &Program) -> Result<Tables, Diagnostic> {
    let bindings = program.reflection().bindings.iter();
    bindings
        .filter_map(|binding| Some(((binding.group, binding.binding), program.data(binding)?)))
        .map(|(at, data)| Ok((at, load(&data)?)))
        .collect()
}

#[cfg(test)]
mod tests;
