//! `render`
use super::Context;
use super::failure::Failure;
use clap::Args;
use std::path::{Path, PathBuf};

/// Options of `render`.
#[derive(Args)]
pub struct Options {
    scene: PathBuf,
}
pub fn run(context: Context, options: &Options) -> Result<(), Failure> {
    let _ = (context, options);
    Ok(())
}
pub fn check(context: &Context, path: &Path) -> Result<(), Failure> {
    let _ = (context, path);
    Ok(())
}
