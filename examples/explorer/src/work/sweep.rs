//! All that could stand in a slot, drawn small: what each gets wrong, and what it costs.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::{Catalog, Module, Report};
use shadewright_report::data::cost_of;
use shadewright_runtime::frame::{DisplayReading, Frame, Renderer};
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::naga::ShaderStage;
use shadewright_runtime::scene::SceneFile;

use super::beside::failed;
use super::{Bench, Job, News, Progress, Reading, Shot, Step, links, reason};
use crate::compare::{Errors, SweepView, Told, Truths, Values, reference};
use crate::document::Draft;
use crate::tree::{Row, choose, options, rows};

/// Most alternatives that are drawn.
pub const MOST: usize = 64;
/// Frames that are timed, after one that warms up. An odd number, for its middle.
const TIMED: usize = 3;

/// What could stand in a slot.
#[derive(Clone, Debug)]
pub enum Change {
    /// A module.
    Module(Arc<Module>),
    /// RON of a recipe.
    Recipe(String),
}

impl Change {
    /// Puts it there.
    ///
    /// # Errors
    /// What comes out is no scene.
    pub fn put(&self, draft: &mut Draft, catalog: &Catalog, row: &Row) -> Result<(), Report> {
        match self {
            Self::Module(module) => choose(draft, catalog, row, Some(module)),
            Self::Recipe(text) => draft.set(&row.above, &row.path, text),
        }
    }
}

/// One of a slot's alternatives.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Its name.
    pub name: String,
    /// What it is.
    pub change: Change,
    /// Whether it stands there now.
    pub is_present: bool,
    /// What the stored report says of it: experiments with their model errors, RMS.
    pub stored: Vec<(String, f64)>,
    /// What it does; or why it cannot stand there.
    pub outcome: Result<Measured, String>,
}

/// What an alternative does.
#[derive(Clone, Debug)]
pub struct Measured {
    /// As it is shown, RGBA.
    pub pixels: Vec<u8>,
    /// Its error in words.
    pub summary: String,
    /// Its error, RMS.
    pub rms: f64,
    /// Time of the scene pass over that of the present choice; none without timestamps.
    pub ratio: Option<f64>,
    /// Weighted operations of all the scene's programs for a pixel, loops' bodies once.
    pub operations: f64,
}

/// With what alternatives are compared.
struct Base {
    /// The picture that errors are against, on its way.
    sent: Reading,
    /// It, when it has come.
    truth: Option<Values>,
    /// The present scene.
    present: Frame,
}

/// An alternative that is drawn.
struct Drawn {
    frame: Frame,
    sent: Reading,
    values: Option<Values>,
    /// None of a scene that is not made for the screen.
    display: Option<DisplayReading>,
}

/// Draws alternatives.
pub struct Sweep {
    shot: Shot,
    row: Row,
    size: [u32; 2],
    truths: Arc<Truths>,
    candidates: Vec<(String, Change)>,
    base: Option<Base>,
    /// The picture of the next one, on its way.
    drawn: Option<Drawn>,
    done: usize,
    cut: u128,
}

impl Sweep {
    /// The modules that fit a row.
    pub fn modules(shot: Shot, row: Row, size: [u32; 2], truths: Arc<Truths>) -> Self {
        let interface = row.interface().unwrap_or_default();
        let all = options(&shot.catalog, interface).map(|module| (module.name.clone(), Change::Module(Arc::clone(module))));
        let mut candidates: Vec<_> = all.collect();
        let cut = candidates.len().saturating_sub(MOST) as u128;
        candidates.truncate(MOST);
        Self {
            shot,
            row,
            size,
            truths,
            candidates,
            base: None,
            drawn: None,
            done: 0,
            cut,
        }
    }

    /// The permutations of a space.
    ///
    /// # Errors
    /// It is no space, or an empty one.
    pub fn space(shot: Shot, row: Row, size: [u32; 2], truths: Arc<Truths>, name: &str, text: &str) -> Result<Self, Report> {
        let space = shadewright_compiler::space::Space::parse(&shot.catalog, name, text)?;
        space.not_empty()?;
        let count = space.count()?;
        let bare = |name: &str| name.rsplit('/').next().unwrap_or(name).to_owned();
        let candidates = space.iter()?.take(MOST).map(|found| {
            let chosen = found.choices.iter().map(|choice| bare(&choice.chosen));
            let mut words = vec![bare(&found.recipe.root.module)];
            words.extend(chosen);
            words.dedup();
            (words.join(", "), Change::Recipe(found.recipe.source.text.clone()))
        });
        Ok(Self {
            candidates: candidates.collect(),
            cut: count.saturating_sub(MOST as u128),
            ..Self::modules(shot.clone(), row, size, truths)
        })
    }

    fn with(&self, change: &Change) -> Result<SceneFile, Report> {
        self.with_in(&self.row, change)
    }

    fn with_in(&self, row: &Row, change: &Change) -> Result<SceneFile, Report> {
        let mut draft = Draft {
            scene: self.shot.scene.clone(),
            parked: Vec::new(),
        };
        change.put(&mut draft, &self.shot.catalog, row)?;
        links(&self.shot.catalog, &draft.scene)?;
        Ok(draft.scene)
    }

    /// The scene that errors are against, and what it is called.
    fn truth(&self) -> (SceneFile, String) {
        if let Some(present) = &self.row.module {
            let own = self.truths.of(present);
            if let Some(truth) = own
                && let Ok(scene) = self.with(&Change::Module(Arc::clone(&truth.module)))
            {
                return (scene, format!("{} in this slot, true by {}", truth.module.name, truth.experiment));
            }
            if own.is_none() && self.truths.is_true(present) {
                let scene = self.shot.scene.clone();
                return (scene, format!("{} in this slot, which is called true", present.name));
            }
        }
        if let Some(found) = self.truth_around() {
            return found;
        }
        let made = reference(&self.shot.scene, &self.shot.catalog, &self.truths);
        if !made.replaced.is_empty() && links(&self.shot.catalog, &made.scene).is_ok() {
            return (made.scene, "the scene's reference: nothing is called true in this slot".to_owned());
        }
        let present = self.row.module.as_ref().map_or("what stands there", |module| &module.name);
        (
            self.shot.scene.clone(),
            format!("the present choice, {present}: nothing is called true here"),
        )
    }

    /// The scene with what is true in the nearest place around the slot for which something is called true.
    fn truth_around(&self) -> Option<(SceneFile, String)> {
        let rows = rows(&self.shot.scene, &self.shot.catalog, &[]);
        let around = |row: &&Row| self.row.path.strip_prefix(&row.path).is_some_and(|rest| rest.starts_with('.'));
        let mut around: Vec<&Row> = rows.iter().filter(|row| row.is_choice()).filter(around).collect();
        around.sort_by_key(|row| std::cmp::Reverse(row.path.len()));
        around.into_iter().find_map(|row| {
            let truth = self.truths.of(row.module.as_ref()?)?;
            let scene = self.with_in(row, &Change::Module(Arc::clone(&truth.module))).ok()?;
            let text = format!(
                "{} in {}, around this slot, true by {}",
                truth.module.name, row.path, truth.experiment
            );
            Some((scene, text))
        })
    }

    fn begin(&mut self, bench: &mut Bench) -> Result<SweepView, RuntimeError> {
        let (scene, against) = self.truth();
        let frame = scene.frame(&self.shot.catalog, Some(self.size))?;
        let targets = bench.renderer(&self.shot.catalog).render(&frame)?;
        self.base = Some(Base {
            sent: Reading::start(bench.gpu(), &targets)?,
            truth: None,
            present: self.shot.scene.frame(&self.shot.catalog, Some(self.size))?,
        });
        Ok(SweepView {
            version: self.shot.version,
            path: self.row.path.clone(),
            present: self.row.module.as_ref().map(|module| module.name.clone()).unwrap_or_default(),
            against,
            size: self.size,
            of: self.candidates.len(),
            cut: self.cut,
            alternatives: Vec::new(),
        })
    }

    fn draw(&self, bench: &mut Bench, change: &Change) -> Result<Drawn, RuntimeError> {
        let frame = self.with(change)?.frame(&self.shot.catalog, Some(self.size))?;
        let targets = bench.renderer(&self.shot.catalog).render(&frame)?;
        Ok(Drawn {
            frame,
            sent: Reading::start(bench.gpu(), &targets)?,
            values: None,
            display: targets.start_read_display(bench.gpu())?,
        })
    }

    /// What an alternative does; none while its picture has not come.
    fn measure(&mut self, bench: &mut Bench, change: &Change, truth: &Values, present: &Frame) -> Result<Option<Measured>, RuntimeError> {
        let mut drawn = match self.drawn.take() {
            Some(drawn) => drawn,
            None => self.draw(bench, change)?,
        };
        if drawn.values.is_none() {
            drawn.values = drawn.sent.take(bench.gpu())?;
        }
        let (Some(found), Some(pixels)) = (&drawn.values, pixels(&mut drawn.display, bench.gpu())?) else {
            self.drawn = Some(drawn);
            return Ok(None);
        };
        let renderer = bench.renderer(&self.shot.catalog);
        let errors = Errors::of(found, truth).unwrap_or_default();
        Ok(Some(Measured {
            pixels,
            summary: errors.summary,
            rms: errors.rms,
            ratio: ratio(renderer, &drawn.frame, present)?,
            operations: operations(renderer, &drawn.frame)?,
        }))
    }
}

/// A picture as it is shown, if it has come; nothing of one that is not made for the screen.
fn pixels(display: &mut Option<DisplayReading>, gpu: &Gpu) -> Result<Option<Vec<u8>>, RuntimeError> {
    match display {
        None => Ok(Some(Vec::new())),
        Some(reading) => reading.take(gpu).transpose(),
    }
}

/// Time of a frame's scene pass on the GPU over another's: medians of several in turn, so that a busy moment is both's, after one of each that warms up.
/// None where the device has no timestamps, and on a page, where nobody may wait for them.
fn ratio(renderer: &mut Renderer, frame: &Frame, present: &Frame) -> Result<Option<f64>, RuntimeError> {
    if cfg!(target_arch = "wasm32") {
        return Ok(None);
    }
    let mut times = [Vec::new(), Vec::new()];
    for _ in 0..=TIMED {
        for (frame, times) in [frame, present].into_iter().zip(&mut times) {
            let Some(time) = time(renderer, frame)? else { return Ok(None) };
            times.push(time);
        }
    }
    let [time, present] = times.map(|mut times| {
        times.remove(0);
        times.sort_by(f64::total_cmp);
        times[TIMED / 2]
    });
    Ok((present > 0.0).then(|| time / present))
}

/// Time of a frame's scene pass on the GPU, ns.
fn time(renderer: &mut Renderer, frame: &Frame) -> Result<Option<f64>, RuntimeError> {
    // Of frames before.
    while renderer.take_times().is_some() {}
    renderer.render(frame)?;
    Ok(renderer.wait_for_times()?.map(|taken| {
        let scene = taken.passes.iter().filter(|pass| pass.name.starts_with("scene"));
        scene.map(|pass| pass.nanoseconds).sum()
    }))
}

/// Weighted operations that a pixel takes of each program that draws objects, together.
fn operations(renderer: &Renderer, frame: &Frame) -> Result<f64, RuntimeError> {
    let mut seen = Vec::new();
    let mut sum = 0.0;
    for material in &frame.materials {
        if seen.contains(&&material.recipe) {
            continue;
        }
        seen.push(&material.recipe);
        let program = renderer.program(&material.recipe)?;
        let (module, info) = (program.validated().module(), program.validated().info());
        let pixels = module.entry_points.iter().filter(|entry| entry.stage == ShaderStage::Fragment);
        let costs = pixels.filter_map(|entry| cost_of(module, info, &entry.name));
        sum += costs.map(|analysis| analysis.cost.weighted()).sum::<f64>();
    }
    Ok(sum)
}

impl Job for Sweep {
    fn kind(&self) -> &'static str {
        "alternatives"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let Some(mut base) = self.base.take() else {
            match self.begin(bench) {
                Ok(view) => tell(News::Compare(Told::Sweep(view))),
                Err(error) => {
                    tell(News::Compare(failed(self.kind(), &error)));
                    return Step::Break(());
                }
            }
            return self.progress();
        };
        let truth = match base
            .truth
            .take()
            .map_or_else(|| base.sent.take(bench.gpu()), |truth| Ok(Some(truth)))
        {
            Ok(Some(truth)) => truth,
            Ok(None) => {
                self.base = Some(base);
                return self.progress();
            }
            Err(error) => {
                tell(News::Compare(failed(self.kind(), &error)));
                return Step::Break(());
            }
        };
        let Some((name, change)) = self.candidates.get(self.done).cloned() else {
            return Step::Break(());
        };
        let outcome = self.measure(bench, &change, &truth, &base.present).transpose();
        base.truth = Some(truth);
        self.base = Some(base);
        let Some(outcome) = outcome else {
            return self.progress();
        };
        let outcome = outcome.map_err(|error| match error {
            RuntimeError::Compile(report) => reason(&report),
            error => error.to_string(),
        });
        let (is_present, stored) = match &change {
            Change::Module(module) => (
                self.row.module.as_ref().is_some_and(|now| Arc::ptr_eq(now, module)),
                self.truths.stored.of(module).to_vec(),
            ),
            Change::Recipe(_) => (false, Vec::new()),
        };
        let outcome = outcome.map(|measured| Measured {
            // What it is measured by.
            ratio: measured.ratio.map(|ratio| if is_present { 1.0 } else { ratio }),
            ..measured
        });
        tell(News::Compare(Told::Alternative(Box::new(Alternative {
            name,
            change,
            is_present,
            stored,
            outcome,
        }))));
        self.done += 1;
        if self.done == self.candidates.len() {
            return Step::Break(());
        }
        self.progress()
    }
}

impl Sweep {
    fn progress(&self) -> Step {
        Step::Continue(Progress {
            what: format!("alternatives of {}", self.row.path),
            done: self.done,
            of: self.candidates.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// Catches a sheet without a bound, and one that does not say what is beyond it.
    #[test]
    fn a_space_is_cut_and_says_so() {
        let text = r#"(pass: "forward", meshes: {"ball": Sphere(radius: 1.0)}, materials: {"m": {"material": "metalness", "brdf": "lambert"}},
            objects: [(mesh: "ball", material: "m")])"#;
        let shot = Shot {
            scene: SceneFile::parse("test", text, Path::new("")).unwrap(),
            catalog: Arc::new(Catalog::load(shadewright_modules::library()).unwrap()),
            version: 1,
        };
        let rows = rows(&shot.scene, &shot.catalog, &[]);
        let row = rows.iter().find(|row| row.path == "materials.m.brdf").unwrap().clone();
        let space = |steps: u32| {
            let text = format!(r#"(module: "lafortune", freeze: {{"cx": (from: -1.0, to: 1.0, steps: {steps})}})"#);
            Sweep::space(shot.clone(), row.clone(), [8, 8], Arc::default(), "test", &text).unwrap()
        };
        let (few, many) = (space(9), space(99));
        assert_eq!((few.candidates.len(), few.cut), (10, 0));
        assert_eq!((many.candidates.len(), many.cut), (MOST, 100 - MOST as u128));
    }
}
