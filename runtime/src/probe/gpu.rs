//! A probe's table on a GPU.

use std::sync::Arc;

use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::reflect::{Binding, Fill};

use super::{Batch, INPUT, OUTPUT, Probe, Table, is_host};
use crate::gpu::layout::GROUPS;
use crate::gpu::pack::size_with;
use crate::gpu::pipeline::{ComputePipeline, Pipelines};
use crate::gpu::resources::{Bound, bind_group, sampler, stand_in};
use crate::gpu::{Gpu, RuntimeError};

/// Most rows of one dispatch, so that a chunk's buffers stay small beside what the device has.
pub(super) const MOST_ROWS: u64 = 1 << 18;

/// A dispatch over some rows of a batch, ready.
pub(super) struct Dispatch {
    pipeline: Arc<ComputePipeline>,
    groups: Vec<wgpu::BindGroup>,
    workgroups: u32,
    /// Where the results go, and their size in bytes.
    pub results: wgpu::Buffer,
    pub size: u64,
}

impl Dispatch {
    /// Records the dispatch.
    pub fn record(&self, pass: &mut wgpu::ComputePass) {
        pass.set_pipeline(&self.pipeline.pipeline);
        for (index, group) in (0..).zip(&self.groups) {
            pass.set_bind_group(index, group, &[]);
        }
        pass.dispatch_workgroups(self.workgroups, 1, 1);
    }
}

impl Probe {
    /// The numbers of each row's result, in the order of the rows: see [`Probe::components`]. NaN and infinities are kept. Textures are white
    /// and host buffers zero.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn on_gpu(&self, pipelines: &Pipelines, gpu: &Gpu, table: &Table) -> Result<Vec<Vec<f64>>, RuntimeError> {
        let mut results = vec![Vec::new(); table.len()];
        self.run(pipelines, gpu, table, |row, bytes| results[row] = self.numbers(bytes))?;
        Ok(results)
    }

    /// Runs a table and hands out the bytes of each row's element of the output.
    pub(super) fn run(
        &self,
        pipelines: &Pipelines,
        gpu: &Gpu,
        table: &Table,
        mut result: impl FnMut(usize, &[u8]),
    ) -> Result<(), RuntimeError> {
        let most = self.most_rows(gpu);
        for batch in table.batches() {
            for rows in batch.rows.chunks(most) {
                let dispatch = self.dispatch(pipelines, gpu, table, batch, rows)?;
                let commands = gpu.scoped("probe", |device| {
                    let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
                    dispatch.record(&mut commands.begin_compute_pass(&wgpu::ComputePassDescriptor::default()));
                    commands
                })?;
                let bytes = gpu.read("probe", commands, &dispatch.results, dispatch.size)?;
                for (row, bytes) in rows.iter().zip(bytes.chunks(self.result.size.max(1) as usize)) {
                    result(*row, bytes);
                }
            }
        }
        Ok(())
    }

    /// Rows of a workgroup.
    fn workgroup(&self) -> u32 {
        let entry = self.program().reflection().entry_points.first();
        entry.and_then(|e| e.workgroup_size).map_or(1, |size| size[0]).max(1)
    }

    /// Most rows that the device takes in one dispatch.
    pub(super) fn most_rows(&self, gpu: &Gpu) -> usize {
        let limits = gpu.device().limits();
        let row = u64::from(self.result.size.max(self.arguments.as_ref().map_or(0, |a| a.size)).max(1));
        let most = MOST_ROWS
            .min(limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) / row)
            .min(u64::from(limits.max_compute_workgroups_per_dimension) * u64::from(self.workgroup()));
        usize::try_from(most).unwrap_or(1).max(1)
    }

    /// Binds rows of a batch, which may repeat; there are at most [`Probe::most_rows`].
    pub(super) fn dispatch(
        &self,
        pipelines: &Pipelines,
        gpu: &Gpu,
        table: &Table,
        batch: &Batch,
        rows: &[usize],
    ) -> Result<Dispatch, RuntimeError> {
        use wgpu::BufferUsages as U;
        let reflection = self.program().reflection();
        let entry = reflection.entry_points.first().map_or("", |entry| &entry.name);
        let pipeline = pipelines.compute(self.program(), entry, &batch.constants)?;
        let size = self.output().map_or(0, |(_, layout)| size_with(layout, rows.len()));
        let results = gpu.buffer("probe results", U::STORAGE | U::COPY_SRC, &[], size)?;
        let bound = |binding: &Binding| -> Result<Bound, RuntimeError> {
            let place = (binding.group, binding.binding);
            let buffer = |usage, bytes: Option<&Vec<u8>>| gpu.buffer(&binding.name, usage, bytes.map_or(&[], |b| b), 0);
            Ok(match &binding.fill {
                _ if is_host(binding, INPUT) => {
                    let mut bytes = Vec::with_capacity(rows.len() * table.row(0).len());
                    rows.iter().for_each(|row| bytes.extend_from_slice(table.row(*row)));
                    Bound::Buffer(buffer(U::STORAGE, Some(&bytes))?)
                }
                _ if is_host(binding, OUTPUT) => Bound::Buffer(results.clone()),
                Fill::Params => Bound::Buffer(buffer(U::UNIFORM, batch.blocks.get(&place))?),
                Fill::Instances { .. } => Bound::Buffer(buffer(U::STORAGE, batch.instances.get(&place))?),
                Fill::Resource {
                    declared: ResourceKind::Sampler { linear, repeat, compare },
                    ..
                } => sampler(gpu, *linear, *repeat, *compare)?,
                Fill::Resource {
                    declared: ResourceKind::Data { .. },
                    ..
                } => {
                    let numbers = self.data.get(&place).map_or(&[][..], |numbers| numbers);
                    Bound::Buffer(gpu.buffer(&binding.name, U::STORAGE, bytemuck::cast_slice(numbers), 0)?)
                }
                Fill::Resource { .. } => stand_in(gpu, binding)?,
            })
        };
        let groups = (0..).take(GROUPS).map(|group| bind_group(gpu, &pipeline, reflection, group, bound));
        let groups = groups.collect::<Result<_, _>>()?;
        let workgroups = u32::try_from(rows.len()).unwrap_or(u32::MAX).div_ceil(self.workgroup());
        Ok(Dispatch {
            pipeline,
            groups,
            workgroups,
            results,
            size,
        })
    }
}
