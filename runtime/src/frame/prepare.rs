//! Everything that a frame will need, made before it is drawn: programs, pipelines, uploads, and what drivers put off until they draw.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::list::Cut;
use super::needs::{Need, Request, distinct, requests};
use super::plan::Plan;
use super::render::Renderer;
use super::{Frame, fill};
use crate::gpu::{RuntimeError, lock};

/// How far a preparation is. Each pipeline counts twice: when it is made, and when something has been drawn with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Steps done.
    pub done: usize,
    /// All steps.
    pub total: usize,
}

/// What a preparation did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prepared {
    /// Pipelines that the frame needs, in view and out of it.
    pub pipelines: usize,
    /// How many of them this preparation made; the others were there.
    pub made: usize,
    /// Whether it came to its end. `false` only where it was stopped: what was made until then stays.
    pub complete: bool,
}

impl Renderer {
    /// What a frame will be drawn with on this GPU: see [`needs`](super::needs()).
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn needs(&mut self, frame: &Frame) -> Result<Vec<Need>, RuntimeError> {
        let hdr = self.hdr(frame)?;
        let plan = Plan::of(&self.programs, frame, hdr, &WHOLE)?;
        Ok(requests(&plan, frame)?.iter().map(Request::need).collect())
    }

    /// Makes everything that a frame will need, whatever is in view: programs and pipelines on all cores, meshes and textures on the GPU.
    /// Then draws one texel with each pipeline, because some drivers compile when they draw. [`Renderer::render`] makes no pipeline after it.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn prepare(&mut self, frame: &Frame) -> Result<Prepared, RuntimeError> {
        self.prepare_with(frame, |_| ControlFlow::Continue(()))
    }

    /// As [`Renderer::prepare`]; `step` is told of each step in order, from whichever thread did it, and stops the preparation by breaking:
    /// pipelines that other threads have begun are finished, no further one is begun.
    ///
    /// # Errors
    /// As for [`Renderer::render`].
    pub fn prepare_with(&mut self, frame: &Frame, step: impl Fn(Progress) -> ControlFlow<()> + Sync) -> Result<Prepared, RuntimeError> {
        let hdr = self.hdr(frame)?;
        let plan = Plan::of(&self.programs, frame, hdr, &WHOLE)?;
        let all = requests(&plan, frame)?;
        let wanted = distinct(&all);
        let steps = Steps {
            total: 2 * wanted.len(),
            done: Mutex::new(0),
            stopped: AtomicBool::new(false),
            step: &step,
        };
        let before = self.pipelines.counts().misses;
        let pipelines = &self.pipelines;
        let make = |request: &&Request| {
            if steps.stopped() {
                return Ok(());
            }
            request.make(pipelines)?;
            steps.next();
            Ok(())
        };
        let results: Vec<Result<(), RuntimeError>> = wanted.par_iter().map(make).collect();
        results.into_iter().collect::<Result<(), _>>()?;
        let pipelines = wanted.len();
        let made = self.pipelines.counts().misses - before;
        if !steps.stopped() {
            let mut kept = fill::Kept::new();
            self.draw(frame, &plan, Some(&mut kept), None, |drawing, targets| {
                drawing.warm(targets, &steps)
            })?;
        }
        Ok(Prepared {
            pipelines,
            made,
            complete: !steps.stopped(),
        })
    }
}

const WHOLE: Cut = Cut {
    whole: true,
    absent: &[],
    at_once: false,
};

/// Counts steps and asks whether to go on.
pub(crate) struct Steps<'s> {
    total: usize,
    done: Mutex<usize>,
    stopped: AtomicBool,
    step: &'s (dyn Fn(Progress) -> ControlFlow<()> + Sync),
}

impl Steps<'_> {
    pub fn stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// One step more.
    pub fn next(&self) {
        // Held while the caller is told, so that he hears of the steps in order.
        let mut done = lock(&self.done);
        if *done < self.total {
            *done += 1;
            self.tell(*done);
        }
    }

    /// The last step, where there was less to draw than to make: a mesh without triangles is not drawn.
    pub fn finish(&self) {
        let mut done = lock(&self.done);
        if *done < self.total && !self.stopped() {
            *done = self.total;
            self.tell(*done);
        }
    }

    fn tell(&self, done: usize) {
        let total = self.total;
        if (self.step)(Progress { done, total }).is_break() {
            self.stopped.store(true, Ordering::Relaxed);
        }
    }
}
