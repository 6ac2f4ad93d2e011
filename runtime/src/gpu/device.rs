//! The device: found or given, with errors that come back instead of panicking.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::GpuError;
use super::form::Form;

/// How long one submission may take. A software driver needs minutes for a large reference image; a driver that hangs needs forever.
pub(super) const PATIENCE: Duration = Duration::from_secs(900);

/// Features that are used where they are there.
const WELCOME: wgpu::Features = wgpu::Features::FLOAT32_FILTERABLE
    .union(wgpu::Features::FLOAT32_BLENDABLE)
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::PIPELINE_CACHE);

/// Whether the host's thread may wait for the GPU. On the web it may not: what is waited for comes only after the thread has gone back to the browser.
pub(super) const MAY_WAIT: bool = !cfg!(target_arch = "wasm32");

/// What the device's callbacks leave for the next call to find.
#[derive(Debug, Default)]
struct Faults {
    lost: Mutex<Option<String>>,
    uncaptured: Mutex<Option<GpuError>>,
}

impl Faults {
    /// Leaves an error, unless one is there that nobody has found yet.
    fn leave(&self, error: GpuError) {
        lock(&self.uncaptured).get_or_insert(error);
    }
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
    form: Form,
}

impl Gpu {
    /// What a device is to be asked for: the features of this adapter that are used where they are there, and its limits. For a host that opens the
    /// device itself and gives it to [`Gpu::from_parts`].
    pub fn descriptor(adapter: &wgpu::Adapter) -> wgpu::DeviceDescriptor<'static> {
        wgpu::DeviceDescriptor {
            label: Some("shadewright"),
            required_features: adapter.features() & WELCOME,
            required_limits: adapter.limits(),
            ..Default::default()
        }
    }

    /// Takes a caller's device. Its handlers of uncaptured errors and of loss are replaced: wgpu's own would panic.
    pub fn from_parts(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let faults = Arc::new(Faults::default());
        let seen = Arc::clone(&faults);
        device.on_uncaptured_error(Arc::new(move |error| {
            log::error!("uncaptured GPU error: {error}");
            seen.leave(typed("a GPU command", error));
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
            form: Form::default(),
        }
    }

    /// The same device, to which programs go in this form. What has been made stays as it is.
    #[must_use]
    pub fn with_form(mut self, form: Form) -> Self {
        self.form = form;
        self
    }

    /// In which form programs go to the device.
    pub fn form(&self) -> Form {
        self.form
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

    /// The adapter's name and driver in one line, for people and reports. Browsers tell neither.
    pub fn name(&self) -> String {
        let wgpu::AdapterInfo {
            name,
            driver_info,
            backend,
            ..
        } = &self.info;
        let name = if name.is_empty() { "a GPU without a name" } else { name };
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

    /// Runs calls of wgpu and returns the first error that they caused on this thread. On the web nobody knows yet: the error is what a later call of
    /// [`Gpu::check`] finds, and what was made is invalid.
    ///
    /// # Errors
    /// Whatever wgpu found wrong; `what` says in it what was being done.
    pub fn scoped<T>(&self, what: &str, calls: impl FnOnce(&wgpu::Device) -> T) -> Result<T, GpuError> {
        self.check()?;
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = calls(&self.device);
        match self.first_error(what, [validation, internal, memory]) {
            Some(error) => Err(self.or_lost(error)),
            None => self.check().map(|()| result),
        }
    }

    /// Ends the scopes in this order; the first error that one of them caught.
    #[cfg(not(target_arch = "wasm32"))]
    #[allow(clippy::unused_self, reason = "on the web it is where errors are left")]
    fn first_error(&self, what: &str, scopes: [wgpu::ErrorScopeGuard; 3]) -> Option<GpuError> {
        let errors = scopes.map(|scope| pollster::block_on(scope.pop()));
        errors.into_iter().flatten().next().map(|error| typed(what, error))
    }

    /// Ends the scopes in this order, and has the first error that one of them caught left for the next check.
    #[cfg(target_arch = "wasm32")]
    fn first_error(&self, what: &str, scopes: [wgpu::ErrorScopeGuard; 3]) -> Option<GpuError> {
        let (faults, what) = (Arc::clone(&self.faults), what.to_owned());
        let errors = scopes.map(wgpu::ErrorScopeGuard::pop);
        wasm_bindgen_futures::spawn_local(async move {
            for error in errors {
                if let Some(error) = error.await {
                    log::error!("{what}: {error}");
                    return faults.leave(typed(&what, error));
                }
            }
        });
        None
    }

    /// Waits until the GPU has done everything that was submitted. On the web it waits for nothing.
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
}
