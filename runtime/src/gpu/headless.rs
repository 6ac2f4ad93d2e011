//! A device without a window: the best that the machine has.

use super::{Gpu, GpuError};

/// What to do where there is no driver.
const ADVICE: &str = "Install a GPU driver, or the software one: on Debian and Ubuntu `apt-get install mesa-vulkan-drivers`, \
on Fedora `dnf install mesa-vulkan-drivers`, on Arch `pacman -S vulkan-swrast`.";

impl Gpu {
    /// Finds the best adapter, a real GPU before a software driver, and opens it without a window.
    /// Honours `WGPU_ADAPTER_NAME` (part of a name), `WGPU_BACKEND`, and the Vulkan loader's own variables.
    ///
    /// # Errors
    /// [`GpuError::NoAdapter`] where there is none, [`GpuError::NoDevice`] where it cannot be opened.
    pub fn headless() -> Result<Self, GpuError> {
        let wanted = std::env::var("WGPU_ADAPTER_NAME").ok().filter(|name| !name.is_empty());
        // OpenGL is asked only where nothing else answers: its loader is slow to start and prints to standard error.
        let adapter = choose(adapters(wgpu::Backends::all() - wgpu::Backends::GL), wanted.as_deref())
            .or_else(|_| choose(adapters(wgpu::Backends::all()), wanted.as_deref()))?;
        let info = adapter.get_info();
        let request = adapter.request_device(&Self::descriptor(&adapter));
        let (device, queue) = pollster::block_on(request).map_err(|error| GpuError::NoDevice {
            adapter: info.name.clone(),
            message: error.to_string(),
        })?;
        Ok(Self::from_parts(device, queue))
    }
}

/// Adapters of these backends, as far as `WGPU_BACKEND` allows them.
fn adapters(backends: wgpu::Backends) -> Vec<wgpu::Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle_from_env();
    descriptor.backends &= backends;
    let instance = wgpu::Instance::new(descriptor);
    pollster::block_on(instance.enumerate_adapters(backends))
}

/// The best of the adapters that can run storage buffers and compute.
fn choose(adapters: Vec<wgpu::Adapter>, wanted: Option<&str>) -> Result<wgpu::Adapter, GpuError> {
    let needed = wgpu::DownlevelFlags::COMPUTE_SHADERS | wgpu::DownlevelFlags::VERTEX_STORAGE;
    let missing = |reason: String| GpuError::NoAdapter {
        reason,
        advice: ADVICE.to_owned(),
    };
    let mut names = Vec::new();
    let best = adapters
        .into_iter()
        .filter(|adapter| adapter.get_downlevel_capabilities().flags.contains(needed))
        .inspect(|adapter| names.push(adapter.get_info().name))
        .filter(|adapter| {
            let name = adapter.get_info().name.to_lowercase();
            wanted.is_none_or(|wanted| name.contains(&wanted.to_lowercase()))
        })
        .min_by_key(|adapter| rank(&adapter.get_info()));
    match (best, wanted) {
        (Some(adapter), _) => Ok(adapter),
        (None, Some(wanted)) if !names.is_empty() => Err(missing(format!(
            "WGPU_ADAPTER_NAME is {wanted:?}, but there is only {}",
            names.join(", ")
        ))),
        (None, _) => Err(missing("no Vulkan, Metal, DirectX 12 or OpenGL driver answers".into())),
    }
}

/// Smaller is better: real hardware first, then drivers other than OpenGL.
fn rank(info: &wgpu::AdapterInfo) -> (u8, bool) {
    let kind = match info.device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    (kind, info.backend == wgpu::Backend::Gl)
}
