//! A probe's table on the CPU, with any number type.

use rayon::prelude::*;
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::reflect::Fill;
use shadewright_evaluate::{Counts, EvaluateError, Invocation, Limits, Machine, Number, Program, Sampler, Value};

use super::{Batch, Probe, Table};
use crate::gpu::RuntimeError;

/// Rows that one machine evaluates after one another.
const ROWS: usize = 64;

/// Results of a table: one of each for each row, in their order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluated<N> {
    /// Numbers of the result: see [`Probe::components`].
    pub values: Vec<Vec<N>>,
    /// Whether it hung on a comparison that another conforming driver may answer otherwise. Only `Allowed` knows.
    pub undecided: Vec<bool>,
    /// Operations that the call executed.
    pub executed: Vec<Counts>,
}

/// What becomes of one row.
struct Row<N> {
    values: Vec<N>,
    undecided: bool,
    executed: Counts,
}

impl Probe {
    /// Evaluates a table on the CPU, on as many threads as rayon has; the numbers do not depend on how many. Textures are white and
    /// host buffers zero, as on a GPU.
    ///
    /// # Errors
    /// The function does what cannot be evaluated (derivatives, say), or does not end.
    pub fn on_cpu<N: Number>(&self, table: &Table) -> Result<Evaluated<N>, RuntimeError> {
        let mut results: Vec<Option<Row<N>>> = (0..table.len()).map(|_| None).collect();
        for batch in table.batches() {
            let program = self.compiled(batch)?;
            let chunks: Vec<&[usize]> = batch.rows.chunks(ROWS).collect();
            let evaluated: Vec<Vec<Row<N>>> = chunks
                .par_iter()
                .map(|rows| self.evaluate(&program, table, batch, rows))
                .collect::<Result<_, _>>()?;
            for (row, result) in batch.rows.iter().zip(evaluated.into_iter().flatten()) {
                results[*row] = Some(result);
            }
        }
        let mut all = Evaluated {
            values: Vec::with_capacity(table.len()),
            undecided: Vec::with_capacity(table.len()),
            executed: Vec::with_capacity(table.len()),
        };
        for row in results.into_iter().flatten() {
            all.values.push(row.values);
            all.undecided.push(row.undecided);
            all.executed.push(row.executed);
        }
        Ok(all)
    }

    /// The program with a batch's pipeline constants.
    fn compiled(&self, batch: &Batch) -> Result<Program, EvaluateError> {
        let validated = self.program().validated();
        let entry = self.program().reflection().entry_points.first().map_or("", |entry| &entry.name);
        // wgpu takes a name also of a constant that has an id; the linker gives none.
        Program::new(validated.module(), validated.info(), entry, &batch.constants, Limits::default())
    }

    /// Evaluates some rows of a batch.
    fn evaluate<N: Number>(&self, program: &Program, table: &Table, batch: &Batch, rows: &[usize]) -> Result<Vec<Row<N>>, EvaluateError> {
        let mut machine = Machine::<N>::new(program)?;
        for binding in &self.program().reflection().bindings {
            let (group, number) = (binding.group, binding.binding);
            let bytes = match &binding.fill {
                Fill::Params => batch.blocks.get(&(group, number)),
                Fill::Instances { .. } => batch.instances.get(&(group, number)),
                Fill::Resource {
                    declared: ResourceKind::Sampler { linear, repeat, .. },
                    ..
                } => {
                    let (linear, repeat) = (*linear, *repeat);
                    machine.bind_sampler(group, number, Sampler { linear, repeat })?;
                    None
                }
                Fill::Resource { .. } => None,
            };
            if let Some(bytes) = bytes {
                machine.bind_buffer(group, number, bytes)?;
            }
        }
        if let Some((binding, _)) = self.input() {
            let bytes: Vec<u8> = rows.iter().flat_map(|row| table.row(*row)).copied().collect();
            machine.bind_buffer(binding.group, binding.binding, &bytes)?;
        }
        let Some((output, _)) = self.output() else { return Ok(Vec::new()) };
        let size = self.result.size as usize * rows.len();
        machine.bind_buffer(output.group, output.binding, &vec![0; size])?;
        let mut results = Vec::with_capacity(rows.len());
        for index in 0..rows.len() {
            let row = u32::try_from(index).unwrap_or(u32::MAX);
            machine.run(&Invocation {
                global_invocation_id: [row, 0, 0],
                ..Invocation::default()
            })?;
            results.push(Row {
                values: Vec::new(),
                undecided: machine.is_undecided(),
                executed: machine.executed_in_functions(),
            });
        }
        let values = machine.values(output.group, output.binding)?;
        for (result, values) in results.iter_mut().zip(values.chunks(self.numbers.len().max(1))) {
            result.values = values.iter().map(|value: &Value<N>| value.number()).collect();
        }
        Ok(results)
    }
}
