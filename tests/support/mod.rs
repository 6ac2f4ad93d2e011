//! What the tests of the command share.
#![allow(dead_code, clippy::expect_used, clippy::unwrap_used)]

use std::path::Path;

use assert_cmd::Command;
use serde_json::Value;

/// A matte pass lit by point lights, without shadows.
pub const MATTE: &str = r#"(module: "forward", fill: {"brdf": "lambert", "lights": ["point"]})"#;
/// The same, with shadows.
pub const SHADOWED: &str =
    r#"(module: "forward", fill: {"brdf": "lambert", "lights": [(module: "point", fill: {"visibility": "cube-map"})]})"#;
/// The same as `MATTE`, glossy.
pub const GLOSSY: &str = r#"(module: "forward", fill: {"brdf": "microfacet", "lights": ["point"]})"#;

/// The command, ready to run.
pub fn shadewright() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_shadewright"));
    command.timeout(std::time::Duration::from_secs(300));
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // Drivers complain on standard error where it isn't set.
        command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
    command
}

/// What a run left behind.
#[derive(Debug)]
pub struct Ran {
    pub status: i32,
    pub out: Vec<u8>,
    pub err: String,
}

impl Ran {
    /// Standard output as text.
    pub fn text(&self) -> &str {
        std::str::from_utf8(&self.out).expect("UTF-8 on standard output")
    }

    /// Standard output as JSON.
    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.out).unwrap_or_else(|error| panic!("{error} in:\n{}", self.text()))
    }
}

/// Runs the command with these arguments.
pub fn run(arguments: &[&str]) -> Ran {
    finish(shadewright().args(arguments))
}

/// Runs the command with a text on standard input.
pub fn run_with_input(arguments: &[&str], input: &str) -> Ran {
    finish(shadewright().args(arguments).write_stdin(input))
}

/// Runs a command to its end.
pub fn finish(command: &mut Command) -> Ran {
    let output = command.output().expect("the command runs");
    Ran {
        status: output.status.code().expect("the command ends by itself"),
        out: output.stdout,
        err: String::from_utf8(output.stderr).expect("UTF-8 on standard error"),
    }
}

/// Runs the command, which must succeed without a word on standard error.
pub fn good(arguments: &[&str]) -> Ran {
    let ran = run(arguments);
    assert_eq!(ran.status, 0, "{arguments:?}\n{}", ran.err);
    assert_eq!(ran.err, "", "{arguments:?}");
    ran
}

/// Runs the command, which must fail with this status, say so on standard error only, and name these words there.
pub fn bad(arguments: &[&str], status: i32, words: &[&str]) -> Ran {
    let ran = run(arguments);
    assert_eq!(ran.status, status, "{arguments:?}\n{}{}", ran.text(), ran.err);
    assert_eq!(ran.text(), "", "{arguments:?}");
    for word in words {
        assert!(ran.err.contains(word), "{arguments:?}: no `{word}` in\n{}", ran.err);
    }
    ran
}

/// Names of a folder's entries, sorted; hidden ones too, so that forgotten temporary files are seen.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    let mut names: Vec<String> = entries.map(|entry| entry.file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}
