//! The application: a document, the lanes that work for it, and what is on the screen.

mod compare;
mod news;

use std::sync::Arc;

use eframe::egui;
use eframe::egui_wgpu::RenderState;
use shadewright_compiler::{Catalog, Library, Report};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::SceneFile;

use crate::compare::Compare;
use crate::document::{Document, Draft};
use crate::panels::{self, Tabs, TreeState, Viewport};
use crate::tree::{Row, rows};
use crate::work::{Bench, Lane, Shot};

/// With what the explorer begins.
pub struct Start {
    /// What is edited.
    pub document: Document,
    /// From where modules come.
    pub library: Arc<dyn Library>,
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
        Ok(Self {
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
            selected: "materials".to_owned(),
            problems: Vec::new(),
            message: String::new(),
            viewport: Viewport::default(),
            tree: TreeState::default(),
            tabs: Tabs::default(),
            compare: Compare::default(),
            seen: None,
        })
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

    /// Edits another scene from now on. The one before is kept where it was saved only.
    pub fn open(&mut self, scene: SceneFile) {
        self.message = format!("opened {}", scene.source().name);
        self.document = Document::new(scene);
        self.seen = None;
        self.viewport.forget();
        self.compare.forget(&self.render_state);
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
        self.refresh();
        self.ask();
        if context.input(|input| input.pointer.any_released() || !input.pointer.any_down() && input.keys_down.is_empty()) {
            self.document.close();
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui, _: &mut eframe::Frame) {
        panels::show(self, ui);
        // What the panels have changed is asked for at once, not with the next input.
        self.refresh();
        self.ask();
    }
}

impl App {
    /// Opens one of the scenes that come with the explorer.
    pub fn open_example(&mut self, example: &crate::scenes::Example) {
        match SceneFile::parse(example.name, example.text, std::path::Path::new("examples/scenes")) {
            Ok(scene) => self.open(scene),
            Err(report) => self.message = crate::work::reason(&report),
        }
    }
}
