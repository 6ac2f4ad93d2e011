//! The truth of a scene, drawn small at first and better with every step.
//!
//! A truth integrates by brute force, so a picture of it takes long. The window draws on the same device, and no driver lets one command take
//! seconds: so pictures are drawn in strips that take a moment each.

mod strip;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::{Frame, Targets};
use shadewright_runtime::gpu::RuntimeError;
use web_time::Instant;

use super::beside::failed;
use super::{Bench, Job, News, Progress, Reading, Shot, Step, paint};
use crate::compare::{Errors, Reference, Refined, Told, Truths, reference};
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
    found: Reading,
    whole: Whole,
    /// Rows that are there.
    rows: u32,
    /// The next ones, on their way.
    strip: Option<Strip>,
}

/// Rows that are drawn.
struct Strip {
    since: Instant,
    rows: u32,
    targets: Targets,
    reading: Reading,
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
            found: Reading::start(bench.gpu(), &found.targets)?,
            whole: Whole::new(bench.gpu(), size)?,
            frame,
            rows: 0,
            strip: None,
        })
    }

    /// Draws the next strip.
    fn draw(&self, bench: &mut Bench, part: &Part) -> Result<Strip, RuntimeError> {
        let [width, height] = part.frame.size;
        let affordable = self.pace.map(|pace| MOMENT.as_secs_f64() / (pace.max(1e-12) * f64::from(width)));
        let rows = affordable.map_or(height, |rows| rows as u32).max(FEWEST_ROWS);
        let left = height - part.rows;
        let rows = if part.can_be_cut { rows.min(left) } else { left };
        let since = Instant::now();
        let frame = strip(&part.frame, part.rows..part.rows + rows);
        let targets = bench.renderer(&self.shot.catalog).render(&frame)?;
        Ok(Strip {
            since,
            rows,
            reading: Reading::start(bench.gpu(), &targets)?,
            targets,
        })
    }

    /// Draws the next strip, or takes in the one that was drawn.
    fn go_on(&mut self, bench: &mut Bench, part: &mut Part) -> Result<(), RuntimeError> {
        let mut strip = match part.strip.take() {
            Some(strip) => strip,
            None => self.draw(bench, part)?,
        };
        let Some(read) = strip.reading.take(bench.gpu())? else {
            part.strip = Some(strip);
            return Ok(());
        };
        part.whole.add(bench.gpu(), &strip.targets, read, part.rows)?;
        part.rows += strip.rows;
        let pixels = f64::from(part.frame.size[0]) * f64::from(strip.rows);
        self.pace = Some(strip.since.elapsed().as_secs_f64() / pixels);
        Ok(())
    }

    /// A strip, or what comes before and after all of them.
    fn advance(&mut self, bench: &mut Bench, of: &Reference, divisor: u32) -> Result<Option<Refined>, RuntimeError> {
        let mut part = match self.part.take() {
            None => self.begin(bench, of, divisor)?,
            Some(part) => part,
        };
        let height = part.frame.size[1];
        if part.rows < height {
            self.go_on(bench, &mut part)?;
        }
        let found = if part.rows < height { None } else { part.found.take(bench.gpu())? };
        let Some(found) = found else {
            self.part = Some(part);
            return Ok(None);
        };
        self.done += 1;
        let (display, values) = part.whole.finish(bench.gpu())?;
        Ok(Some(Refined {
            version: self.shot.version,
            divisor,
            // Of one size, as they were drawn.
            errors: Arc::new(Errors::of(&found, &values).unwrap_or_default()),
            display,
            values,
        }))
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
