//! What others say of what is emitted: naga's front end, `tint` (the WGSL compiler of a browser) and `spirv-val` (the validator of the
//! SPIR-V tools) where they are installed.
#![allow(dead_code, clippy::expect_used)]

use std::io::Write;
use std::process::{Command, Stdio};

use naga::valid::{Capabilities, ValidationFlags, Validator};

/// Runs a program that judges a file; `None` where it is not installed, which is said on standard output.
fn verdict(program: &str, arguments: &[&str], contents: &[u8]) -> Option<Result<(), String>> {
    let folder = tempfile::tempdir().expect("a folder");
    // The ending tells `tint` the language.
    let file = folder.path().join(if program == "tint" { "shader.wgsl" } else { "shader.spv" });
    std::fs::write(&file, contents).expect("written");
    let ran = Command::new(program).args(arguments).arg(&file).stdout(Stdio::null()).output();
    match ran {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            // Not `println`, which is held back from who does not ask for it.
            let _ = writeln!(std::io::stdout(), "{program} is not installed: its verdict is missing");
            None
        }
        Err(error) => panic!("{program}: {error}"),
        Ok(ran) if ran.status.success() => Some(Ok(())),
        Ok(ran) => Some(Err(String::from_utf8_lossy(&ran.stderr).into_owned())),
    }
}

/// The verdict of a browser's compiler; `None` where it is not installed.
pub fn tint(wgsl: &str) -> Option<Result<(), String>> {
    verdict("tint", &["--format", "wgsl"], wgsl.as_bytes())
}

/// The verdict of the SPIR-V tools; `None` where they are not installed.
pub fn spirv_val(spirv: &[u8]) -> Option<Result<(), String>> {
    verdict("spirv-val", &["--target-env", "vulkan1.1"], spirv)
}

/// The verdict of naga's own front end and validator.
pub fn naga_takes(wgsl: &str) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(wgsl).map_err(|error| error.emit_to_string(wgsl))?;
    let verdict = Validator::new(ValidationFlags::all(), Capabilities::default()).validate(&module);
    verdict.map(|_| ()).map_err(|error| error.emit_to_string(wgsl))
}
