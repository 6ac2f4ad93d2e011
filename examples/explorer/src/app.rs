//! The application: a document, the lanes that work for it, and what is on the screen.

mod compare;
mod disk;
mod files;
mod news;
mod opened;

use std::path::PathBuf;
use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use shadewright_compiler::manifest::Node;
use shadewright_compiler::{Catalog, Library, Report};
use shadewright_runtime::frame::Frame;
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::{Scene, SceneFile};

use opened::Others;
use web_time::Instant;

use crate::compare::{Compare, Pin};
use crate::document::{Document, Draft, step_path};
use crate::files::{Dialog, Kept, Watch};
use crate::panels::{self, Tabs, TreeState, Viewport};
use crate::tree::{Row, rows};
use crate::work::{Bench, Lane, Shot};

/// With what the explorer begins.
pub struct Start {
    /// What is edited.
    pub document: Document,
    /// Its pins.
    pub pins: Vec<Pin>,
    /// From where modules come.
    pub library: Arc<dyn Library>,
    /// What was kept of the last time.
    pub kept: Kept,
    /// Where that is kept; `None`: nowhere.
    pub state_file: Option<PathBuf>,
}

impl Start {
    /// With a scene and the standard library, keeping nothing.
    pub fn with(scene: SceneFile) -> Self {
        Self {
            document: Document::new(scene),
            pins: Vec::new(),
            library: shadewright_modules::library(),
            kept: Kept::default(),
            state_file: None,
        }
    }
}

/// The lanes: what one does keeps no other waiting.
pub struct Lanes {
    /// The viewport's picture.
    pub view: Lane,
    /// Short work without a GPU: choices, code.
    pub desk: Lane,
    /// Long work: references, sheets, reports.
    pub long: Lane,
}

/// Something that is wrong, as the diagnostics show it.
#[derive(Clone, Debug)]
pub enum Problem {
    /// With the scene or a module.
    Report(Report),
    /// With something else: what was being done, and why it failed.
    Other(String, String),
}

/// The explorer.
pub struct App {
    /// What is edited.
    pub document: Document,
    /// The library that everything is linked from.
    pub catalog: Arc<Catalog>,
    /// The device, which is the window's own.
    pub gpu: Gpu,
    /// The window's renderer.
    pub render_state: RenderState,
    /// Work beside the window.
    pub lanes: Lanes,
    /// Grows with every change of the document or the library.
    pub version: u64,
    /// The tree, as of that version.
    pub rows: Vec<Row>,
    /// Path of the row that is selected.
    pub selected: String,
    /// What is wrong with the present scene; empty where its picture is shown.
    pub problems: Vec<Problem>,
    /// The last thing that happened, for the status line.
    pub message: String,
    /// The picture and the camera.
    pub viewport: Viewport,
    /// What the tree remembers.
    pub tree: TreeState,
    /// What the tabs remember.
    pub tabs: Tabs,
    /// What is compared with what.
    pub compare: Compare,
    /// The dialog that is open.
    pub dialog: Option<Dialog>,
    /// What is kept for the next start.
    pub kept: Kept,
    /// The user's folder of modules.
    pub modules: Option<Watch>,
    pub(crate) context: egui::Context,
    others: Others,
    /// The file that is followed, and by what.
    on_disk: (String, Option<Watch>),
    /// Files that people have given to the page.
    #[cfg(target_arch = "wasm32")]
    pub(crate) inbox: crate::files::web::Inbox,
    state_file: Option<PathBuf>,
    /// What was kept last, and when something was found to be kept.
    keeping: (Kept, Option<Instant>),
    /// Document's version and the library, as of [`App::version`].
    seen: Option<(u64, Arc<Catalog>)>,
}

impl App {
    /// The explorer in a window.
    ///
    /// # Errors
    /// The library cannot be loaded.
    pub fn new(context: &egui::Context, render_state: RenderState, start: Start) -> Result<Self, Report> {
        let catalog = Arc::new(Catalog::load(start.library)?);
        let gpu = Gpu::from_parts(render_state.device.clone(), render_state.queue.clone());
        let lane = |name: &str| {
            let context = context.clone();
            Lane::new(name, Bench::new(gpu.clone()), move || context.request_repaint())
        };
        let mut kept = start.kept;
        let mut app = Self {
            others: Others::restored(std::mem::take(&mut kept.earlier), start.document.scene().files()),
            lanes: Lanes {
                view: lane("view"),
                desk: lane("desk"),
                long: lane("long"),
            },
            document: start.document,
            catalog,
            gpu,
            render_state,
            version: 0,
            rows: Vec::new(),
            selected: String::new(),
            problems: Vec::new(),
            message: String::new(),
            viewport: Viewport::default(),
            tree: TreeState::default(),
            compare: Compare::default(),
            tabs: Tabs {
                shown: kept.tab,
                ..Tabs::default()
            },
            dialog: None,
            keeping: (Kept::default(), None),
            kept,
            modules: None,
            on_disk: (String::new(), None),
            context: context.clone(),
            #[cfg(target_arch = "wasm32")]
            inbox: crate::files::web::Inbox::default(),
            state_file: start.state_file,
            seen: None,
        };
        app.compare.pins.all = start.pins;
        if !app.kept.selected.is_empty() {
            app.selected.clone_from(&app.kept.selected);
        }
        if let Some(folder) = app.kept.modules.clone() {
            app.watch(&folder);
        }
        Ok(app)
    }

    /// The scene at this moment.
    pub fn shot(&self) -> Shot {
        Shot {
            scene: self.document.scene().clone(),
            catalog: Arc::clone(&self.catalog),
            version: self.version,
        }
    }

    /// The row that is selected.
    pub fn selected_row(&self) -> Option<&Row> {
        self.rows.iter().find(|row| row.path == self.selected)
    }

    /// Changes the document, as one step. Where that cannot be, says so and changes nothing.
    pub fn edit(&mut self, what: &str, change: impl FnOnce(&mut Draft) -> Result<(), Report>) {
        let result = self.document.edit(what, change);
        self.edited(what, result);
    }

    /// The same, while a mouse button is held: edits of one name become one step.
    pub fn continued(&mut self, what: &str, change: impl FnOnce(&mut Draft) -> Result<(), Report>) {
        let result = self.document.continued(what, change);
        self.edited(what, result);
    }

    fn edited(&mut self, what: &str, result: Result<(), Report>) {
        match result {
            Ok(()) => what.clone_into(&mut self.message),
            Err(report) => self.message = format!("{what}: {}", crate::work::reason(&report)),
        }
    }

    /// The recipe of what is selected: the material that holds it, that of a whole object, or the display pass.
    pub fn selected_recipe(&self) -> Option<Node> {
        let frame = self.viewport.frame()?;
        let index = subject(self.document.scene().scene(), frame, &self.selected);
        let material = match index {
            Some(index) => frame.materials.get(index),
            None => frame.display.as_ref(),
        };
        Some((*material?.recipe).clone())
    }

    /// Edits another scene from now on.
    pub fn open(&mut self, scene: SceneFile) {
        self.open_document(Document::new(scene));
    }

    /// Links from another library, or the same one after an edit.
    pub fn set_catalog(&mut self, catalog: Arc<Catalog>) {
        self.catalog = catalog;
    }

    /// Brings everything up to date that follows from the document and the library.
    fn refresh(&mut self) {
        let now = (self.document.version(), Arc::clone(&self.catalog));
        let is_current = self
            .seen
            .as_ref()
            .is_some_and(|(version, catalog)| *version == now.0 && Arc::ptr_eq(catalog, &now.1));
        if is_current {
            return;
        }
        self.seen = Some(now);
        self.version += 1;
        self.rows = rows(self.document.scene(), &self.catalog, &self.document.state().parked);
        if self.selected.is_empty() {
            // The first thing that has more than a name.
            let rich = |row: &&Row| row.is_choice() && row.module.as_ref().is_some_and(|module| !module.manifest.slots.is_empty());
            let first = self.rows.iter().filter(|row| row.path.starts_with("materials")).find(rich);
            self.selected = first.map(|row| row.path.clone()).unwrap_or_default();
        }
        if self.selected_row().is_none() {
            // What was selected is gone: what is around it is the nearest.
            let around = self.rows.iter().filter(|row| self.selected.starts_with(&row.path));
            let nearest = around.max_by_key(|row| row.path.len()).or(self.rows.first());
            self.selected = nearest.map(|row| row.path.clone()).unwrap_or_default();
        }
    }
}

impl eframe::App for App {
    fn logic(&mut self, context: &egui::Context, _: &mut eframe::Frame) {
        self.hear();
        self.mind_files(context);
        self.refresh();
        self.ask();
        if context.input(|input| input.pointer.any_released() || !input.pointer.any_down() && input.keys_down.is_empty()) {
            self.document.close();
        }
    }

    fn on_exit(&mut self) {
        self.keep_now();
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        panels::show(self, ui);
        self.show_dialog(ui.ctx());
        // What the panels have changed is asked for at once, not with the next input.
        self.refresh();
        self.ask();
    }
}

impl App {
    /// Opens one of the scenes that come with the explorer.
    pub fn open_example(&mut self, example: &crate::scenes::Example) {
        match example.scene() {
            Ok(scene) => self.open(scene),
            Err(report) => self.message = crate::work::reason(&report),
        }
    }
}

/// Which of a frame's materials a path of the scene is about; `None`: the display pass.
///
/// A light or the pass is about the first material: it is in all of them.
pub fn subject(scene: &Scene, frame: &Frame, path: &str) -> Option<usize> {
    if path.starts_with("display") || path.starts_with("post") {
        return None;
    }
    let drawn = scene
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.visible || object.casts_shadow);
    let mut drawn = drawn.zip(&frame.draws);
    let is_meant = |index: usize, material: &str| {
        let name = format!("materials{}", step_path(material));
        let below = path
            .strip_prefix(&name)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
        below || path == format!("objects[{index}]")
    };
    let found = drawn.find(|((index, object), _)| is_meant(*index, &object.material));
    Some(found.map_or(0, |(_, draw)| draw.material))
}
