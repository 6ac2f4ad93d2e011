//! A probe's table on the CPU, with any number type.

use rayon::prelude::*;
use serde_json::{Value as Json, json};
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::reflect::{Fill, Layout, Member};
use shadewright_evaluate::{Allowed, Counts, EvaluateError, Invocation, Limits, Machine, Number, Program, Sampler, Value};

use super::{Batch, Probe, Table};
use crate::gpu::RuntimeError;
use crate::gpu::pack::Shape;

/// Rows that one machine evaluates after one another.
const ROWS: usize = 64;

/// Numbers of a table for which a machine evaluates a row more: copying them takes about as long as that row.
const NUMBERS: usize = 512;

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
    values: Vec<Value<N>>,
    undecided: bool,
    executed: Counts,
}

/// A number type whose numbers can be written.
pub trait Written: Number {
    /// A number as JSON; NaN and infinities as text.
    fn json(self) -> Json;
}

impl Written for f32 {
    fn json(self) -> Json {
        // The f64 nearest to the f32's shortest decimal form prints as that form, and rounds back to the f32.
        written(self.to_string().parse().unwrap_or(f64::NAN))
    }
}

impl Written for f64 {
    fn json(self) -> Json {
        written(self)
    }
}

impl Written for Allowed {
    /// `{"value", "low", "high"}`, the bounds infinite where anything goes.
    fn json(self) -> Json {
        json!({"value": self.value().json(), "low": written(self.low()), "high": written(self.high())})
    }
}

fn written(x: f64) -> Json {
    if x.is_nan() {
        "NaN".into()
    } else if x.is_infinite() {
        if x > 0.0 { "Infinity" } else { "-Infinity" }.into()
    } else {
        x.into()
    }
}

/// Numbers as the JSON of a layout, as inputs have it.
fn nested<N: Written>(layout: &Layout, numbers: &mut impl Iterator<Item = Value<N>>) -> Json {
    if !layout.members.is_empty() {
        let member = |m: &Member| (m.name.clone(), nested(&m.layout, numbers));
        return Json::Object(layout.members.iter().map(member).collect());
    }
    if let Some(element) = &layout.element {
        return (0..layout.count.unwrap_or(0)).map(|_| nested(element, numbers)).collect();
    }
    let Some(shape) = Shape::of(&layout.ty) else { return Json::Null };
    let mut one = || match numbers.next() {
        Some(Value::Float(x)) => x.json(),
        Some(Value::Int(x)) => x.into(),
        Some(Value::Uint(x)) => x.into(),
        Some(Value::Bool(x)) => x.into(),
        None => Json::Null,
    };
    let mut column = || Json::Array((0..shape.rows).map(|_| one()).collect());
    match (shape.rows, shape.columns) {
        (1, 1) => one(),
        (_, 1) => column(),
        (_, columns) => Json::Array((0..columns).map(|_| column()).collect()),
    }
}

impl Probe {
    /// Evaluates a table on the CPU, on as many threads as rayon has; the numbers do not depend on how many. Textures are white and
    /// host buffers zero, as on a GPU. Integers become numbers, which f32 has exactly up to 2^24.
    ///
    /// # Errors
    /// The function does what cannot be evaluated (derivatives, say), or does not end.
    pub fn on_cpu<N: Number>(&self, table: &Table) -> Result<Evaluated<N>, RuntimeError> {
        let rows = self.evaluated::<N>(table)?;
        let mut all = Evaluated {
            values: Vec::with_capacity(rows.len()),
            undecided: Vec::with_capacity(rows.len()),
            executed: Vec::with_capacity(rows.len()),
        };
        for row in rows {
            all.values.push(row.values.into_iter().map(Value::number).collect());
            all.undecided.push(row.undecided);
            all.executed.push(row.executed);
        }
        Ok(all)
    }

    /// Results of a table as `probe` gives them, see [`Probe::answer`]; the device is `cpu` and the number type. Where numbers have
    /// bounds, `"undecided"` lists the rows that hang on a comparison.
    ///
    /// # Errors
    /// As for [`Probe::on_cpu`].
    pub fn answer_on_cpu<N: Written>(&self, table: &Table) -> Result<Json, RuntimeError> {
        let (mut results, mut undecided) = (Vec::with_capacity(table.len()), Vec::new());
        for (i, row) in self.evaluated::<N>(table)?.into_iter().enumerate() {
            results.push(match nested(&self.result, &mut row.values.into_iter()) {
                Json::Object(mut object) if object.contains_key("value") => object["value"].take(),
                other => other,
            });
            if row.undecided {
                undecided.push(i);
            }
        }
        let mut answer = json!({"function": self.function, "device": format!("cpu {}", N::NAME), "results": results});
        if N::SPREADS {
            answer["undecided"] = undecided.into();
        }
        Ok(answer)
    }

    fn evaluated<N: Number>(&self, table: &Table) -> Result<Vec<Row<N>>, RuntimeError> {
        let mut results: Vec<Option<Row<N>>> = (0..table.len()).map(|_| None).collect();
        for batch in table.batches() {
            let own;
            let program = if batch.constants.is_empty() {
                let made = self.evaluator.get_or_init(|| self.compiled(batch));
                made.as_ref().map_err(Clone::clone)?
            } else {
                own = self.compiled(batch)?;
                &own
            };
            let chunks: Vec<&[usize]> = batch.rows.chunks(self.rows_together()).collect();
            let evaluated: Vec<Vec<Row<N>>> = chunks
                .par_iter()
                .map(|rows| self.evaluate(program, table, batch, rows))
                .collect::<Result<_, _>>()?;
            for (row, result) in batch.rows.iter().zip(evaluated.into_iter().flatten()) {
                results[*row] = Some(result);
            }
        }
        // Every row is in a batch.
        Ok(results.into_iter().flatten().collect())
    }

    /// Rows that one machine evaluates: more where a machine has large tables to begin with.
    fn rows_together(&self) -> usize {
        let numbers: usize = self.data.values().map(|numbers| numbers.len()).sum();
        ROWS.max(numbers / NUMBERS)
    }

    /// The program with a batch's pipeline constants.
    fn compiled(&self, batch: &Batch) -> Result<Program, EvaluateError> {
        let validated = self.program().validated();
        let entry = self.program().reflection().entry_points.first().map_or("", |entry| &entry.name);
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
            if let Some(numbers) = self.data.get(&(group, number)) {
                machine.bind_buffer(group, number, bytemuck::cast_slice(numbers))?;
            }
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
            result.values = values.to_vec();
        }
        Ok(results)
    }
}
