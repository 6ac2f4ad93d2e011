//! The device that the window and the runtime share.

use std::sync::Arc;

use eframe::egui_wgpu::{WgpuSetup, WgpuSetupCreateNew};
use shadewright_runtime::gpu::Gpu;

/// A device with what the runtime uses where the adapter has it.
pub fn setup() -> WgpuSetup {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    setup.device_descriptor = Arc::new(Gpu::descriptor);
    WgpuSetup::CreateNew(setup)
}
