//! `probe`: values of an interface function on the GPU or on the CPU, over a table of inputs.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde_json::{Map, Value as Json};
use shadewright::evaluate::Allowed;
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

use super::failure::Failure;
use super::output::{Outputs, json};
use super::{Context, input};

/// Options of `probe`.
#[derive(Args)]
pub struct Options {
    /// File, inline RON tree, module name, or - for standard input
    recipe: String,
    /// Function of the root's interface
    function: String,
    /// Table of inputs: a JSON list of objects keyed by argument name, or *.csv with a column for each argument; - for JSON from standard input
    #[arg(long, value_name = "FILE")]
    inputs: PathBuf,
    /// Where to, instead of standard output
    #[arg(short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// What may compute it
    #[arg(long, value_enum, default_value_t = Device::Any)]
    device: Device,
    /// Numbers of the CPU
    #[arg(long, value_enum)]
    number: Option<Number>,
}

/// Devices to choose from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Device {
    /// The best that there is, a software driver where there is no other
    Any,
    /// Hardware only
    Gpu,
    /// No GPU at all: the program is evaluated
    Cpu,
}

/// Number types of the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Number {
    /// As a GPU that rounds correctly has it
    F32,
    /// The same formula in double precision
    F64,
    /// f32 with the lowest and highest that a conforming driver may give
    Allowed,
}

/// # Errors
/// The recipe, the function or the inputs are wrong; there is no GPU.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    if options.recipe == "-" && options.inputs == Path::new("-") {
        return Err(Failure::Usage("recipe and inputs cannot both come from standard input".to_owned()));
    }
    if options.number.is_some() && options.device != Device::Cpu {
        return Err(Failure::Usage("--number needs --device cpu: a GPU computes in f32".to_owned()));
    }
    let recipe = input::recipe(&options.recipe)?;
    let rows = rows(&options.inputs)?;
    // What is wrong with the recipe or the rows is said first, also where there is no GPU.
    let probe = Probe::new(&context.catalog, &recipe, &options.function)?;
    let table = probe.table(&rows)?;
    let results = match options.device {
        Device::Cpu => match options.number.unwrap_or(Number::F32) {
            Number::F32 => probe.answer_on_cpu::<f32>(&table)?,
            Number::F64 => probe.answer_on_cpu::<f64>(&table)?,
            Number::Allowed => probe.answer_on_cpu::<Allowed>(&table)?,
        },
        Device::Any | Device::Gpu => {
            let gpu = Gpu::headless()?;
            if options.device == Device::Gpu && gpu.is_software() {
                return Err(Failure::NoGpu(format!(
                    "there is no hardware GPU, only {}; `--device any` takes it",
                    gpu.name()
                )));
            }
            probe.answer(&Pipelines::new(&gpu, None), &gpu, &table)?
        }
    };
    let mut outputs = Outputs::default();
    let output = options.output.as_deref().unwrap_or(Path::new("-"));
    outputs.stage(output, format!("{}\n", json(&results)?).as_bytes())?;
    outputs.commit()
}

fn rows(path: &Path) -> Result<Vec<Json>, Failure> {
    let text = input::text(path)?;
    if path.extension().is_some_and(|extension| extension == "csv") {
        return rows_of_csv(&text).map_err(|why| Failure::message(format!("{}: {why}", path.display())));
    }
    serde_json::from_str(&text).map_err(|error| Failure::message(format!("{}: should be a JSON list of objects: {error}", path.display())))
}

/// Rows of a table whose header has the path of each column, `s.alpha`. A cell is JSON (`0.5`, `"[0, 0, 1]"`); an empty one says nothing.
fn rows_of_csv(text: &str) -> Result<Vec<Json>, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| error.to_string())?.clone();
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| error.to_string())?;
        let mut row = Map::new();
        for (path, cell) in header.iter().zip(&record).filter(|(_, cell)| !cell.is_empty()) {
            let value = serde_json::from_str(cell).unwrap_or_else(|_| Json::String(cell.to_owned()));
            put(&mut row, path, value)?;
        }
        rows.push(Json::Object(row));
    }
    Ok(rows)
}

fn put(row: &mut Map<String, Json>, path: &str, value: Json) -> Result<(), String> {
    let Some((first, rest)) = path.split_once('.') else {
        return match row.insert(path.to_owned(), value) {
            None => Ok(()),
            Some(_) => Err(format!("there are two columns for `{path}`")),
        };
    };
    match row.entry(first).or_insert_with(|| Json::Object(Map::new())) {
        Json::Object(inner) => put(inner, rest, value),
        _ => Err(format!("there are columns for `{first}` and for a part of it")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Catches columns that don't nest, empty cells taken for values, and vectors taken for text.
    #[test]
    fn columns_are_paths() {
        let text = "s.alpha, s.f0, v, params.width\n0.5,\"[1, 1, 1]\",\"[0, 0, 1]\", 2700 K\n, ,\"[0, 1, 0]\",\n";
        assert_eq!(
            rows_of_csv(text),
            Ok(vec![
                json!({"s": {"alpha": 0.5, "f0": [1, 1, 1]}, "v": [0, 0, 1], "params": {"width": "2700 K"}}),
                json!({"v": [0, 1, 0]}),
            ])
        );
    }

    /// Catches columns that overwrite each other, and ragged tables.
    #[test]
    fn contradicting_columns_are_errors() {
        assert_eq!(rows_of_csv("a,a\n1,2\n"), Err("there are two columns for `a`".to_owned()));
        assert_eq!(
            rows_of_csv("a,a.b\n1,2\n"),
            Err("there are columns for `a` and for a part of it".to_owned())
        );
        assert!(rows_of_csv("a,b\n1\n").is_err_and(|why| why.contains("record 1")));
    }
}
