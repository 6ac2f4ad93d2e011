//! The command `shadewright`. What it does is in `cli/`, one file a command; `spec/command.md` is its manual.

#![forbid(unsafe_code)]

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    // Errors are told by exit status and message; what drivers log on their way there is for whoever sets RUST_LOG.
    env_logger::Builder::from_env(env_logger::Env::default().default_filter_or("off")).init();
    let arguments = cli::Arguments::parse();
    let format = arguments.format;
    cli::failure::finish(format, || cli::run(arguments))
}
