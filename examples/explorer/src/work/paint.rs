//! The picture of the viewport.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use shadewright_runtime::frame::{CpuTimes, Frame, PassTime, Targets};
use shadewright_runtime::gpu::RuntimeError;
use web_time::Instant;

use super::{Bench, Job, News, Progress, Shot, Step};

/// Draws a scene.
pub struct Paint {
    /// What is drawn.
    pub shot: Shot,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

/// A picture.
#[derive(Debug)]
pub struct Painted {
    /// Of which shot.
    pub version: u64,
    /// On the GPU.
    pub targets: Targets,
    /// What it shows.
    pub frame: Arc<Frame>,
    /// What it took.
    pub times: Times,
}

/// What a picture took, from the asking.
#[derive(Clone, Debug, Default)]
pub struct Times {
    /// From the scene's text to its recipes, meshes and values.
    pub derive: Duration,
    /// Linking, pipelines, recording.
    pub cpu: CpuTimes,
    /// From the first command to the last on the GPU, its compiler included where it compiles when it draws.
    pub gpu: Duration,
    /// All of it.
    pub all: Duration,
    /// The passes on the GPU; none where the device has no timestamps.
    pub passes: Vec<PassTime>,
}

impl Job for Paint {
    fn kind(&self) -> &'static str {
        "picture"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        if bench.is_drawing() {
            return Step::Continue(Progress {
                what: "drawing".into(),
                done: 0,
                of: 1,
            });
        }
        tell(match paint(bench, &self.shot, self.size) {
            Ok(painted) => News::Painted(Box::new(painted)),
            Err(error) => wrong(error, self.shot.version, self.kind()),
        });
        Step::Break(())
    }
}

/// An error of the runtime as news.
pub fn wrong(error: RuntimeError, version: u64, what: &'static str) -> News {
    match error {
        RuntimeError::Compile(report) => News::Wrong { version, report },
        error => News::Failed {
            what,
            message: error.to_string(),
        },
    }
}

/// Draws a scene and waits for it, so that whoever shows it need not. A page does not wait: there the GPU's time is what the picture before would
/// have taken at this size.
///
/// # Errors
/// The scene is wrong, or the GPU fails.
pub fn paint(bench: &mut Bench, shot: &Shot, size: [u32; 2]) -> Result<Painted, RuntimeError> {
    let start = Instant::now();
    let frame = shot.scene.frame(&shot.catalog, Some(size))?;
    let mut times = Times {
        derive: start.elapsed(),
        ..Times::default()
    };
    let renderer = bench.renderer(&shot.catalog);
    let targets = renderer.render(&frame)?;
    let submitted = Instant::now();
    times.gpu = bench.wait(size)?;
    times.all = submitted - start + times.gpu;
    if let Some(taken) = bench.renderer(&shot.catalog).take_times() {
        times.cpu = taken.cpu;
        times.passes = taken.passes;
    }
    Ok(Painted {
        version: shot.version,
        targets,
        frame: Arc::new(frame),
        times,
    })
}
