//! What the application does with files.

use std::path::{Path, PathBuf};
use std::time::Duration;

use eframe::egui;
use web_time::Instant;

use super::App;
use crate::document::State;
use crate::files::{Answer, Export, Keep, Kept, Purpose, Reload, Watch, Work, library_with, save};

/// What has changed is kept this long after it: not for every step of a slider.
const PATIENCE: Duration = Duration::from_millis(300);

impl App {
    /// Asks for a path.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn ask_path(&mut self, purpose: Purpose) {
        let name = Path::new(&self.document.state().name).to_owned();
        let stem = name.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let stem = stem.trim_end_matches(".scene.ron");
        self.ask_path_named(purpose, &format!("{stem}{}", purpose.extension()));
    }

    /// Asks for a path, of a file of this name if it is to be made.
    pub fn ask_path_named(&mut self, purpose: Purpose, name: &str) {
        let scene = Path::new(&self.document.state().name).to_owned();
        let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned);
        let here = || std::env::current_dir().unwrap_or_default();
        let folder = folder.unwrap_or_else(here);
        let path = match purpose {
            Purpose::Open | Purpose::Modules => format!("{}/", folder.display()),
            _ => folder.join(name).display().to_string(),
        };
        self.dialog = Some(crate::files::Dialog::new(purpose, path));
    }

    /// Has the browser ask where there is something to ask; what is saved goes among the downloads.
    #[cfg(target_arch = "wasm32")]
    pub fn ask_path(&mut self, purpose: Purpose) {
        let name = self.document.state().name.clone();
        let stem = name.rsplit('/').next().unwrap_or_default().trim_end_matches(".scene.ron");
        match purpose {
            Purpose::Open => {
                if let Err(error) = self.inbox.ask(&self.context) {
                    self.message = crate::files::web::said(&error);
                }
            }
            Purpose::Modules => self.message = "a page has no folders".to_owned(),
            purpose => self.chosen(purpose, format!("{stem}{}", purpose.extension())),
        }
    }

    /// Saves the scene where it is from; asks where that is nowhere, or something else is there by now.
    pub fn save(&mut self) {
        let name = self.document.state().name.clone();
        let is_file = Path::new(&name).is_file();
        if is_file && !self.is_other_on_disk() {
            return self.save_as(&name);
        }
        self.ask_path(Purpose::SaveAs);
        if is_file {
            self.message = format!("{name} was changed by another program");
        }
    }

    fn save_as(&mut self, path: &str) {
        // What is switched off is no part of the scene's file, and stays in the explorer.
        match save(path, self.document.state().text.as_bytes()) {
            Ok(at) => {
                self.message = format!("saved {at}");
                if cfg!(target_arch = "wasm32") {
                    // It is still what its link says.
                    let State { name, folder, .. } = self.document.state().clone();
                    self.document.saved(name, folder);
                    return;
                }
                let path = Path::new(path);
                self.document
                    .saved(path.display().to_string(), path.parent().unwrap_or(Path::new("")).to_owned());
                self.kept.remember(path);
                // Relative files are found from another folder now.
                self.seen = None;
            }
            Err(why) => self.message = why,
        }
    }

    /// Has modules come from a folder before the standard library, or from the latter alone.
    pub fn use_modules(&mut self, folder: Option<PathBuf>) {
        let Some(folder) = folder else {
            self.modules = None;
            self.kept.modules = None;
            self.lanes.desk.ask(Reload::Other(shadewright_modules::library()));
            return;
        };
        if self.watch(&folder) {
            self.lanes.desk.ask(Reload::Other(library_with(&folder)));
            self.kept.modules = Some(folder);
        }
    }

    /// Watches a folder of modules; whether that can be.
    pub(super) fn watch(&mut self, folder: &Path) -> bool {
        if !folder.is_dir() {
            self.message = format!("{} is no folder", folder.display());
            return false;
        }
        let context = self.context.clone();
        match Watch::new(folder, move || context.request_repaint()) {
            Ok(modules) => self.modules = Some(modules),
            Err(why) => {
                self.message = why;
                return false;
            }
        }
        true
    }

    /// What files ask for in every frame: the dialog, what is dropped, what has changed, what is to be kept.
    pub(super) fn mind_files(&mut self, context: &egui::Context) {
        let dropped = context.input(|input| input.raw.dropped_files.clone());
        #[cfg(not(target_arch = "wasm32"))]
        for file in dropped {
            self.open_file(file.path().to_owned());
        }
        #[cfg(target_arch = "wasm32")]
        {
            self.inbox.receive(dropped, context);
            self.take_inbox();
        }
        if self.modules.as_ref().is_some_and(Watch::take_change) {
            self.lanes.desk.ask(Reload::Again(self.catalog.clone()));
        }
        self.follow_file();
        self.keep();
    }

    /// Shows the dialog and does what was asked for.
    pub(crate) fn show_dialog(&mut self, context: &egui::Context) {
        let Some(mut dialog) = self.dialog.take() else { return };
        match dialog.show(context) {
            Answer::Open => self.dialog = Some(dialog),
            Answer::Cancelled => {}
            Answer::Chosen(path) => self.chosen(dialog.purpose, path),
        }
    }

    fn chosen(&mut self, purpose: Purpose, path: String) {
        match purpose {
            Purpose::Open => self.open_file(path.into()),
            Purpose::Code => crate::panels::save_code(self, &path),
            Purpose::Modules => self.use_modules(Some(path.into())),
            Purpose::SaveAs => self.save_as(&path),
            Purpose::Png | Purpose::Exr | Purpose::Wgsl | Purpose::Recipe => {
                let size = self.document.scene().scene().size;
                self.lanes.long.ask(Export {
                    shot: self.shot(),
                    purpose,
                    recipe: self.selected_recipe(),
                    size,
                    path,
                    reading: None,
                });
            }
        }
    }

    /// What a crash must not take.
    fn keep(&mut self) {
        let Some(path) = self.state_file.clone() else { return };
        let now = self.to_keep(self.viewport.painted.is_none() && self.problems.is_empty());
        let (last, since) = &mut self.keeping;
        if now == *last {
            return;
        }
        // That it is starting is known to whoever starts next even if this ends at once.
        let waited = since.get_or_insert_with(Instant::now).elapsed();
        if waited < PATIENCE && now.starting == last.starting {
            self.context.request_repaint_after(PATIENCE);
            return;
        }
        self.keeping = (now.clone(), None);
        self.lanes.desk.ask(Keep { path, kept: now });
    }

    /// Keeps what has changed, at once: the window closes.
    pub(super) fn keep_now(&mut self) {
        let Some(path) = self.state_file.clone() else { return };
        if let Err(why) = self.to_keep(false).write(&path) {
            log::error!("{why}");
        }
    }

    fn to_keep(&self, starting: bool) -> Kept {
        Kept {
            work: Some(Work::of(&self.document, &self.compare.pins.all)),
            earlier: self.others.unsaved(),
            selected: self.selected.clone(),
            tab: self.tabs.shown,
            starting,
            ..self.kept.clone()
        }
    }
}
