//! Progress on a terminal, and Ctrl-C.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Set by Ctrl-C; the handler is the whole process's.
static INTERRUPTED: AtomicBool = AtomicBool::new(false);
static HANDLER: Once = Once::new();

/// A long work in progress.
pub struct Watch {
    bar: ProgressBar,
}

impl Watch {
    /// Begins to show progress, where standard error is a terminal, and to take Ctrl-C for a wish to stop in good order. `what` is counted.
    pub fn new(number: u128, what: &str) -> Self {
        HANDLER.call_once(|| {
            // Where there can be no handler the process just ends: files are renamed into place, so none is half written.
            let _ = ctrlc::set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
        });
        let length = u64::try_from(number).unwrap_or(u64::MAX);
        let bar = ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(&format!("{{bar:40}} {{human_pos}}/{{human_len}} {what}, {{eta}} left {{msg}}")) {
            bar.set_style(style);
        }
        Self { bar }
    }

    /// Set when somebody presses Ctrl-C.
    pub fn cancel(&self) -> &'static AtomicBool {
        &INTERRUPTED
    }

    /// One more is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// So many of so many are done, and this is next.
    pub fn at(&self, done: usize, of: usize, next: &str) {
        self.bar.set_length(of as u64);
        self.bar.set_position(done as u64);
        self.bar.set_message(next.to_owned());
    }

    /// All is done.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
