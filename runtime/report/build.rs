//! Finds the commit that this is built from, for a report's provenance; none outside of a repository.

// Cargo reads a build script's standard output.
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::process::Command;

fn main() {
    let log = Path::new("../../.git/logs/HEAD");
    if log.exists() {
        println!("cargo::rerun-if-changed={}", log.display());
    } else {
        // Otherwise every change of the package would be one.
        println!("cargo::rerun-if-changed=build.rs");
    }
    println!("cargo::rerun-if-env-changed=SHADEWRIGHT_COMMIT");
    if std::env::var_os("SHADEWRIGHT_COMMIT").is_some() {
        return;
    }
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .args(arguments)
            .output()
            .ok()
            .filter(|output| output.status.success())?;
        Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]).filter(|_| log.exists()) else {
        return;
    };
    let edited = git(&["status", "--porcelain"]).is_some_and(|files| !files.is_empty());
    println!("cargo::rustc-env=SHADEWRIGHT_COMMIT={commit}{}", if edited { "+" } else { "" });
}
