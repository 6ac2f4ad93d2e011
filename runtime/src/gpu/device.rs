//! The device: found or given, with errors that come back instead of panicking.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::Duration;

use super::GpuError;

/// What to do where there is no driver.
const ADVICE: &str = "Install a GPU driver, or the software one: on Debian and Ubuntu `apt-get install mesa-vulkan-drivers`, \
on Fedora `dnf install mesa-vulkan-drivers`, on Arch `pacman -S vulkan-swrast`.";

/// How long one submission may take. A software driver needs minutes for a large reference image; a driver that hangs needs forever.
pub(super) const PATIENCE: Duration = Duration::from_secs(900);

/// Features that are used where they are there.
const WELCOME: wgpu::Features = wgpu::Features::FLOAT32_FILTERABLE
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::PIPELINE_CACHE);

/// What the device's callbacks leave for the next call to find.
#[derive(Debug, Default)]
struct Faults {
    lost: Mutex<Option<String>>,
    uncaptured: Mutex<Option<GpuError>>,
}

/// A lock that a panic elsewhere does not take away: the data is replaced whole, never left half-written.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A device with its queue. Cheap to clone; all clones are the same device.
#[derive(Clone, Debug)]
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    info: wgpu::AdapterInfo,
    faults: Arc<Faults>,
}

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
        let request = adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("shadewright"),
            required_features: adapter.features() & WELCOME,
            required_limits: adapter.limits(),
            ..Default::default()
        });
        let (device, queue) = pollster::block_on(request).map_err(|error| GpuError::NoDevice {
            adapter: info.name.clone(),
            message: error.to_string(),
        })?;
        Ok(Self::from_parts(device, queue))
    }

    /// Takes a caller's device. Its handlers of uncaptured errors and of loss are replaced: wgpu's own would panic.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Arc::new(Faults::default());
        let seen = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error| {
            log::error!("uncaptured GPU error: {error}");
            lock(&seen.uncaptured).get_or_insert(typed("a GPU command", error));
        }));
        let seen = Arc::clone(&faults);
        device.set_device_lost_callback(move |reason, message| {
            log::warn!("GPU lost ({reason:?}): {message}");
            let message = if message.is_empty() { format!("{reason:?}") } else { message };
            lock(&seen.lost).get_or_insert(message);
        });
        let info = device.adapter_info();
        Self {
            device,
            queue,
            info,
            faults,
        }
    }

    /// The device.
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// Its queue.
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// What the driver says of itself.
    pub fn info(&self) -> &wgpu::AdapterInfo {
        &self.info
    }

    /// The adapter's name and driver in one line, for people and reports.
    pub fn name(&self) -> String {
        let wgpu::AdapterInfo {
            name,
            driver_info,
            backend,
            ..
        } = &self.info;
        match driver_info.as_str() {
            "" => format!("{name}, {backend}"),
            driver => format!("{name}, {driver}, {backend}"),
        }
    }

    /// Whether the device is software on the CPU.
    pub fn is_software(&self) -> bool {
        self.info.device_type == wgpu::DeviceType::Cpu
    }

    /// Whether the device is gone.
    pub fn is_lost(&self) -> bool {
        lock(&self.faults.lost).is_some()
    }

    /// Gives back what went wrong since the last call: a loss for good, an uncaptured error once.
    ///
    /// # Errors
    /// That.
    pub fn check(&self) -> Result<(), GpuError> {
        let uncaptured = lock(&self.faults.uncaptured).take();
        match uncaptured {
            Some(error) => Err(self.or_lost(error)),
            None => match lock(&self.faults.lost).clone() {
                Some(reason) => Err(GpuError::Lost(reason)),
                None => Ok(()),
            },
        }
    }

    /// As [`Gpu::check`], after asking the device: wgpu tells of a loss only when it is polled, and what a lost device makes until then looks
    /// as if it were there. Does not wait.
    ///
    /// # Errors
    /// As for [`Gpu::check`].
    pub fn ask(&self) -> Result<(), GpuError> {
        if self.device.poll(wgpu::PollType::Poll).is_err() {
            log::debug!("the device could not be polled");
        }
        self.check()
    }

    /// The loss that caused an error, if one did: wgpu calls whatever a lost device gives invalid, and tells of the loss itself
    /// only when it is polled.
    fn or_lost(&self, error: GpuError) -> GpuError {
        let slice = wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(Duration::from_secs(5)),
        };
        if self.device.poll(slice).is_err() {
            log::debug!("polling after an error failed as well");
        }
        let lost = lock(&self.faults.lost).clone();
        lost.map_or(error, GpuError::Lost)
    }

    /// Runs calls of wgpu and returns the first error that they caused on this thread.
    ///
    /// # Errors
    /// Whatever wgpu found wrong; `what` says in it what was being done.
    pub fn scoped<T>(&self, what: &str, calls: impl FnOnce(&wgpu::Device) -> T) -> Result<T, GpuError> {
        self.check()?;
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = calls(&self.device);
        let mut first = None;
        for scope in [validation, internal, memory] {
            first = first.or(pollster::block_on(scope.pop()));
        }
        match first {
            Some(error) => Err(self.or_lost(typed(what, error))),
            None => self.check().map(|()| result),
        }
    }

    /// Waits until the GPU has done everything that was submitted.
    ///
    /// # Errors
    /// The device was lost, or did not answer for a quarter of an hour.
    pub fn wait(&self) -> Result<(), GpuError> {
        self.check()?;
        // In one wait: where one ends by time while another thread submits or waits, wgpu 30 may panic over a queue that the other one emptied.
        let all = wgpu::PollType::Wait {
            submission_index: None,
            timeout: Some(PATIENCE),
        };
        match self.device.poll(all) {
            Ok(_) => self.check(),
            Err(error) => Err(GpuError::Driver {
                what: "waiting for the GPU".into(),
                message: error.to_string(),
            }),
        }
    }

    /// Makes a buffer with these contents, padded with zeros to at least `size` bytes and a multiple of 4.
    ///
    /// # Errors
    /// No memory, or larger than the device allows.
    pub fn buffer(&self, what: &str, usage: wgpu::BufferUsages, contents: &[u8], size: u64) -> Result<wgpu::Buffer, GpuError> {
        let size = size.max(contents.len() as u64).max(4).next_multiple_of(4);
        self.scoped(what, |device| {
            let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            let whole = contents.len() & !3;
            if whole > 0 {
                self.queue.write_buffer(&buffer, 0, &contents[..whole]);
            }
            if whole < contents.len() {
                let mut last = [0; 4];
                last[..contents.len() - whole].copy_from_slice(&contents[whole..]);
                self.queue.write_buffer(&buffer, whole as u64, &last);
            }
            buffer
        })
    }

    /// Submits the commands, waits, and copies the first `size` bytes of `source` to the host. `source` is a `COPY_SRC` buffer.
    ///
    /// # Errors
    /// The commands are invalid, or the device fails.
    pub fn read(&self, what: &str, mut commands: wgpu::CommandEncoder, source: &wgpu::Buffer, size: u64) -> Result<Vec<u8>, GpuError> {
        let padded = size.next_multiple_of(4);
        let staging = self.scoped(what, |device| {
            let staging = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size: padded,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            commands.copy_buffer_to_buffer(source, 0, &staging, 0, padded);
            self.queue.submit([commands.finish()]);
            staging
        })?;
        let failed = |message: String| GpuError::Driver {
            what: what.to_owned(),
            message,
        };
        let (sender, receiver) = mpsc::channel();
        // The receiver lives until the end of this function, and nobody else waits for what is sent.
        staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        self.wait()?;
        // Another thread's poll may be the one that runs the callback, a moment after this thread's has returned.
        match receiver.recv_timeout(PATIENCE) {
            Ok(Ok(())) => {}
            Ok(Err(error)) => return Err(failed(error.to_string())),
            Err(_) => return Err(failed("the buffer was not mapped".into())),
        }
        let mut bytes = staging.slice(..).get_mapped_range().map_err(|e| failed(e.to_string()))?.to_vec();
        bytes.truncate(usize::try_from(size).unwrap_or(usize::MAX));
        Ok(bytes)
    }
}

/// wgpu's error as ours.
fn typed(what: &str, error: wgpu::Error) -> GpuError {
    let what = what.to_owned();
    match error {
        wgpu::Error::OutOfMemory { .. } => GpuError::OutOfMemory { what },
        wgpu::Error::Validation { description, .. } => GpuError::Invalid {
            what,
            message: description,
        },
        wgpu::Error::Internal { description, .. } => GpuError::Driver {
            what,
            message: description,
        },
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches wgpu's own handler, which panics, and an error that is lost or returned for ever.
    #[test]
    fn an_uncaptured_error_is_returned_once_by_the_next_call() {
        let own = Gpu::headless().unwrap();
        let gpu = Gpu::from_parts(own.device().clone(), own.queue().clone());
        drop(gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("wrong"),
            size: 4,
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::MAP_WRITE,
            mapped_at_creation: false,
        }));
        let next = gpu.buffer("next", wgpu::BufferUsages::UNIFORM, &[1, 2, 3], 0);
        assert!(
            matches!(&next, Err(GpuError::Invalid { what, .. }) if what == "a GPU command"),
            "{next:?}"
        );
        assert!(gpu.buffer("next", wgpu::BufferUsages::UNIFORM, &[1, 2, 3], 0).is_ok());
    }

    /// Catches a request for more than there is that panics or comes back as something else.
    #[test]
    fn a_buffer_beyond_the_limits_is_an_error() {
        let gpu = crate::gpu::testing::gpu();
        let huge = gpu.buffer("huge", wgpu::BufferUsages::STORAGE, &[], 1 << 50);
        assert!(
            matches!(huge, Err(GpuError::Invalid { .. } | GpuError::OutOfMemory { .. })),
            "{huge:?}"
        );
    }

    /// Catches bytes lost at the end of odd lengths, on the way there or back.
    #[test]
    fn odd_bytes_come_back() {
        let gpu = crate::gpu::testing::gpu();
        for length in [1, 3, 4, 7] {
            let bytes: Vec<u8> = (1..=length).collect();
            let buffer = gpu.buffer("odd", wgpu::BufferUsages::COPY_SRC, &bytes, 0).unwrap();
            let commands = gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            assert_eq!(gpu.read("odd", commands, &buffer, u64::from(length)).unwrap(), bytes);
        }
    }
}
