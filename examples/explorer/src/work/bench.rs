//! What the jobs of a lane work with.

use std::sync::Arc;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Renderer;
use shadewright_runtime::gpu::Gpu;

/// Pipelines that are kept: some dozens of permutations to go back to.
const MOST_KEPT: usize = 96;

/// A device, and a renderer that is kept from job to job.
pub struct Bench {
    gpu: Gpu,
    renderer: Option<(Arc<Catalog>, Renderer)>,
}

impl Bench {
    /// A bench on this device.
    pub fn new(gpu: Gpu) -> Self {
        Self { gpu, renderer: None }
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

    /// Forgets the renderer: after a panic in the middle of one of its frames.
    pub fn reset(&mut self) {
        self.renderer = None;
    }
}
