//! The scene's own file, which other programs may change, too.

use std::path::Path;
use std::sync::Arc;

use super::{App, Problem};
use crate::files::{Reread, Watch};

impl App {
    /// Watches the file of the present scene where it has one, and has it read when it has changed.
    pub(super) fn follow_file(&mut self) {
        let name = &self.document.state().name;
        let (followed, watch) = &mut self.on_disk;
        if followed != name {
            followed.clone_from(name);
            let path = Path::new(name);
            let context = self.context.clone();
            *watch = None;
            if path.is_file() {
                match Watch::new(path, move || context.request_repaint()) {
                    Ok(found) => *watch = Some(found),
                    Err(why) => log::warn!("{why}"),
                }
            }
        }
        if let Some(watch) = watch.as_ref().filter(|watch| watch.take_change()) {
            self.lanes.desk.ask(Reread {
                path: watch.path.clone(),
                files: self.document.scene().files().clone(),
            });
        }
    }

    /// Takes what the file holds now: as a step where nothing is lost by it.
    pub(super) fn take_disk(&mut self, path: &Path, text: Arc<str>) {
        let name = path.display();
        if Path::new(&self.document.state().name) != path {
            return;
        }
        if text == *self.document.saved_text() {
            // Mended, or saved here.
            if !self.problems.is_empty() {
                self.viewport.forget();
            }
        } else if self.document.is_changed() {
            self.message = format!("{name} was changed by another program too: saving will ask");
        } else if let Err(report) = self.document.take_over(&format!("Take over {name}"), text) {
            self.message = crate::work::reason(&report);
            self.problems = vec![Problem::Report(report)];
        } else {
            self.message = format!("{name} was changed by another program");
        }
    }

    /// Whether the file holds something else than what was read from it or saved.
    pub(super) fn is_other_on_disk(&self) -> bool {
        let there = std::fs::read(&self.document.state().name);
        there.is_ok_and(|bytes| bytes != self.document.saved_text().as_bytes())
    }
}
