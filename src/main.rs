//! The command `shadewright`. What it does is in `cli/`, one file a command; `spec/command.md` is its manual.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    env_logger::init();
    let arguments = cli::Arguments::parse();
    let format = arguments.format;
    cli::failure::finish(format, || cli::run(arguments))
}
