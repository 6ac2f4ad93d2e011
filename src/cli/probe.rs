//! `probe`
use super::Context;
use super::failure::Failure;
use clap::Args;

/// Options of `probe`.
#[derive(Args)]
pub struct Options {
    recipe: String,
}
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let _ = (context, options);
    Ok(())
}
