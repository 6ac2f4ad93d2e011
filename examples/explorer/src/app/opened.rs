//! Scenes that were open before and after the present one. Opening is a step like others: undo goes back to the scene before as it was left, with its
//! own steps and pins, so nothing unsaved is lost.

use super::App;
use crate::compare::Pin;
use crate::document::Document;
use crate::files::Work;

/// Most scenes on either side of the present one.
const MOST: usize = 16;

/// A scene that is not the present one.
struct Opened {
    document: Document,
    pins: Vec<Pin>,
}

/// All of them; of each side the nearest is the last.
#[derive(Default)]
pub(super) struct Others {
    before: Vec<Opened>,
    after: Vec<Opened>,
}

impl Others {
    /// As they were left. What cannot be read any more is left out, and logged.
    pub fn restored(earlier: Vec<Work>, files: &shadewright_runtime::scene::Files) -> Self {
        let restored = earlier.into_iter().filter_map(|Work { state, saved, pins }| {
            Document::restored(state, saved, files)
                .map(|document| Opened { document, pins })
                .map_err(|report| log::warn!("{}", report.render()))
                .ok()
        });
        Self {
            before: restored.collect(),
            after: Vec::new(),
        }
    }

    /// Those with something that is nowhere else.
    pub fn unsaved(&self) -> Vec<Work> {
        let all = self.before.iter().chain(self.after.iter().rev());
        all.map(|opened| Work::of(&opened.document, &opened.pins))
            .filter(Work::is_unsaved)
            .collect()
    }
}

impl App {
    /// Edits this from now on.
    pub fn open_document(&mut self, document: Document) {
        let left = self.swap(Opened {
            document,
            pins: Vec::new(),
        });
        let Others { before, after } = &mut self.others;
        before.extend(after.drain(..).rev());
        before.push(left);
        // What has nothing unsaved is the first to go.
        while before.len() > MOST {
            let is_saved = |opened: &Opened| !Work::of(&opened.document, &opened.pins).is_unsaved();
            let first = before.iter().position(is_saved).unwrap_or(0);
            before.remove(first);
        }
    }

    /// Takes back the last step; where there is none, goes back to the scene that was open before.
    pub fn undo(&mut self) {
        if self.document.can_undo().is_some() {
            self.document.undo();
        } else if let Some(earlier) = self.others.before.pop() {
            let left = self.swap(earlier);
            self.others.after.push(left);
        }
    }

    /// Does again what was taken back.
    pub fn redo(&mut self) {
        if self.document.can_redo().is_some() {
            self.document.redo();
        } else if let Some(later) = self.others.after.pop() {
            let left = self.swap(later);
            self.others.before.push(left);
        }
    }

    /// What would be taken back.
    pub fn can_undo(&self) -> Option<String> {
        let opening = || self.others.before.last().map(|_| opening(&self.document));
        self.document.can_undo().map(str::to_owned).or_else(opening)
    }

    /// What would be done again.
    pub fn can_redo(&self) -> Option<String> {
        let opening = || self.others.after.last().map(|later| opening(&later.document));
        self.document.can_redo().map(str::to_owned).or_else(opening)
    }

    /// Puts another scene in the place of the present one, and gives that.
    fn swap(&mut self, opened: Opened) -> Opened {
        let document = std::mem::replace(&mut self.document, opened.document);
        let pins = std::mem::take(&mut self.compare.pins.all);
        self.seen = None;
        self.viewport.forget();
        self.compare.forget(&self.render_state);
        self.compare.pins.all = opened.pins;
        self.message = format!("opened {}", self.document.state().name);
        Opened { document, pins }
    }
}

/// The step that opened a scene.
fn opening(document: &Document) -> String {
    format!("opening {}", document.state().name)
}
