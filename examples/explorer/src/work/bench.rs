//! What the jobs of a lane work with.

use std::sync::Arc;
use std::time::Duration;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Renderer;
use shadewright_runtime::gpu::{Gpu, GpuError};
use web_time::Instant;

use super::pace::Pace;

/// Pipelines that are kept: some dozens of permutations to go back to.
const MOST_KEPT: usize = 96;

/// A device, and a renderer that is kept from job to job.
pub struct Bench {
    gpu: Gpu,
    renderer: Option<(Arc<Catalog>, Renderer)>,
    pace: Pace,
}

impl Bench {
    /// A bench on this device.
    pub fn new(gpu: Gpu) -> Self {
        Self {
            gpu,
            renderer: None,
            pace: Pace::default(),
        }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The renderer, linking from this library. Where the device can, it times its passes.
    pub fn renderer(&mut self, catalog: &Arc<Catalog>) -> &mut Renderer {
        let gpu = &self.gpu;
        let (known, renderer) = self.renderer.get_or_insert_with(|| {
            let mut renderer = Renderer::new(gpu, Arc::clone(catalog));
            renderer.set_capacity(MOST_KEPT);
            if let Err(error) = renderer.time_passes(true) {
                log::info!("passes are not timed: {error}");
            }
            (Arc::clone(catalog), renderer)
        });
        if !Arc::ptr_eq(known, catalog) {
            *known = Arc::clone(catalog);
            renderer.set_catalog(Arc::clone(catalog));
        }
        renderer
    }

    /// Waits for the picture of this size that was submitted last; what it takes from here on. A page goes on at once, and the time is what the
    /// picture before would have taken at this size.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn wait(&self, size: [u32; 2]) -> Result<Duration, GpuError> {
        if cfg!(target_arch = "wasm32") {
            return Ok(self.pace.follow(&self.gpu, size));
        }
        let start = Instant::now();
        self.gpu.wait()?;
        Ok(start.elapsed())
    }

    /// Whether the GPU still draws a picture that nobody has waited for: another would pile up behind it.
    pub fn is_drawing(&self) -> bool {
        self.pace.is_running()
    }

    /// Forgets the renderer: after a panic in the middle of one of its frames.
    pub fn reset(&mut self) {
        self.renderer = None;
    }
}
