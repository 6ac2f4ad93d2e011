//! The second picture beside the viewport's, numbers of both, and what is made of these.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Targets;
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::scene::Files;

use super::{Bench, Job, News, Progress, Reading, Shot, Step, paint};
use crate::compare::{Beside, Drawn, Errors, Told, Truths, with_camera_of};
use crate::document::State;

/// Draws the second picture, and reads the numbers of both.
pub struct DrawBeside {
    /// The first picture: its version and size.
    pub first: (u64, [u32; 2]),
    /// It, where its numbers are wanted.
    pub values_of: Option<Targets>,
    /// The second picture: what it is of, and it itself where it is there already.
    pub second: Option<(Drawn, State, Option<Targets>)>,
    /// Where its files are.
    pub files: Files,
    /// The library.
    pub catalog: Arc<Catalog>,
    /// What is drawn: `None` at first.
    pub sent: Option<Sent>,
}

/// Pictures that are drawn, with those of their numbers that have not come.
pub struct Sent {
    beside: Beside,
    first: Option<Reading>,
    second: Option<Reading>,
}

impl DrawBeside {
    fn draw(&self, bench: &mut Bench) -> Result<Sent, RuntimeError> {
        let second = match &self.second {
            None => None,
            Some((drawn, _, Some(targets))) => Some((drawn.clone(), targets.clone())),
            Some((drawn, state, None)) => {
                let shot = Shot {
                    scene: with_camera_of(&state.parse(&self.files)?, drawn.camera.as_deref())?,
                    catalog: Arc::clone(&self.catalog),
                    version: self.first.0,
                };
                Some((drawn.clone(), paint(bench, &shot, drawn.size)?.targets))
            }
        };
        let read = |targets: &Targets| Reading::start(bench.gpu(), targets);
        let other = second.as_ref().filter(|_| self.values_of.is_some());
        Ok(Sent {
            first: self.values_of.as_ref().map(read).transpose()?,
            second: other.map(|(_, targets)| read(targets)).transpose()?,
            beside: Beside {
                first: self.first,
                second,
                first_values: None,
                second_values: None,
                errors: None,
            },
        })
    }

    fn advance(&mut self, bench: &mut Bench) -> Result<Option<Beside>, RuntimeError> {
        let mut sent = match self.sent.take() {
            Some(sent) => sent,
            None => self.draw(bench)?,
        };
        if !sent.receive(bench.gpu())? {
            self.sent = Some(sent);
            return Ok(None);
        }
        Ok(Some(sent.beside))
    }
}

impl Sent {
    /// Takes in what has come; whether that is all.
    fn receive(&mut self, gpu: &Gpu) -> Result<bool, RuntimeError> {
        let of = &mut self.beside;
        for (reading, values) in [(&mut self.first, &mut of.first_values), (&mut self.second, &mut of.second_values)] {
            if let Some(sent) = reading {
                *values = sent.take(gpu)?;
                if values.is_none() {
                    return Ok(false);
                }
                *reading = None;
            }
        }
        if let (Some(found), Some(truth)) = (&of.first_values, &of.second_values) {
            of.errors = Errors::of(found, truth).map(Arc::new);
        }
        Ok(true)
    }
}

impl Job for DrawBeside {
    fn kind(&self) -> &'static str {
        "second picture"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(News::Compare(match self.advance(bench) {
            Ok(Some(beside)) => Told::Beside(Box::new(beside)),
            Ok(None) => {
                return Step::Continue(Progress {
                    what: "reading numbers".into(),
                    done: 1,
                    of: 2,
                });
            }
            Err(error) => failed(self.kind(), &error),
        }));
        Step::Break(())
    }
}

/// An error of a job that is no error of the present scene.
pub fn failed(what: &'static str, error: &RuntimeError) -> Told {
    let message = match error {
        RuntimeError::Compile(report) => super::reason(report),
        error => error.to_string(),
    };
    Told::Failed(what, message)
}

/// Reads what the library's experiments call true.
pub struct LoadTruths(pub Arc<Catalog>);

impl Job for LoadTruths {
    fn kind(&self) -> &'static str {
        "experiments"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let truths = Truths::load(&self.0).map(Arc::new).map_err(|report| super::reason(&report));
        tell(News::Compare(Told::Truths(Arc::clone(&self.0), truths)));
        Step::Break(())
    }
}

/// Paints a heat map.
pub struct PaintHeat {
    /// Of what.
    pub errors: Arc<Errors>,
    /// The error that has the full colour.
    pub full: f64,
}

impl Job for PaintHeat {
    fn kind(&self) -> &'static str {
        "heat map"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(News::Compare(Told::Heat(self.errors.image(self.full))));
        Step::Break(())
    }
}
