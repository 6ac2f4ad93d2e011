//! The second picture beside the viewport's, numbers of both, and what is made of these.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Targets;
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::scene::Files;

use super::{Bench, Job, News, Shot, Step, paint};
use crate::compare::{Beside, Drawn, Errors, Told, Truths, Values, with_camera_of};
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
}

/// The linear values of a picture.
///
/// # Errors
/// The GPU fails.
pub fn values(gpu: &Gpu, targets: &Targets) -> Result<Values, RuntimeError> {
    // Waits: a page of the web cannot.
    let texels = targets.read_hdr(gpu)?;
    Ok(Values {
        size: [targets.hdr.width(), targets.hdr.height()],
        texels,
    })
}

impl DrawBeside {
    fn draw(&self, bench: &mut Bench) -> Result<Beside, RuntimeError> {
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
        let mut beside = Beside {
            first: self.first,
            second,
            first_values: None,
            second_values: None,
            errors: None,
        };
        if let Some(first) = &self.values_of {
            let found = values(bench.gpu(), first)?;
            if let Some((_, targets)) = &beside.second {
                let truth = values(bench.gpu(), targets)?;
                beside.errors = Errors::of(&found, &truth).map(Arc::new);
                beside.second_values = Some(truth);
            }
            beside.first_values = Some(found);
        }
        Ok(beside)
    }
}

impl Job for DrawBeside {
    fn kind(&self) -> &'static str {
        "second picture"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(News::Compare(match self.draw(bench) {
            Ok(beside) => Told::Beside(Box::new(beside)),
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
