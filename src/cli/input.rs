//! Texts from files, arguments and standard input.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use shadewright::compiler::Recipe;

use super::failure::Failure;

/// Largest file that the command reads, in bytes; the compiler's own limits of texts are below it. Keeps an endless pipe from filling the memory.
const MAX_BYTES: u64 = 64 << 20;

/// Text of a file, or of standard input for `-`.
///
/// # Errors
/// It is not there, is too long, or is no UTF-8.
pub fn text(path: &Path) -> Result<String, Failure> {
    String::from_utf8(bytes(path)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::message(format!("{}: is no UTF-8 text (byte {at})", path.display()))
    })
}

/// Bytes of a file, or of standard input for `-`.
///
/// # Errors
/// It is not there, or is too long.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let name = path.display();
    let wrong = |error: std::io::Error| Failure::message(format!("{name}: cannot be read: {error}"));
    let mut bytes = Vec::new();
    let read = if path == Path::new("-") {
        std::io::stdin().lock().take(MAX_BYTES + 1).read_to_end(&mut bytes)
    } else {
        if path.is_dir() {
            return Err(Failure::message(format!("{name}: is a folder, not a file")));
        }
        File::open(path).map_err(wrong)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)
    };
    read.map_err(wrong)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Failure::message(format!("{name}: longer than {} MiB", MAX_BYTES >> 20)));
    }
    Ok(bytes)
}

/// A recipe as typed: `-`, an inline RON tree, a file, or a module's name.
///
/// # Errors
/// The file cannot be read, or its text is no recipe.
pub fn recipe(typed: &str) -> Result<Recipe, Failure> {
    let (name, text) = tree(typed, "recipe")?;
    let mut recipe = Recipe::parse(&name, &text)?;
    // What a file names stands beside it.
    if let Some(folder) = Path::new(&name).parent().filter(|_| name == typed) {
        recipe.root.files_below(folder);
    }
    Ok(recipe)
}

/// Name and text of a tree as typed; `kind` names one that stands in no file.
///
/// # Errors
/// The file cannot be read.
pub fn tree(typed: &str, kind: &str) -> Result<(String, String), Failure> {
    if typed == "-" {
        return Ok(("standard input".to_owned(), text(Path::new("-"))?));
    }
    let inline = typed.trim_start().starts_with(['(', '"']);
    let path = Path::new(typed);
    if !inline && path.is_file() {
        return Ok((typed.to_owned(), text(path)?));
    }
    if !inline && (Path::new(typed).extension().is_some() || path.is_absolute() || typed.starts_with('.')) {
        return Err(Failure::message(format!("{typed}: there is no such file")));
    }
    Ok((kind.to_owned(), typed.to_owned()))
}
