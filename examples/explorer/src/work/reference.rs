//! The truth of a scene, drawn small at first and better with every step.
//!
//! A truth integrates by brute force, so a picture of it takes long. The window draws on the same device, and no driver lets one command take
//! seconds: so pictures are drawn in strips that take a moment each.

mod strip;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Frame;
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use web_time::Instant;

use super::beside::{failed, values};
use super::{Bench, Job, News, Progress, Shot, Step, paint};
use crate::compare::{Errors, Reference, Refined, Told, Truths, Values, reference};
use strip::{Whole, can_be_cut, strip};

/// Widths of a pixel, in the viewport's pixels.
const DIVISORS: [u32; 4] = [8, 4, 2, 1];
/// Smallest side that is drawn, pixels.
const SMALLEST: u32 = 8;
/// About as long as a strip takes at most.
const MOMENT: Duration = Duration::from_millis(200);
/// Fewest rows of a strip.
const FEWEST_ROWS: u32 = 4;

/// Draws the truth of a scene.
pub struct Refine {
    shot: Shot,
    size: [u32; 2],
    truths: Arc<Truths>,
    reference: Option<Reference>,
    /// The picture that is being drawn.
    part: Option<Part>,
    /// Pictures done.
    done: usize,
    /// Time that a pixel takes, seconds: of the last strip.
    pace: Option<f64>,
}

/// A picture that is not whole yet.
struct Part {
    frame: Frame,
    can_be_cut: bool,
    /// The present scene in the same size.
    found: Values,
    whole: Whole,
    /// Rows drawn.
    rows: u32,
}

impl Refine {
    /// In this size at last.
    pub fn new(shot: Shot, size: [u32; 2], truths: Arc<Truths>) -> Self {
        Self {
            shot,
            size,
            truths,
            reference: None,
            part: None,
            done: 0,
            pace: None,
        }
    }

    fn progress(&self) -> Step {
        Step::Continue(Progress {
            what: "drawing the truth".into(),
            done: self.done,
            of: DIVISORS.len(),
        })
    }

    /// Begins the next picture.
    fn begin(&self, bench: &mut Bench, of: &Reference, divisor: u32) -> Result<Part, RuntimeError> {
        let size = self.size.map(|side| side.div_ceil(divisor).max(SMALLEST));
        let found = paint(bench, &self.shot, size)?;
        let catalog: &Catalog = &self.shot.catalog;
        let frame = of.scene.frame(catalog, Some(size))?;
        Ok(Part {
            can_be_cut: can_be_cut(catalog, &frame),
            found: values(bench.gpu(), &found.targets)?,
            whole: Whole::new(bench.gpu(), size)?,
            frame,
            rows: 0,
        })
    }

    /// Draws the next strip; gives how long a pixel took.
    fn draw(&self, bench: &mut Bench, part: &mut Part) -> Result<f64, RuntimeError> {
        let [width, height] = part.frame.size;
        let affordable = self.pace.map(|pace| MOMENT.as_secs_f64() / (pace.max(1e-12) * f64::from(width)));
        let rows = affordable.map_or(height, |rows| rows as u32).max(FEWEST_ROWS);
        let left = height - part.rows;
        let rows = if part.can_be_cut { rows.min(left) } else { left };
        let start = Instant::now();
        let frame = strip(&part.frame, part.rows..part.rows + rows);
        let targets = bench.renderer(&self.shot.catalog).render(&frame)?;
        let read = values(bench.gpu(), &targets)?;
        part.whole.add(bench.gpu(), &targets, read, part.rows)?;
        part.rows += rows;
        Ok(start.elapsed().as_secs_f64() / (f64::from(width) * f64::from(rows)))
    }

    fn finish(&self, gpu: &Gpu, part: Part, divisor: u32) -> Result<Refined, RuntimeError> {
        let (display, values) = part.whole.finish(gpu)?;
        Ok(Refined {
            version: self.shot.version,
            divisor,
            // Of one size, as they were drawn.
            errors: Arc::new(Errors::of(&part.found, &values).unwrap_or_default()),
            display,
            values,
        })
    }

    /// A strip, or what comes before and after all of them.
    fn advance(&mut self, bench: &mut Bench, of: &Reference, divisor: u32) -> Result<Option<Refined>, RuntimeError> {
        let mut part = match self.part.take() {
            None => self.begin(bench, of, divisor)?,
            Some(part) => part,
        };
        self.pace = Some(self.draw(bench, &mut part)?);
        if part.rows < part.frame.size[1] {
            self.part = Some(part);
            return Ok(None);
        }
        self.done += 1;
        self.finish(bench.gpu(), part, divisor).map(Some)
    }
}

impl Job for Refine {
    fn kind(&self) -> &'static str {
        "reference"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let Some(of) = self.reference.take() else {
            let made = reference(&self.shot.scene, &self.shot.catalog, &self.truths);
            tell(News::Compare(Told::Reference {
                version: self.shot.version,
                replaced: made.replaced.clone(),
                left: made.left.clone(),
            }));
            self.reference = Some(made);
            return self.progress();
        };
        let Some(divisor) = DIVISORS.get(self.done) else {
            return Step::Break(());
        };
        match self.advance(bench, &of, *divisor) {
            Ok(None) => {}
            Ok(Some(refined)) => tell(News::Compare(Told::Refined(Box::new(refined)))),
            Err(error) => {
                tell(News::Compare(failed(self.kind(), &error)));
                return Step::Break(());
            }
        }
        self.reference = Some(of);
        if self.done == DIVISORS.len() {
            return Step::Break(());
        }
        self.progress()
    }
}
