//! Which choices of a place are legal, and why others are not.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::{Catalog, Module, Recipe, Report};
use shadewright_runtime::scene::SceneFile;

use super::{Bench, Job, News, Progress, Shot, Step};
use crate::document::Document;
use crate::tree::{Row, choose};

/// Tries every module in a place.
pub struct Try {
    shot: Shot,
    row: Row,
    modules: Vec<Arc<Module>>,
    verdicts: Vec<Verdict>,
}

/// Whether a module can stand somewhere.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// The module.
    pub module: Arc<Module>,
    /// Why not; `None` where it can.
    pub reason: Option<String>,
}

/// What the modules of a category would be in a place.
#[derive(Clone, Debug)]
pub struct Legal {
    /// Of which shot.
    pub version: u64,
    /// Path of the place.
    pub path: String,
    /// In the order of the category.
    pub verdicts: Vec<Verdict>,
}

impl Try {
    /// The modules that fit a row.
    pub fn new(shot: Shot, row: Row) -> Self {
        let interface = row.interface().unwrap_or_default();
        let modules = crate::tree::options(&shot.catalog, interface).cloned().collect();
        Self {
            row,
            modules,
            verdicts: Vec::new(),
            shot,
        }
    }
}

impl Job for Try {
    fn kind(&self) -> &'static str {
        "choices"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        if let Some(module) = self.modules.get(self.verdicts.len()) {
            let reason = if self.row.list().is_some() {
                None
            } else {
                let mut document = Document::new(self.shot.scene.clone());
                let chosen = document.edit("try", |draft| choose(draft, &self.shot.catalog, &self.row, Some(module)));
                let legal = chosen.and_then(|()| links(&self.shot.catalog, document.scene()));
                legal.err().map(|report| reason(&report))
            };
            self.verdicts.push(Verdict {
                module: Arc::clone(module),
                reason,
            });
            return Step::Continue(Progress {
                what: "trying choices".into(),
                done: self.verdicts.len(),
                of: self.modules.len(),
            });
        }
        tell(News::Legal(Legal {
            version: self.shot.version,
            path: self.row.path.clone(),
            verdicts: std::mem::take(&mut self.verdicts),
        }));
        Step::Break(())
    }
}

/// Plans all that a scene needs, which finds what is wrong without writing or validating anything.
///
/// # Errors
/// What is wrong.
pub fn links(catalog: &Catalog, scene: &SceneFile) -> Result<(), Report> {
    let frame = scene.frame(catalog, Some([16, 16]))?;
    let mut planned: Vec<&shadewright_compiler::manifest::Node> = Vec::new();
    for material in frame.materials.iter().chain(&frame.display) {
        if !planned.contains(&&*material.recipe) {
            planned.push(&material.recipe);
            catalog.plan(&Recipe::from((*material.recipe).clone()), "main")?;
        }
    }
    Ok(())
}

/// The first error in one line, with what a rule says of itself.
pub fn reason(report: &Report) -> String {
    let Some(first) = report.diagnostics.first() else {
        return String::new();
    };
    let note = first.notes.first().map(|note| format!(": {note}")).unwrap_or_default();
    format!("{}{note}", first.message)
}
