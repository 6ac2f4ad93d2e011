//! How long a probe's table takes on a GPU, against others'.

use std::sync::atomic::{AtomicBool, Ordering};

use super::gpu::Dispatch;
use super::{Probe, Table};
use crate::gpu::pipeline::Pipelines;
use crate::gpu::timer::Timer;
use crate::gpu::{DataError, Gpu, RuntimeError};

/// Rows of the first trial: enough invocations to fill a GPU; a software driver has two or four at a time.
const HARDWARE_ROWS: usize = 1 << 16;
const SOFTWARE_ROWS: usize = 1 << 8;
/// Most rows of a pass: beyond, dispatches are repeated.
const MOST_ROWS: usize = 1 << 18;
/// How long a pass should take at least, so that the timestamps' grain and what a pass costs by itself do not count.
const LEAST_NANOSECONDS: f64 = 2e6;
/// Most repetitions of a pass's dispatches.
const MOST_DISPATCHES: usize = 4096;

/// Times alternatives against each other: a table of each, evaluated in one timed pass, all of them in turn, and that `repetitions` times over.
/// So what changes while they run, the clock of the GPU or another program, changes for all of them, and the ratio of two of one repetition
/// means something. Rows are repeated until a pass lasts 2 ms (and fills the GPU), which is found out once, while everything warms up. A pass is
/// submitted when the one before it is done.
///
/// Returns for each alternative the nanoseconds a row, one for each repetition; fetching the row and storing the result are in them. `stop` is
/// looked at before each repetition: when it is set, what was measured until then is returned, equally much for each alternative.
///
/// `None` where the device has no timestamp queries; on a software driver they are times of the CPU: see [`Gpu::is_software`].
///
/// # Errors
/// A table has no rows, or the GPU fails.
pub fn time(
    pipelines: &Pipelines,
    gpu: &Gpu,
    alternatives: &[(&Probe, &Table)],
    repetitions: usize,
    stop: &AtomicBool,
) -> Result<Option<Vec<Vec<f64>>>, RuntimeError> {
    if alternatives.iter().any(|(_, table)| table.is_empty()) {
        return Err(DataError::new("table", "there are no rows to time").into());
    }
    let Ok(mut timer) = Timer::new(gpu) else { return Ok(None) };
    let mut times = vec![Vec::new(); alternatives.len()];
    let mut loads = Vec::new();
    for (probe, table) in alternatives {
        if stop.load(Ordering::Relaxed) {
            return Ok(Some(times));
        }
        loads.push(Load::calibrated(pipelines, &mut timer, gpu, probe, table)?);
    }
    for _ in 0..repetitions {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        for (load, times) in loads.iter().zip(&mut times) {
            times.push(load.run(&mut timer, gpu)? / load.all_rows() as f64);
        }
    }
    Ok(Some(times))
}

/// What one pass of an alternative does.
struct Load {
    dispatches: Vec<Dispatch>,
    rows: usize,
    times: usize,
}

impl Load {
    /// The table's rows, repeated so often that a pass takes its time.
    fn calibrated(pipelines: &Pipelines, timer: &mut Timer, gpu: &Gpu, probe: &Probe, table: &Table) -> Result<Self, RuntimeError> {
        let mut wanted = if gpu.is_software() { SOFTWARE_ROWS } else { HARDWARE_ROWS };
        loop {
            let mut load = Self::of(pipelines, gpu, probe, table, wanted)?;
            // The first one warms up: drivers compile when they draw, clocks are low.
            load.run(timer, gpu)?;
            let taken = load.run(timer, gpu)?.max(1.0);
            let missing = LEAST_NANOSECONDS / taken;
            if missing <= 1.0 {
                return Ok(load);
            }
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // above 1, and cut where it is large
            let factor = missing.ceil().min(MOST_DISPATCHES as f64) as usize;
            if load.rows >= MOST_ROWS {
                load.times = factor;
                return Ok(load);
            }
            wanted = load.rows.saturating_mul(factor.clamp(2, 16)).min(MOST_ROWS);
        }
    }

    /// A table's rows, repeated until there are as many as are wanted, in dispatches as large as the device takes.
    fn of(pipelines: &Pipelines, gpu: &Gpu, probe: &Probe, table: &Table, wanted: usize) -> Result<Self, RuntimeError> {
        let copies = wanted.div_ceil(table.len()).max(1);
        let most = probe.most_rows(gpu);
        let mut dispatches = Vec::new();
        for batch in table.batches() {
            let rows: Vec<usize> = batch.rows.iter().copied().cycle().take(batch.rows.len() * copies).collect();
            for rows in rows.chunks(most) {
                dispatches.push(probe.dispatch(pipelines, gpu, table, batch, rows)?);
            }
        }
        Ok(Self {
            dispatches,
            rows: table.len() * copies,
            times: 1,
        })
    }

    /// Rows of a pass.
    fn all_rows(&self) -> usize {
        self.rows * self.times
    }

    /// Nanoseconds of one pass.
    fn run(&self, timer: &mut Timer, gpu: &Gpu) -> Result<f64, RuntimeError> {
        gpu.scoped("timing a probe", |device| {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let query = timer.begin(String::new(), &mut commands);
            let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: None,
                timestamp_writes: query.compute_pass_timestamp_writes(),
            });
            for _ in 0..self.times {
                self.dispatches.iter().for_each(|dispatch| dispatch.record(&mut pass));
            }
            drop(pass);
            timer.end(&mut commands, query);
            timer.resolve(&mut commands);
            gpu.queue().submit([commands.finish()]);
        })?;
        timer.submitted()?;
        Ok(timer.wait()?.iter().map(|(_, nanoseconds)| nanoseconds).sum())
    }
}
