//! Files that the explorer writes.

/// Writes a file: all of it, or nothing.
///
/// # Errors
/// Why it cannot be written, for people.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(name: &str, bytes: &[u8]) -> Result<(), String> {
    let written = shadewright_runtime::image::write_atomically(std::path::Path::new(name), bytes);
    written.map_err(|error| error.to_string())
}

/// Writes a file: all of it, or nothing.
///
/// # Errors
/// Why it cannot be written, for people.
#[cfg(target_arch = "wasm32")]
pub fn save(_: &str, _: &[u8]) -> Result<(), String> {
    Err("the page cannot save files yet".to_owned())
}
