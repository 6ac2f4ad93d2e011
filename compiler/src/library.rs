//! Where the compiler's input comes from.

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
}
