//! What a frame's passes cost on the GPU, and its preparation on the CPU.

use std::collections::VecDeque;
use std::time::Duration;

use super::render::Renderer;
use crate::gpu::timer::{PENDING, PassTimes};
use crate::gpu::{Gpu, GpuError, Timer};

/// Times of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameTimes {
    /// On the GPU, in the order in which they ran.
    pub passes: Vec<PassTime>,
    /// What the CPU did for it.
    pub cpu: CpuTimes,
}

/// One pass on the GPU.
#[derive(Clone, Debug, PartialEq)]
pub struct PassTime {
    /// `shadow map of lamp 1, view 3 of 6`, `scene (forward)`, `log_average.measure`, `display (display)`.
    pub name: String,
    /// From its beginning to its end.
    pub nanoseconds: f64,
}

/// What the CPU did for a frame. What was there already costs next to nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CpuTimes {
    /// Linking programs, and planning passes and views.
    pub link: Duration,
    /// Making pipelines. Drivers that compile when they draw do it in the first frame's passes instead.
    pub pipelines: Duration,
    /// Uploading, and recording commands and submitting them.
    pub record: Duration,
}

/// Times the frames of a renderer.
#[derive(Debug)]
pub(super) struct Clock {
    pub timer: Timer,
    /// Of the frame that is being made.
    pub cpu: CpuTimes,
    /// Of the frames whose passes' times have not come yet.
    pending: VecDeque<CpuTimes>,
}

impl Clock {
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            timer: Timer::new(gpu)?,
            cpu: CpuTimes::default(),
            pending: VecDeque::new(),
        })
    }

    /// Of the oldest frame that is waited for.
    fn times(&mut self, passes: PassTimes) -> FrameTimes {
        let pass = |(name, nanoseconds)| PassTime { name, nanoseconds };
        FrameTimes {
            passes: passes.into_iter().map(pass).collect(),
            cpu: self.pending.pop_front().unwrap_or_default(),
        }
    }

    /// The frame is submitted.
    pub fn submitted(&mut self) -> Result<(), GpuError> {
        self.timer.submitted()?;
        // The timer gives up the newest of too many, too.
        self.pending.truncate(PENDING - 1);
        self.pending.push_back(std::mem::take(&mut self.cpu));
        Ok(())
    }
}

impl Renderer {
    /// Times the passes of all frames from now on, or no more. Without it frames have no queries. Times of frames that were not taken are forgotten.
    ///
    /// # Errors
    /// [`GpuError::Unsupported`] where the device has no timestamp queries, or was made without `TIMESTAMP_QUERY`.
    pub fn time_passes(&mut self, on: bool) -> Result<(), GpuError> {
        self.clock = if on { Some(Clock::new(&self.gpu)?) } else { None };
        Ok(())
    }

    /// Times of the oldest frame whose times were not taken yet, as soon as the GPU is done with it. Does not wait: call it after each frame. Of more than three frames under way, times are lost. `None` as well where [`Renderer::time_passes`] is off.
    pub fn take_times(&mut self) -> Option<FrameTimes> {
        let clock = self.clock.as_mut()?;
        let passes = clock.timer.take()?;
        Some(clock.times(passes))
    }

    /// The same, after waiting for the GPU. `None` where no frame's times are left to take.
    ///
    /// # Errors
    /// The device was lost, or did not answer for a quarter of an hour.
    pub fn wait_for_times(&mut self) -> Result<Option<FrameTimes>, GpuError> {
        let Some(clock) = self.clock.as_mut().filter(|clock| !clock.pending.is_empty()) else {
            return Ok(None);
        };
        let passes = clock.timer.wait()?;
        Ok(Some(clock.times(passes)))
    }
}
