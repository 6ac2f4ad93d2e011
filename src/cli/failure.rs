//! How a command ends: its exit status, and what it says on standard error.

use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};

use serde_json::json;
use shadewright::compiler::Report;
use shadewright::runtime::gpu::{GpuError, RuntimeError};

use super::Format;

/// Why a command could not do what it was asked.
#[derive(Debug)]
pub enum Failure {
    /// The input is wrong in a known place: status 1.
    Input(Report),
    /// The input is wrong, or a file cannot be read or written: status 1.
    Message(String),
    /// The arguments contradict each other: status 2.
    Usage(String),
    /// No GPU, and what to install: status 3.
    NoGpu(String),
    /// The GPU refused what we made for it: status 70.
    Bug(String),
    /// Somebody pressed Ctrl-C, and what was done till then is in order: status 130, as shells have it.
    Interrupted(String),
    /// All has been said on standard output already: status 1.
    Said,
    /// Whoever reads standard output has seen enough: status 0.
    BrokenPipe,
}

impl From<Report> for Failure {
    fn from(report: Report) -> Self {
        Self::Input(report)
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::Invalid { .. } => Self::Bug(error.to_string()),
            _ => Self::NoGpu(error.to_string()),
        }
    }
}

impl From<RuntimeError> for Failure {
    fn from(error: RuntimeError) -> Self {
        match error {
            RuntimeError::Gpu(error) => error.into(),
            RuntimeError::Compile(report) => report.into(),
            RuntimeError::Data(error) => Self::Message(error.to_string()),
            RuntimeError::Evaluate(error) => Self::Message(error.to_string()),
        }
    }
}

impl Failure {
    /// Something without a place in a text.
    pub fn message(text: impl Into<String>) -> Self {
        Self::Message(text.into())
    }

    fn status(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Message(_) | Self::Said => 1,
            Self::Usage(_) => 2,
            Self::NoGpu(_) => 3,
            Self::Bug(_) => BUG,
            Self::Interrupted(_) => 130,
            Self::BrokenPipe => 0,
        }
    }

    /// What is wrong, for people.
    pub fn text(&self) -> String {
        match self {
            Self::Input(report) => report.render(),
            Self::Message(text) | Self::Usage(text) | Self::NoGpu(text) => format!("error: {text}"),
            Self::Interrupted(text) => format!("interrupted: {text}"),
            Self::Bug(text) => bug(text),
            Self::Said | Self::BrokenPipe => String::new(),
        }
    }

    /// Says on standard error what is wrong.
    pub fn say(&self, format: Format) {
        match (self, format) {
            (Self::Said | Self::BrokenPipe, _) => {}
            (_, Format::Text) => complain(&self.text()),
            (Self::Input(report), Format::Json) => {
                complain(&json!({"status": self.status(), "diagnostics": report.to_json()}).to_string());
            }
            (
                Self::Message(message) | Self::Usage(message) | Self::NoGpu(message) | Self::Bug(message) | Self::Interrupted(message),
                Format::Json,
            ) => {
                complain(&json!({"status": self.status(), "message": message}).to_string());
            }
        }
    }
}

/// Writes to standard error; where that is closed there is nobody left to tell.
fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
}

const BUG: u8 = 70;

/// One line for a bug of ours.
fn bug(what: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "shadewright {version}: this is a bug of ours, please report it: {}",
        what.replace('\n', " ")
    )
}

/// Runs a command to its exit status. A panic is a bug of ours: one line and status 70.
pub fn finish(format: Format, command: impl FnOnce() -> Result<(), Failure>) -> ExitCode {
    ExitCode::from(status_of(format, command))
}

fn status_of(format: Format, command: impl FnOnce() -> Result<(), Failure>) -> u8 {
    // The hook only remembers: panics that the compiler catches itself (those of naga) are reported as diagnostics.
    let last = Arc::new(Mutex::new(String::new()));
    let seen = Arc::clone(&last);
    std::panic::set_hook(Box::new(move |info| {
        *seen.lock().unwrap_or_else(PoisonError::into_inner) = info.to_string();
    }));
    let result = catch_unwind(AssertUnwindSafe(command));
    drop(std::panic::take_hook());
    match result {
        Ok(Ok(())) => 0,
        Ok(Err(failure)) => {
            failure.say(format);
            failure.status()
        }
        Err(_) => {
            let text = last.lock().unwrap_or_else(PoisonError::into_inner).clone();
            complain(&bug(&text));
            BUG
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a panic hook that lets a panic through, or an exit status that a script would take for another reason.
    #[test]
    fn every_end_has_its_status() {
        assert_eq!(status_of(Format::Text, || panic!("planted")), 70);
        assert_eq!(status_of(Format::Text, || Ok(())), 0);
        assert_eq!(status_of(Format::Text, || Err(Failure::message("planted"))), 1);
        assert_eq!(status_of(Format::Text, || Err(Failure::Said)), 1);
        assert_eq!(status_of(Format::Text, || Err(Failure::Usage("planted".into()))), 2);
        assert_eq!(status_of(Format::Json, || Err(Failure::NoGpu("planted".into()))), 3);
        assert_eq!(status_of(Format::Json, || Err(Failure::BrokenPipe)), 0);
        assert_eq!(status_of(Format::Text, || Err(Failure::Interrupted("planted".into()))), 130);
    }
}
