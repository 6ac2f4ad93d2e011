//! A folder or a file that other programs change.

use std::path::{Path, PathBuf};
#[cfg(not(target_arch = "wasm32"))]
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is watched. Dropped, it is watched no more.
pub struct Watch {
    /// The folder or file.
    pub path: PathBuf,
    #[cfg(not(target_arch = "wasm32"))]
    changed: Arc<AtomicBool>,
    #[cfg(target_arch = "wasm32")]
    changed: AtomicBool,
    #[cfg(not(target_arch = "wasm32"))]
    _watcher: notify_debouncer_full::Debouncer<notify_debouncer_full::notify::RecommendedWatcher, notify_debouncer_full::RecommendedCache>,
}

#[cfg(not(target_arch = "wasm32"))]
impl Watch {
    /// Watches a folder with all that is in it, or a file. `wake` is called after a change, from another thread.
    ///
    /// # Errors
    /// It is not there, or the system cannot watch it.
    pub fn new(path: &Path, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        use notify_debouncer_full::notify::{EventKind, RecursiveMode};
        /// An editor writes a file in several steps.
        const QUIET: std::time::Duration = std::time::Duration::from_millis(50);
        let said = |error: notify_debouncer_full::notify::Error| format!("{}: {error}", path.display());
        // Editors put a new file in the place of the old one, so it is its folder that is watched.
        let whole = std::path::absolute(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let (folder, mode, file) = match (whole.is_dir(), whole.parent()) {
            (false, Some(folder)) => (folder, RecursiveMode::NonRecursive, whole.file_name().map(ToOwned::to_owned)),
            _ => (whole.as_path(), RecursiveMode::Recursive, None),
        };
        let changed = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&changed);
        let hear = move |events: notify_debouncer_full::DebounceEventResult| {
            let is_meant = |path: &PathBuf| file.is_none() || path.file_name() == file.as_deref();
            // The explorer itself reads the files, and some systems tell that, too.
            let is_change = |kind: &EventKind| !matches!(kind, EventKind::Access(_));
            if events.is_ok_and(|events| {
                events
                    .iter()
                    .any(|event| is_change(&event.kind) && event.paths.iter().any(is_meant))
            }) {
                seen.store(true, Ordering::Relaxed);
                wake();
            }
        };
        let mut watcher = notify_debouncer_full::new_debouncer(QUIET, None, hear).map_err(said)?;
        watcher.watch(folder, mode).map_err(said)?;
        Ok(Self {
            path: path.to_owned(),
            changed,
            _watcher: watcher,
        })
    }
}

#[cfg(target_arch = "wasm32")]
impl Watch {
    /// A page has no files of its own.
    ///
    /// # Errors
    /// Always.
    pub fn new(path: &Path, _: impl Fn() + Send + 'static) -> Result<Self, String> {
        Err(format!("{}: a page has no folders", path.display()))
    }
}

impl Watch {
    /// Whether something has changed since the last call.
    pub fn take_change(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
    }
}
