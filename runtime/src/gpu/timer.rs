//! Times of passes on the GPU, by timestamp queries.

use std::time::Duration;

use web_time::Instant;
use wgpu_profiler::{GpuProfiler, GpuProfilerQuery, GpuProfilerSettings};

use super::device::{MAY_WAIT, PATIENCE};
use super::{Gpu, GpuError};

/// Submissions whose times may be waited for.
pub(crate) const PENDING: usize = 3;

/// Times passes. What it measures are the GPU's own timestamps at a pass's beginning and end; on a software driver those of the CPU that runs it.
pub(crate) struct Timer {
    profiler: GpuProfiler,
    gpu: Gpu,
}

impl std::fmt::Debug for Timer {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.debug_struct("Timer").field("gpu", &self.gpu.name()).finish_non_exhaustive()
    }
}

/// Nanoseconds that a pass took, by its label.
pub(crate) type PassTimes = Vec<(String, f64)>;

impl Timer {
    /// A timer for this device.
    ///
    /// # Errors
    /// [`GpuError::Unsupported`] where the device has no timestamps, or was made without `TIMESTAMP_QUERY`.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        let unsupported = |needs: String| GpuError::Unsupported {
            what: "timing passes".into(),
            needs,
        };
        if !gpu.device().features().contains(wgpu::Features::TIMESTAMP_QUERY) {
            return Err(unsupported(format!("timestamp queries on {}", gpu.name())));
        }
        let settings = GpuProfilerSettings {
            enable_timer_queries: true,
            enable_debug_groups: false,
            max_num_pending_frames: PENDING,
        };
        Ok(Self {
            profiler: GpuProfiler::new(gpu.device(), settings).map_err(|error| unsupported(error.to_string()))?,
            gpu: gpu.clone(),
        })
    }

    /// A query for a pass that is about to begin. It must be given to [`Timer::end`] after the pass.
    pub(crate) fn begin(&self, label: String, commands: &mut wgpu::CommandEncoder) -> GpuProfilerQuery {
        self.profiler.begin_pass_query(label, commands)
    }

    /// The pass is recorded.
    pub(crate) fn end(&self, commands: &mut wgpu::CommandEncoder, query: GpuProfilerQuery) {
        self.profiler.end_query(commands, query);
    }

    /// To be recorded after all passes, before the commands are submitted.
    pub(crate) fn resolve(&mut self, commands: &mut wgpu::CommandEncoder) {
        self.profiler.resolve_queries(commands);
    }

    /// To be called when the commands are submitted. Where [`PENDING`] are still waited for, the last one's times are lost.
    pub(crate) fn submitted(&mut self) -> Result<(), GpuError> {
        let gpu = self.gpu.clone();
        let ended = gpu.scoped("timing passes", |_| self.profiler.end_frame())?;
        ended.map_err(|error| GpuError::Driver {
            what: "timing passes".into(),
            message: error.to_string(),
        })
    }

    /// Times of the oldest submission that has none yet, if the GPU is done with it, in the order of its passes. Does not wait.
    pub(crate) fn take(&mut self) -> Option<PassTimes> {
        let times = self.profiler.process_finished_frame(self.gpu.queue().get_timestamp_period())?;
        let of = |result: wgpu_profiler::GpuTimerQueryResult| {
            let time = result.time?;
            Some((result.label, (time.end - time.start) * 1e9))
        };
        Some(times.into_iter().filter_map(of).collect())
    }

    /// The same, after waiting for the GPU. On the web, where nobody may wait, that is an error.
    pub(crate) fn wait(&mut self) -> Result<PassTimes, GpuError> {
        if !MAY_WAIT {
            return Err(GpuError::Unsupported {
                what: "waiting for the times of passes".into(),
                needs: "a thread that may wait for the GPU".into(),
            });
        }
        self.gpu.wait()?;
        let start = Instant::now();
        loop {
            // Another thread's poll may be the one that runs the callback, a moment after this thread's has returned.
            if let Some(times) = self.take() {
                return Ok(times);
            }
            if start.elapsed() > PATIENCE {
                return Err(GpuError::Driver {
                    what: "timing passes".into(),
                    message: "the timestamps did not come".into(),
                });
            }
            std::thread::sleep(Duration::from_millis(1));
            self.gpu.ask()?;
        }
    }
}
