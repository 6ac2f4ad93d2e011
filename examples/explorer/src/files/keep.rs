//! What is kept from one start to the next, so that a crash loses nothing.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::compare::Pin;
use crate::document::{Document, State};
use crate::panels::Tab;
use crate::work::{Bench, Job, News, Step};

/// Most files that are remembered.
const MOST_RECENT: usize = 10;

/// A scene that somebody works on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Work {
    /// As it was left.
    pub state: State,
    /// The text that is on disk under its name.
    pub saved: Arc<str>,
    /// Its pins.
    pub pins: Vec<Pin>,
}

/// What is kept.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// The scene as it was left.
    pub work: Option<Work>,
    /// Scenes with something unsaved that were open before, the last one last.
    pub earlier: Vec<Work>,
    /// Path of the row that was selected.
    pub selected: String,
    /// The tab that was shown.
    pub tab: Tab,
    /// Scenes opened and saved, the last one first.
    pub recent: Vec<PathBuf>,
    /// The user's folder of modules.
    pub modules: Option<PathBuf>,
    /// A start has not come to its first picture: what it began with may have ended it.
    pub starting: bool,
}

/// Writes it.
pub struct Keep {
    /// The file.
    pub path: PathBuf,
    /// What is kept.
    pub kept: Kept,
}

/// The file in which this system's programs keep such things; `None` where the system names no place.
#[cfg(not(target_arch = "wasm32"))]
pub fn state_file() -> Option<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let home = || set("HOME");
    let folder = if cfg!(windows) {
        set("LOCALAPPDATA")?
    } else if cfg!(target_os = "macos") {
        home()?.join("Library/Application Support")
    } else {
        set("XDG_STATE_HOME").or_else(|| Some(home()?.join(".local/state")))?
    };
    Some(folder.join("shadewright/explorer.json"))
}

/// A page keeps its state in its address.
#[cfg(target_arch = "wasm32")]
pub fn state_file() -> Option<PathBuf> {
    None
}

impl Work {
    /// A document with its pins.
    pub fn of(document: &Document, pins: &[Pin]) -> Self {
        Self {
            state: document.state().clone(),
            saved: Arc::clone(document.saved_text()),
            pins: pins.to_vec(),
        }
    }

    /// Whether something of it is nowhere else.
    pub fn is_unsaved(&self) -> bool {
        self.state.text != self.saved || !self.state.parked.is_empty() || !self.pins.is_empty()
    }
}

impl Kept {
    /// What was kept; nothing where there is no such file, or it cannot be read.
    pub fn read(path: &Path) -> Self {
        let text = std::fs::read_to_string(path).unwrap_or_default();
        if text.is_empty() {
            return Self::default();
        }
        serde_json::from_str(&text).unwrap_or_else(|error| {
            log::warn!("{}: {error}", path.display());
            Self::default()
        })
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// Says why not.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn write(&self, path: &Path) -> Result<(), String> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        shadewright_runtime::image::write_atomically(path, text.as_bytes()).map_err(|error| error.to_string())
    }

    /// A page has no file.
    ///
    /// # Errors
    /// Never.
    #[cfg(target_arch = "wasm32")]
    pub fn write(&self, _: &Path) -> Result<(), String> {
        Ok(())
    }

    /// Something else is begun with: what was left is to go back to.
    pub fn put_aside(&mut self) {
        self.earlier.extend(self.work.take().filter(Work::is_unsaved));
    }

    /// Puts a file before the others that are remembered.
    pub fn remember(&mut self, path: &Path) {
        self.recent.retain(|other| other != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(MOST_RECENT);
    }
}

impl Job for Keep {
    fn kind(&self) -> &'static str {
        "keep"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        if let Err(message) = self.kept.write(&self.path) {
            tell(News::Failed {
                what: "keeping the state",
                message,
            });
        }
        Step::Break(())
    }
}
