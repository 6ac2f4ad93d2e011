//! The user's folder of modules, and what happens when a file in it changes.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use shadewright_compiler::{Catalog, Library};

use crate::work::{Bench, Job, News, Step};

/// A watched folder. Dropped, it is watched no more.
pub struct Modules {
    /// The folder.
    pub folder: PathBuf,
    changed: Arc<AtomicBool>,
    #[cfg(not(target_arch = "wasm32"))]
    _watcher: notify_debouncer_full::Debouncer<notify_debouncer_full::notify::RecommendedWatcher, notify_debouncer_full::RecommendedCache>,
}

#[cfg(not(target_arch = "wasm32"))]
impl Modules {
    /// Watches a folder. `wake` is called after a change, from another thread.
    ///
    /// # Errors
    /// It is no folder, or the system cannot watch it.
    pub fn watch(folder: &Path, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        use notify_debouncer_full::notify::{EventKind, RecursiveMode};
        /// An editor writes a file in several steps.
        const QUIET: std::time::Duration = std::time::Duration::from_millis(50);
        let said = |error: notify_debouncer_full::notify::Error| format!("{}: {error}", folder.display());
        if !folder.is_dir() {
            return Err(format!("{} is no folder", folder.display()));
        }
        let changed = Arc::new(AtomicBool::new(false));
        let seen = Arc::clone(&changed);
        let hear = move |events: notify_debouncer_full::DebounceEventResult| {
            // The explorer itself reads the files, and some systems tell that, too.
            let is_change = |kind: &EventKind| !matches!(kind, EventKind::Access(_));
            if events.is_ok_and(|events| events.iter().any(|event| is_change(&event.kind))) {
                seen.store(true, Ordering::Relaxed);
                wake();
            }
        };
        let mut watcher = notify_debouncer_full::new_debouncer(QUIET, None, hear).map_err(said)?;
        watcher.watch(folder, RecursiveMode::Recursive).map_err(said)?;
        Ok(Self {
            folder: folder.to_owned(),
            changed,
            _watcher: watcher,
        })
    }
}

#[cfg(target_arch = "wasm32")]
impl Modules {
    /// A page has no folders.
    ///
    /// # Errors
    /// Always.
    pub fn watch(folder: &Path, _: impl Fn() + Send + 'static) -> Result<Self, String> {
        Err(format!("{}: a page has no folders", folder.display()))
    }
}

impl Modules {
    /// The standard library with the folder's modules before it.
    pub fn library(folder: &Path) -> Arc<dyn Library> {
        let own = Arc::new(shadewright_modules::Folder::new(folder));
        Arc::new(shadewright_modules::Overlay(vec![own, shadewright_modules::library()]))
    }

    /// Whether something has changed since the last call.
    pub fn take_change(&self) -> bool {
        self.changed.swap(false, Ordering::Relaxed)
    }
}

/// Reads a library, again where there is a catalog of it.
pub enum Reload {
    /// The library of this catalog after an edit.
    Again(Arc<Catalog>),
    /// Another library.
    Other(Arc<dyn Library>),
}

impl Job for Reload {
    fn kind(&self) -> &'static str {
        "library"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let loaded = match self {
            Self::Again(catalog) => catalog.reload(),
            Self::Other(library) => Catalog::load(Arc::clone(library)),
        };
        tell(News::Library(loaded.map(Arc::new)));
        Step::Break(())
    }
}
