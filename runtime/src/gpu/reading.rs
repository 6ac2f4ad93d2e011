//! The way of bytes from the GPU to the host, with and without waiting.

use std::sync::mpsc;

use super::device::{MAY_WAIT, PATIENCE};
use super::{Gpu, GpuError};

/// Bytes on their way from a buffer to the host: see [`Gpu::start_read`].
#[derive(Debug)]
pub struct Reading {
    what: String,
    staging: wgpu::Buffer,
    size: usize,
    mapped: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Gpu {
    /// Submits the commands, and then a copy of the first `size` bytes of `source` to the host. `source` is a `COPY_SRC` buffer. Does not wait: what
    /// comes back says when the bytes are there.
    ///
    /// # Errors
    /// The commands are invalid, or the device fails.
    pub fn start_read(
        &self,
        what: &str,
        mut commands: wgpu::CommandEncoder,
        source: &wgpu::Buffer,
        size: u64,
    ) -> Result<Reading, GpuError> {
        let padded = size.next_multiple_of(4);
        let staging = self.scoped(what, |device| {
            let staging = device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(what),
                size: padded,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            });
            commands.copy_buffer_to_buffer(source, 0, &staging, 0, padded);
            self.queue().submit([commands.finish()]);
            staging
        })?;
        let (sender, mapped) = mpsc::channel();
        // Where the reading was dropped nobody waits for what is sent.
        staging.map_async(wgpu::MapMode::Read, .., move |result| drop(sender.send(result)));
        Ok(Reading {
            what: what.to_owned(),
            staging,
            size: usize::try_from(size).unwrap_or(usize::MAX),
            mapped,
        })
    }

    /// As [`Gpu::start_read`], and waits for the bytes.
    ///
    /// # Errors
    /// The commands are invalid, or the device fails. [`GpuError::Unsupported`] on the web, where nobody may wait.
    pub fn read(&self, what: &str, commands: wgpu::CommandEncoder, source: &wgpu::Buffer, size: u64) -> Result<Vec<u8>, GpuError> {
        if !MAY_WAIT {
            return Err(GpuError::Unsupported {
                what: what.to_owned(),
                needs: "a thread that may wait for the GPU".into(),
            });
        }
        let reading = self.start_read(what, commands, source, size)?;
        self.wait()?;
        // Another thread's poll may be the one that runs the callback, a moment after this thread's has returned.
        match reading.mapped.recv_timeout(PATIENCE) {
            Ok(mapped) => reading.bytes(mapped),
            Err(_) => Err(reading.failed("the buffer was not mapped")),
        }
    }
}

impl Reading {
    /// The bytes, once, as soon as the GPU has them: `None` means not yet. Does not wait.
    ///
    /// # Errors
    /// The device failed, or the bytes have been taken already.
    pub fn take(&mut self, gpu: &Gpu) -> Option<Result<Vec<u8>, GpuError>> {
        // wgpu says that a buffer is there only while it is polled.
        if let Err(error) = gpu.ask() {
            return Some(Err(error));
        }
        match self.mapped.try_recv() {
            Ok(mapped) => Some(self.bytes(mapped)),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(self.failed("nothing is left to take"))),
        }
    }

    fn bytes(&self, mapped: Result<(), wgpu::BufferAsyncError>) -> Result<Vec<u8>, GpuError> {
        mapped.map_err(|error| self.failed(error))?;
        let mut bytes = {
            let range = self.staging.slice(..).get_mapped_range();
            range.map_err(|error| self.failed(error))?.to_vec()
        };
        bytes.truncate(self.size);
        self.staging.unmap();
        Ok(bytes)
    }

    fn failed(&self, why: impl ToString) -> GpuError {
        GpuError::Driver {
            what: self.what.clone(),
            message: why.to_string(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    fn commands(gpu: &Gpu) -> wgpu::CommandEncoder {
        gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
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

    /// Catches a reading that waits for the next submission, gives the bytes of another, or gives them twice.
    #[test]
    fn readings_come_without_waiting_each_once() {
        let gpu = crate::gpu::testing::gpu();
        let start = |byte: u8| {
            let buffer = gpu.buffer("source", wgpu::BufferUsages::COPY_SRC, &[byte; 5], 0).unwrap();
            gpu.start_read("reading", commands(&gpu), &buffer, 5).unwrap()
        };
        let mut readings = [1, 2, 3].map(|byte| (byte, start(byte)));
        for (byte, reading) in readings.iter_mut().rev() {
            let begun = Instant::now();
            let bytes = loop {
                match reading.take(&gpu) {
                    Some(bytes) => break bytes.unwrap(),
                    None if begun.elapsed() < Duration::from_secs(60) => std::thread::sleep(Duration::from_millis(1)),
                    None => panic!("the bytes do not come"),
                }
            };
            assert_eq!(bytes, [*byte; 5]);
            let again = reading.take(&gpu);
            assert!(
                matches!(&again, Some(Err(GpuError::Driver { message, .. })) if message == "nothing is left to take"),
                "{again:?}"
            );
        }
    }
}
