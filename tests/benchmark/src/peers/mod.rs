//! The other ways to compose a shader, each used as its documentation recommends.

pub mod concatenation;
pub mod oil;
pub mod wesl;

use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// naga's parser on a text.
///
/// # Errors
/// The text is no WGSL that naga takes.
pub fn parse(text: &str) -> Result<naga::Module, String> {
    naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))
}

/// naga's validator with all checks, as the compiler uses it.
///
/// # Errors
/// The validator refuses the module.
pub fn validate(module: &naga::Module) -> Result<ModuleInfo, String> {
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    validator.validate(module).map_err(|error| error.into_inner().to_string())
}

/// Text to a validated module: what a host pays that is given text.
///
/// # Errors
/// As for [`parse`] and [`validate`].
pub fn parse_and_validate(text: &str) -> Result<(naga::Module, ModuleInfo), String> {
    let module = parse(text)?;
    let info = validate(&module)?;
    Ok((module, info))
}
