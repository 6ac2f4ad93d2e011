//! The way of a picture's numbers from the GPU.

use shadewright_runtime::frame::{HdrReading, Targets};
use shadewright_runtime::gpu::{Gpu, RuntimeError};

use crate::compare::Values;

/// Linear values of a picture on their way.
pub struct Reading {
    size: [u32; 2],
    texels: HdrReading,
}

impl Reading {
    /// Has them sent.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn start(gpu: &Gpu, targets: &Targets) -> Result<Self, RuntimeError> {
        Ok(Self {
            size: [targets.hdr.width(), targets.hdr.height()],
            texels: targets.start_read_hdr(gpu)?,
        })
    }

    /// The values, once. Waits for them natively; on a page, where nobody may wait, `None` until some later frame of the page.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn take(&mut self, gpu: &Gpu) -> Result<Option<Values>, RuntimeError> {
        gpu.wait()?;
        let size = self.size;
        let texels = self.texels.take(gpu).transpose()?;
        Ok(texels.map(|texels| Values { size, texels }))
    }
}
