//! What pictures take on the GPU, where nobody may wait for it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use shadewright_runtime::gpu::Gpu;
use web_time::Instant;

/// A GPU that has not answered for so long will not: it was lost.
const PATIENCE: Duration = Duration::from_secs(20);

/// Follows pictures from their submission to their end.
#[derive(Clone, Default)]
pub struct Pace(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    /// Since when a picture is being drawn.
    running: Option<Instant>,
    /// Seconds a pixel, of the last picture that was done.
    per_pixel: f64,
}

impl Pace {
    fn state(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether a picture is being drawn.
    pub fn is_running(&self) -> bool {
        self.state().running.is_some_and(|since| since.elapsed() < PATIENCE)
    }

    /// A picture of this size was submitted; what it will take if it is like the one before. The first takes nothing.
    pub fn follow(&self, gpu: &Gpu, [width, height]: [u32; 2]) -> Duration {
        let pixels = f64::from(width) * f64::from(height);
        let since = Instant::now();
        let mut state = self.state();
        state.running = Some(since);
        let expected = Duration::try_from_secs_f64(state.per_pixel * pixels).unwrap_or_default();
        drop(state);
        let pace = self.clone();
        gpu.queue().on_submitted_work_done(move || {
            let mut state = pace.state();
            state.running = None;
            state.per_pixel = since.elapsed().as_secs_f64() / pixels.max(1.0);
        });
        expected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a page that draws one picture only, and one that draws them all at once.
    #[test]
    fn a_picture_is_followed_to_its_end() {
        let gpu = Gpu::headless().unwrap();
        let pace = Pace::default();
        assert!(!pace.is_running());
        assert_eq!(pace.follow(&gpu, [10, 10]), Duration::ZERO);
        assert!(pace.is_running());
        std::thread::sleep(Duration::from_millis(10));
        gpu.wait().unwrap();
        assert!(!pace.is_running());
        let next = pace.follow(&gpu, [20, 10]);
        assert!(next >= Duration::from_millis(20), "{next:?} for twice the pixels");
    }
}
