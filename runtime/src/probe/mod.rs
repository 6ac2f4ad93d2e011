//! Evaluates one function of a recipe over a table of inputs.
//!
//! ```text
//! recipe, function -> Probe: a compute program that calls the function once for each row
//! rows of JSON     -> Table: bytes, in batches that share parameters and instances     (table)
//! Probe, Table     -> numbers of the results, on a GPU                                 (gpu)
//!                  -> the same numbers on the CPU, in f32, f64, or with bounds          (cpu)
//! several of these -> how long each takes on it, against the others                    (time)
//! ```

mod cpu;
mod gpu;
mod numbers;
mod table;
mod time;

use std::sync::OnceLock;

use naga::Expression;
use serde_json::{Value as Json, json};
use shadewright_compiler::Report;
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::ResourceKind;
use shadewright_compiler::program::{Program, Recipe};
use shadewright_compiler::reflect::{Binding, BindingType, Fill, Layout};
use shadewright_evaluate::cost::{Analysis, cost_of_function};
use shadewright_evaluate::{EvaluateError, Program as Evaluator};

use crate::data;
use crate::gpu::pack::unpack;
use crate::gpu::pipeline::Pipelines;
use crate::gpu::{Gpu, GpuError, RuntimeError};
use numbers::{Number, numbers};
use table::Names;

pub use cpu::{Evaluated, Written};
pub use table::{Batch, Table};
pub use time::time;

/// Host resources that the table's two buffers are, as the compiler makes them.
const INPUT: &str = "probe_input";
const OUTPUT: &str = "probe_output";

/// A function of a recipe, ready to be evaluated.
#[derive(Debug)]
pub struct Probe {
    function: String,
    program: Program,
    names: Names,
    /// Layout of a row's arguments; none where the program reads none.
    arguments: Option<Layout>,
    /// Layout of an element of the output: a struct with the member `value`.
    result: Layout,
    /// The result's numbers.
    numbers: Vec<Number>,
    /// Numbers of the bindings of kind `Data`, by group and binding.
    data: data::Tables,
    /// The program for the CPU, without pipeline constants.
    evaluator: OnceLock<Result<Evaluator, EvaluateError>>,
}

impl Probe {
    /// Links the program that evaluates a function of the interface that the recipe's root has.
    ///
    /// # Errors
    /// The recipe or the function is wrong, a file of data cannot be used, or no buffer holds the function's result.
    pub fn new(catalog: &Catalog, recipe: &Recipe, function: &str) -> Result<Self, RuntimeError> {
        let program = catalog.compile_probe(recipe, function)?;
        let names = Names::of(catalog, program.reflection());
        let element = |name: &str| {
            let (_, layout) = table_buffer(&program, name)?;
            layout.element.as_deref().cloned()
        };
        let result = element(OUTPUT).ok_or_else(|| GpuError::Unsupported {
            what: "probing".into(),
            needs: "a result that a buffer can hold".into(),
        })?;
        let data = data::load_all(&program).map_err(Report::from)?;
        Ok(Self {
            function: function.to_owned(),
            data,
            arguments: element(INPUT),
            numbers: result.members.iter().flat_map(|value| numbers(&value.layout)).collect(),
            result,
            names,
            program,
            evaluator: OnceLock::new(),
        })
    }

    /// The function's name.
    pub fn function(&self) -> &str {
        &self.function
    }

    /// The program: see [`Catalog::compile_probe`].
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The buffer that holds a table's rows, and the layout of its array; none where the function reads no argument.
    pub fn input(&self) -> Option<(&Binding, &Layout)> {
        table_buffer(&self.program, INPUT)
    }

    /// The buffer that gets the results, and the layout of its array.
    pub fn output(&self) -> Option<(&Binding, &Layout)> {
        table_buffer(&self.program, OUTPUT)
    }

    /// What a call of the function costs: see [`cost_of_function`]. The table's own buffers and the code that reads and writes them do not count.
    pub fn cost(&self) -> Analysis {
        let (module, info) = (self.program.validated().module(), self.program.validated().info());
        let entry = module.entry_points.first().map(|entry| &entry.function.expressions);
        let called = entry
            .into_iter()
            .flat_map(|expressions| expressions.iter())
            .find_map(|(_, e)| match e {
                Expression::CallResult(function) => Some(*function),
                _ => None,
            });
        // A probe calls its function, which has a result: without one there is no output.
        called.map_or_else(Analysis::default, |function| cost_of_function(module, info, function))
    }

    /// The tables that fill bindings of kind `Data`, in the order of group and binding.
    pub fn tables(&self) -> Vec<&[f32]> {
        let mut tables: Vec<_> = self.data.iter().collect();
        tables.sort_by_key(|(place, _)| **place);
        tables.into_iter().map(|(_, numbers)| &**numbers).collect()
    }

    /// Names of a result's numbers, in the order in which [`Probe::on_gpu`] gives them: empty for a scalar, `x` of a vector, `diffuse.x` of a
    /// struct's member, `[0].x` of an array's element or a matrix's column.
    pub fn components(&self) -> Vec<String> {
        self.numbers.iter().map(|number| number.name.clone()).collect()
    }

    /// Numbers of a result, from the bytes of its element in the output buffer: f32 and integers as they are, booleans 0 and 1.
    pub fn numbers(&self, element: &[u8]) -> Vec<f64> {
        self.numbers.iter().map(|number| number.read(element)).collect()
    }

    /// Packs rows. A row is an object with one member for each argument, and may have `"params"` and `"instances"`.
    ///
    /// Struct members that a row leaves out have the interface's default, else zero; a module with instances has one, with its defaults,
    /// unless the row lists some.
    ///
    /// # Errors
    /// A row does not fit the function or the recipe; its path begins with the row's number, `[3].s.normal`.
    pub fn table(&self, rows: &[Json]) -> Result<Table, RuntimeError> {
        Ok(table::pack_rows(
            self.program.reflection(),
            self.arguments.as_ref(),
            &self.names,
            rows,
        )?)
    }

    /// Packs rows that differ from one row in some numbers only, each of which is a column: `s.alpha`, `v.x`, named as in
    /// [`Probe::components`]. Where rows of JSON take longer than what is done with them.
    ///
    /// # Errors
    /// The row does not fit, no argument has a number of a column's name that is an f32, or columns differ in length.
    pub fn varied(&self, row: &Json, columns: &[(&str, &[f32])]) -> Result<Table, RuntimeError> {
        let numbers = self.arguments.as_ref().map(numbers).unwrap_or_default();
        Ok(self.table(std::slice::from_ref(row))?.varied(&numbers, columns)?)
    }

    /// Results of a table as `probe` gives them: `{"function", "device", "results"}`, the results in the order of the rows, in the form that
    /// inputs have.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn answer(&self, pipelines: &Pipelines, gpu: &Gpu, table: &Table) -> Result<Json, RuntimeError> {
        let mut results = vec![Json::Null; table.len()];
        self.run(pipelines, gpu, table, |row, bytes| {
            results[row] = match unpack(&self.result, bytes) {
                Json::Object(mut object) if object.contains_key("value") => object["value"].take(),
                other => other,
            };
        })?;
        Ok(json!({"function": self.function, "device": gpu.name(), "results": results}))
    }
}

/// The buffer of a probe's table under this name, and the layout of its array.
fn table_buffer<'p>(program: &'p Program, name: &str) -> Option<(&'p Binding, &'p Layout)> {
    let found = program.reflection().bindings.iter().find(|b| is_host(b, name))?;
    match &found.ty {
        BindingType::Storage { layout, .. } => Some((found, layout)),
        _ => None,
    }
}

/// Whether the host fills the binding under this name.
fn is_host(binding: &Binding, name: &str) -> bool {
    matches!(&binding.fill, Fill::Resource { declared: ResourceKind::Host(host), .. } if host == name)
}

/// Evaluates a function of the recipe's root on the GPU: see [`Probe::table`] and [`Probe::answer`]. Textures are white and host buffers zero.
///
/// # Errors
/// The recipe or the function is wrong, a row does not fit the function, or the GPU fails.
pub fn probe(gpu: &Gpu, catalog: &Catalog, recipe: &Recipe, function: &str, inputs: &[Json]) -> Result<Json, RuntimeError> {
    let probe = Probe::new(catalog, recipe, function)?;
    let table = probe.table(inputs)?;
    probe.answer(&Pipelines::new(gpu, None), gpu, &table)
}

#[cfg(test)]
mod tests;
