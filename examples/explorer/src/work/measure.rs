//! The same picture again and again, to know what it takes.

use std::sync::atomic::AtomicBool;

use super::{Bench, Job, News, Progress, Shot, Step, paint, wrong};

/// Draws a scene some times over.
pub struct Measure {
    /// What is drawn.
    shot: Shot,
    /// Width and height, pixels.
    size: [u32; 2],
    done: usize,
    of: usize,
}

impl Measure {
    /// So many pictures of a scene.
    pub fn new(shot: Shot, size: [u32; 2], of: usize) -> Self {
        Self { shot, size, done: 0, of }
    }

    fn progress(&self) -> Step {
        Step::Continue(Progress {
            what: "measuring".into(),
            done: self.done,
            of: self.of,
        })
    }
}

impl Job for Measure {
    fn kind(&self) -> &'static str {
        "measurement"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        if bench.is_drawing() {
            return self.progress();
        }
        match paint(bench, &self.shot, self.size) {
            Ok(painted) => tell(News::Painted(Box::new(painted))),
            Err(error) => {
                tell(wrong(error, self.shot.version, self.kind()));
                return Step::Break(());
            }
        }
        self.done += 1;
        if self.done >= self.of {
            return Step::Break(());
        }
        self.progress()
    }
}
