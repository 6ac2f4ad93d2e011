//! Where what is saved goes: into a file, whole or not at all; on the web page, to the browser's downloads.

/// Saves bytes under a name, natively a path. Says where they are.
///
/// # Errors
/// Says why they are nowhere.
#[cfg(not(target_arch = "wasm32"))]
pub fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
    let path = std::path::Path::new(name);
    shadewright_runtime::image::write_atomically(path, bytes).map_err(|error| error.to_string())?;
    Ok(path.display().to_string())
}

/// Offers bytes to the browser as a download of this name. Where it goes the browser knows.
///
/// # Errors
/// The browser does not take it.
#[cfg(target_arch = "wasm32")]
pub fn save(name: &str, bytes: &[u8]) -> Result<String, String> {
    super::web::download(name, bytes).map_err(|error| super::web::said(&error))?;
    Ok(format!("{name}, among the downloads"))
}
