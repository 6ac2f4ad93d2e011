//! The truth of a scene, drawn small at first and better with every step.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_runtime::gpu::RuntimeError;

use super::beside::{failed, values};
use super::{Bench, Job, News, Progress, Shot, Step, paint};
use crate::compare::{Errors, Reference, Refined, Told, Truths, reference};

/// Widths of a pixel, in the viewport's pixels.
const DIVISORS: [u32; 4] = [8, 4, 2, 1];
/// Smallest side that is drawn, pixels.
const SMALLEST: u32 = 8;

/// Draws the truth of a scene.
pub struct Refine {
    shot: Shot,
    size: [u32; 2],
    truths: Arc<Truths>,
    reference: Option<Reference>,
    done: usize,
}

impl Refine {
    /// In this size at last.
    pub fn new(shot: Shot, size: [u32; 2], truths: Arc<Truths>) -> Self {
        Self {
            shot,
            size,
            truths,
            reference: None,
            done: 0,
        }
    }

    fn draw(&self, bench: &mut Bench, of: &Reference, divisor: u32) -> Result<Refined, RuntimeError> {
        let size = self.size.map(|side| side.div_ceil(divisor).max(SMALLEST));
        let truth = Shot {
            scene: of.scene.clone(),
            ..self.shot.clone()
        };
        let found = paint(bench, &self.shot, size)?;
        let found = values(bench.gpu(), &found.targets)?;
        let targets = paint(bench, &truth, size)?.targets;
        let values = values(bench.gpu(), &targets)?;
        Ok(Refined {
            version: self.shot.version,
            divisor,
            // Of one size, as they were drawn.
            errors: Arc::new(Errors::of(&found, &values).unwrap_or_default()),
            targets,
            values,
        })
    }

    fn progress(&self) -> Step {
        Step::Continue(Progress {
            what: "drawing the truth".into(),
            done: self.done,
            of: DIVISORS.len(),
        })
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
        match self.draw(bench, &of, *divisor) {
            Ok(refined) => tell(News::Compare(Told::Refined(Box::new(refined)))),
            Err(error) => {
                tell(News::Compare(failed(self.kind(), &error)));
                return Step::Break(());
            }
        }
        self.reference = Some(of);
        self.done += 1;
        if self.done == DIVISORS.len() {
            return Step::Break(());
        }
        self.progress()
    }
}
