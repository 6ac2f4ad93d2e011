//! Comparing: asking the lanes for it, and taking in what they tell.

use std::sync::Arc;

use super::App;
use crate::compare::{Drawn, Mode, Other, Thumbnail, Told, features};
use crate::document::State;
use crate::panels::Tab;
use crate::work::{DrawBeside, DrawThumbnail, LoadTruths, PaintHeat, Refine, Sweep};

/// Largest width and height of an alternative's picture, pixels.
const SMALL: [u32; 2] = [160, 120];
/// Width and height of a pin's picture, pixels.
const THUMBNAIL: [u32; 2] = [160, 100];

impl App {
    /// Keeps the present permutation.
    pub fn pin(&mut self) {
        let features = features(self.document.scene(), &self.rows);
        let state = self.document.state().clone();
        let id = self.compare.pins.add(&state.name.clone(), state, features);
        let name = self.compare.pins.get(id).map(|pin| pin.name.clone()).unwrap_or_default();
        self.message = format!("pinned {name}");
    }

    /// Goes back to a whole text, as one step.
    pub fn go_to(&mut self, what: &str, state: &State) {
        let result = self.document.replace(what, state);
        self.edited(what, result);
    }

    /// Shows the present scene alone or compared.
    pub fn compare(&mut self, mode: Mode) {
        self.compare.mode = mode;
        // What is asked for is drawn.
        self.compare.is_refining |= mode == Mode::Error || mode != Mode::Alone && self.compare.other == Other::Reference;
    }

    /// Compares with something else, so that it is seen.
    pub fn compare_with(&mut self, other: Other) {
        self.compare.other = other;
        if matches!(self.compare.mode, Mode::Alone | Mode::Error) {
            self.compare.mode = Mode::Split;
        }
        self.compare.is_refining |= other == Other::Reference;
    }

    /// Width and height of an alternative's picture: of the viewport's shape.
    fn small(&self) -> [u32; 2] {
        let size = self.viewport.painted.as_ref().map_or([4, 3], |painted| painted.frame.size);
        let [width, height] = size.map(|side| f64::from(side.max(1)));
        let shrink = (f64::from(SMALL[0]) / width).min(f64::from(SMALL[1]) / height);
        [width, height].map(|side| ((side * shrink) as u32).max(16))
    }

    /// The picture that is shown: its version and size.
    fn first(&self) -> Option<(u64, [u32; 2])> {
        let painted = self.viewport.painted.as_ref()?;
        Some((painted.version, painted.frame.size))
    }

    /// Asks for what comparing shows and is not there yet.
    pub(super) fn ask_to_compare(&mut self) {
        // A pin that was removed cannot be compared with.
        if let Other::Pin(id) = self.compare.other
            && self.compare.pins.get(id).is_none()
        {
            self.compare.other = Other::Reference;
        }
        self.ask_for_thumbnail();
        self.ask_for_truth();
        self.ask_for_second();
        self.ask_for_heat();
        self.ask_for_alternatives();
    }

    fn ask_for_thumbnail(&mut self) {
        if self.viewport.painted.is_none() || self.lanes.view.is_busy("pin") {
            return;
        }
        let Some(pin) = self.compare.pins.without_picture() else { return };
        let (id, state) = (pin.id, pin.state.clone());
        self.lanes.view.ask(DrawThumbnail {
            pin: id,
            state,
            files: self.document.scene().files().clone(),
            catalog: Arc::clone(&self.catalog),
            size: THUMBNAIL,
            reading: None,
        });
        self.compare.pins.pictures.insert(id, Thumbnail::Asked);
    }

    fn wants_alternatives(&self) -> bool {
        matches!(self.tabs.shown, Tab::Pareto | Tab::Sheet)
    }

    fn ask_for_truth(&mut self) {
        let is_wanted = self.compare.is_refining || self.wants_alternatives();
        let known = self.compare.truths.as_ref().map(|(catalog, _)| catalog);
        let is_same = |catalog: Option<&Arc<_>>| catalog.is_some_and(|catalog| Arc::ptr_eq(catalog, &self.catalog));
        if is_wanted && !is_same(known) && !is_same(self.compare.asked.truths.as_ref()) {
            self.lanes.desk.ask(LoadTruths(Arc::clone(&self.catalog)));
            self.compare.asked.truths = Some(Arc::clone(&self.catalog));
        }
        if !self.compare.is_refining {
            if self.compare.asked.refine.take().is_some() {
                self.lanes.long.cancel("reference");
            }
            return;
        }
        let Some(truths) = self.truths() else { return };
        // Where the present scene cannot be drawn, its truth cannot.
        let Some(size) = self.viewport.full_size().filter(|_| self.problems.is_empty()) else {
            return;
        };
        if self.viewport.painted.is_some() && self.compare.asked.refine != Some((self.version, size)) {
            self.compare.asked.refine = Some((self.version, size));
            self.lanes.long.ask(Refine::new(self.shot(), size, truths));
        }
    }

    fn truths(&self) -> Option<Arc<crate::compare::Truths>> {
        let (catalog, truths) = self.compare.truths.as_ref()?;
        Arc::ptr_eq(catalog, &self.catalog).then(|| Arc::clone(truths))
    }

    /// The pin's picture, and numbers of the two.
    fn ask_for_second(&mut self) {
        let Some(first) = self.first() else { return };
        let mode = self.compare.mode;
        let pin = match self.compare.other {
            Other::Pin(id) if matches!(mode, Mode::Split | Mode::Difference) => self.compare.pins.get(id),
            _ => None,
        };
        let drawn = pin.map(|pin| Drawn {
            pin: pin.id,
            camera: self.document.scene().get("camera").map(str::to_owned),
            size: first.1,
            library: Arc::as_ptr(&self.catalog) as usize,
        });
        let numbers = self.compare.probe || drawn.is_some() && mode == Mode::Difference;
        let key = (first, drawn.clone(), numbers);
        if (drawn.is_none() && !numbers) || self.compare.asked.beside.as_ref() == Some(&key) {
            return;
        }
        let there = |drawn: &Drawn| {
            let beside = self.compare.beside.as_ref()?;
            let (known, targets) = beside.second.as_ref()?;
            (known == drawn).then(|| targets.clone())
        };
        let second = drawn.zip(pin).map(|(drawn, pin)| {
            let targets = there(&drawn);
            (drawn, pin.state.clone(), targets)
        });
        let painted = self.viewport.painted.as_ref().filter(|_| numbers);
        self.lanes.view.ask(DrawBeside {
            first,
            values_of: painted.map(|painted| painted.targets.clone()),
            second,
            files: self.document.scene().files().clone(),
            catalog: Arc::clone(&self.catalog),
            sent: None,
        });
        self.compare.asked.beside = Some(key);
    }

    fn ask_for_heat(&mut self) {
        if !matches!(self.compare.mode, Mode::Difference | Mode::Error) {
            return;
        }
        let Some(errors) = self.compare.errors().map(Arc::clone) else {
            return;
        };
        let full = self.compare.full;
        let is_asked = self
            .compare
            .asked
            .heat
            .as_ref()
            .is_some_and(|(known, at)| Arc::ptr_eq(known, &errors) && *at == full);
        if !is_asked {
            self.lanes.desk.ask(PaintHeat {
                errors: Arc::clone(&errors),
                full,
            });
            self.compare.asked.heat = Some((errors, full));
        }
    }

    fn ask_for_alternatives(&mut self) {
        if !self.wants_alternatives() || self.document.is_open() || !self.problems.is_empty() || self.viewport.painted.is_none() {
            return;
        }
        let Some(row) = self.selected_row().filter(|row| row.is_choice()).cloned() else {
            return;
        };
        let Some(truths) = self.truths() else { return };
        let space = self.compare.space.clone();
        let key = (self.version, row.path.clone(), space.clone());
        if self.compare.asked.sweep.as_ref() == Some(&key) {
            return;
        }
        self.compare.asked.sweep = Some(key);
        let (shot, size) = (self.shot(), self.small());
        let sweep = if space.is_empty() {
            Ok(Sweep::modules(shot, row, size, truths))
        } else {
            read(&space)
                .and_then(|text| Sweep::space(shot, row, size, truths, &space, &text).map_err(|report| crate::work::reason(&report)))
        };
        match sweep {
            Ok(sweep) => self.lanes.long.ask(sweep),
            Err(message) => {
                self.compare.problem = format!("{space}: {message}");
                self.compare.sweep = None;
            }
        }
    }

    /// Takes in what a job of comparing has told.
    pub(super) fn take_comparison(&mut self, told: Told) {
        let compare = &mut self.compare;
        match told {
            Told::Truths(catalog, Ok(truths)) => compare.truths = Some((catalog, truths)),
            Told::Truths(_, Err(message)) => compare.problem = format!("experiments: {message}"),
            Told::Beside(beside) => {
                compare.problem.clear();
                let texture = beside.second.as_ref().and_then(|(_, targets)| targets.display.as_ref());
                if let Some(texture) = texture {
                    compare.pin_screen.show(&self.render_state, texture);
                }
                compare.beside = Some(beside);
            }
            Told::Reference { version, replaced, left } => compare.made = Some((version, replaced, left)),
            Told::Refined(refined) => {
                if refined.version == self.version && compare.is_refining {
                    compare.problem.clear();
                    compare.truth_screen.show(&self.render_state, &refined.display);
                    compare.refined = Some(refined);
                }
            }
            Told::Heat(image) => compare.new_heat = Some(image),
            Told::Thumbnail(pin, drawn) => {
                // It may be gone by now.
                if compare.pins.get(pin).is_some() {
                    let picture = drawn.map_or(Thumbnail::Failed, Thumbnail::Drawn);
                    compare.pins.pictures.insert(pin, picture);
                }
            }
            Told::Sweep(view) => {
                compare.problem.clear();
                compare.tiles.clear();
                compare.sweep = Some(view);
            }
            Told::Alternative(alternative) => {
                if let Some(sweep) = &mut compare.sweep {
                    sweep.alternatives.push(Arc::from(alternative));
                }
            }
            Told::Sheet(Ok(message) | Err(message)) => self.message = message,
            Told::Failed(what, message) => compare.problem = format!("{what}: {message}"),
        }
    }
}

/// Text of a space's file.
#[cfg(not(target_arch = "wasm32"))]
fn read(path: &str) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| error.to_string())
}

/// There are no files.
#[cfg(target_arch = "wasm32")]
fn read(_: &str) -> Result<String, String> {
    Err("a page has no files".to_owned())
}
