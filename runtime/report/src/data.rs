//! What a report says: plain data, written as JSON and drawn as a page.
//!
//! Numbers that are not finite have no place in JSON: they are `null` there, and a count says that they were. Read again, such a `null` is NaN.

use indexmap::IndexMap;
use serde::{Deserialize, Deserializer, Serialize};
use serde_json::Value as Json;
pub use shadewright_evaluate::cost::{Cost, cost_of};

/// A number that is `null` where it was not finite.
fn or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// Two of these.
fn pair_or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 2], D::Error> {
    Ok(<[Option<f64>; 2]>::deserialize(deserializer)?.map(|number| number.unwrap_or(f64::NAN)))
}

/// A whole report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Where and when the figures come from.
    pub provenance: Provenance,
    /// One for each experiment, in the order of categories and files.
    pub experiments: Vec<Results>,
    /// Device against evaluator, a row for each function of each module that can be probed.
    pub agreement: Vec<Agreement>,
    /// Modules without a row in any experiment: name, and why.
    pub without: IndexMap<String, String>,
    /// Best fits to tables of measured reflectance, where some were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fits: Vec<Fits>,
}

/// Best fits of models to a table of measured reflectance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fits {
    /// Name of the table's file.
    pub name: String,
    /// Its format, for people.
    pub format: String,
    /// Samples of the table that were fitted to.
    pub fitted: usize,
    /// Samples that the errors are over; the fitted ones are among them.
    pub compared: usize,
    /// The models, the best first.
    pub rows: Vec<Fit>,
    /// Models without a fit: name, and why.
    pub without: IndexMap<String, String>,
}

/// A model's best fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Name of the model.
    pub label: String,
    /// Its recipe, as RON.
    pub recipe: String,
    /// Summary of the recipe's root module.
    pub summary: String,
    /// What was free, and what it became.
    pub parameters: Vec<Fitted>,
    /// Of `ln(1 + f cos)`, by channel.
    pub errors: FitErrors,
    /// What one call executes at the table's samples.
    pub executed: Executed,
    /// How often the model was evaluated over the fitted samples.
    pub evaluations: usize,
    /// Another row is no worse in error and in cost, and better in one.
    pub dominated: bool,
}

/// Errors of a fit over the table's samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FitErrors {
    /// Root of the mean square.
    #[serde(deserialize_with = "or_nan")]
    pub rms: f64,
    /// Not exceeded by 95 % of the samples' channels.
    #[serde(deserialize_with = "or_nan")]
    pub p95: f64,
    /// The largest.
    #[serde(deserialize_with = "or_nan")]
    pub max: f64,
    /// Mean with its sign: above 0, the model is too high.
    #[serde(deserialize_with = "or_nan")]
    pub bias: f64,
}

/// What a free number or vector became.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fitted {
    /// Path of the argument, or name of the parameter.
    pub name: String,
    /// Its components.
    pub values: Vec<f64>,
    /// Least and largest value that it could have had.
    pub range: [f64; 2],
    /// Whether a component is at an end of the range: a better one may lie beyond.
    pub at_end: bool,
}

/// Where figures come from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    /// Name of the device; empty where none was used.
    pub device: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether the device is a CPU that runs a driver in software: its times are no GPU's.
    pub is_software: bool,
    /// Version of this program.
    pub version: String,
    /// Commit of the sources that the program was built from, where it knows it; with `+` where they had been edited then.
    pub commit: String,
    /// When it was made, RFC 3339, UTC; empty where a report must be reproducible.
    pub date: String,
}

/// Results of one experiment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// `category/name` or `category/module/name`: unique in the report.
    pub name: String,
    /// A line for people.
    pub title: String,
    /// What is compared and why, Markdown without headings.
    pub doc: String,
    /// Category whose modules are compared.
    pub category: String,
    /// Function of its interface.
    pub function: String,
    /// Name of the truth, for people.
    pub truth: String,
    /// `relative` or `absolute`, and the unit or floor, for people.
    pub metric: String,
    /// Configurations sampled, the hard ones not counted.
    pub configurations: usize,
    /// Hard configurations.
    pub hard: usize,
    /// Seed of the sampling.
    pub seed: u64,
    /// Whether all rows have one truth: if not, none is better than another.
    pub comparable: bool,
    /// Label of the row whose time is 1.
    pub baseline: String,
    /// One for each alternative.
    pub rows: Vec<Row>,
    /// All errors; none where a search looks further than the configurations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub samples: Option<Samples>,
}

/// Configurations and what each row is off by there.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Samples {
    /// Inputs: those drawn, then the hard ones.
    pub inputs: Vec<Json>,
    /// By label of the row, for each input the largest error of the result's numbers, in the experiment's metric; null where it is no number.
    pub errors: IndexMap<String, Vec<Option<f64>>>,
}

/// One alternative in one experiment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// Name in this experiment.
    pub label: String,
    /// Recipe, as RON.
    pub recipe: String,
    /// Summary of the recipe's root module.
    pub summary: String,
    /// The formula in double precision against the truth; none where the formula is its own truth.
    pub model: Option<Errors>,
    /// The formula in f32 on the device against itself in double precision; none without a device.
    pub rounding: Option<Errors>,
    /// The same with the evaluator's f32, which is the same on every machine.
    pub rounding_cpu: Errors,
    /// The error that WGSL's accuracy table allows a driver to make of it, not exceeded by 95 % of the numbers (elsewhere a branch may go either
    /// way); none where it allows anything.
    pub allowed: Option<f64>,
    /// What happened at hard inputs, and everywhere else.
    pub verdict: Verdict,
    /// What the linked program holds.
    pub cost: Cost,
    /// What one call executes.
    pub executed: Executed,
    /// Time on the device; none without one.
    pub time: Option<Time>,
    /// Another row is no worse in error and in cost, and better in one.
    pub dominated: bool,
    /// Slice of the domain through the worst input; none where the domain has one dimension or fewer.
    pub picture: Option<Picture>,
}

impl Row {
    /// Error of the result, RMS: of model and of rounding together, which have nothing to do with each other. The evaluator's rounding, so that
    /// it is the same on every machine.
    pub fn error(&self) -> f64 {
        self.model.as_ref().map_or(0.0, |errors| errors.rms).hypot(self.rounding_cpu.rms)
    }

    /// Whether the formula is another than the truth, by more than what rounding makes of it.
    pub fn is_approximate(&self) -> bool {
        self.model.as_ref().is_some_and(|errors| errors.rms > 4.0 * self.rounding_cpu.rms)
    }
}

/// Statistics of an error over the configurations, in the experiment's metric.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Root of the mean square.
    #[serde(deserialize_with = "or_nan")]
    pub rms: f64,
    /// Not exceeded by 95 % of the configurations.
    #[serde(deserialize_with = "or_nan")]
    pub p95: f64,
    /// Largest among the sampled and hard configurations.
    #[serde(deserialize_with = "or_nan")]
    pub max: f64,
    /// Mean with its sign: above 0, the module is too high.
    #[serde(deserialize_with = "or_nan")]
    pub bias: f64,
    /// Largest that a search found, at least `max`.
    #[serde(deserialize_with = "or_nan")]
    pub searched: f64,
    /// Where that is.
    pub worst: Worst,
}

/// One input and what came of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worst {
    /// A row of `probe`'s inputs, to replay it.
    pub input: Json,
    /// Which of the result's numbers: `x`, `diffuse.y`; empty for a scalar.
    pub component: String,
    /// What the module gave; NaN and infinities as text.
    pub got: Json,
    /// What it should have given.
    pub expected: Json,
}

/// How often something happened that must not, with one input each that makes it happen.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Not a number.
    pub nan: Fault,
    /// Infinite.
    pub infinite: Fault,
    /// Below 0 where the truth is not.
    pub negative: Fault,
    /// Jumps where the truth has none.
    pub discontinuous: Fault,
}

/// Count of a fault.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Configurations with it.
    pub count: usize,
    /// The worst of them.
    pub worst: Option<Worst>,
}

/// Operations that calls executed, over an experiment's configurations: the same kinds as [`Cost`], loops as often as they ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Executed {
    /// Mean of the weighted sum of operations. The weights stand in `spec/report.md`.
    #[serde(deserialize_with = "or_nan")]
    pub mean: f64,
    /// Its largest.
    #[serde(deserialize_with = "or_nan")]
    pub max: f64,
    /// Mean trips of loops.
    #[serde(deserialize_with = "or_nan")]
    pub trips: f64,
    /// Mean texture reads.
    #[serde(deserialize_with = "or_nan")]
    pub texture: f64,
}

/// Time on the device as a ratio to the baseline's, in one run with interleaved repetitions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Median of the ratios.
    #[serde(deserialize_with = "or_nan")]
    pub median: f64,
    /// 10 % of the ratios are below.
    #[serde(deserialize_with = "or_nan")]
    pub p10: f64,
    /// 10 % are above.
    #[serde(deserialize_with = "or_nan")]
    pub p90: f64,
    /// Median in nanoseconds a call, inputs' fetch and result's store included.
    #[serde(deserialize_with = "or_nan")]
    pub nanoseconds: f64,
}

/// A plane through the domain: errors of a grid, row by row from the top.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Picture {
    /// Names of the inputs along x and y, with their ranges from the left edge to the right one, and from the lower edge to the upper one:
    /// `alpha 1e-4 to 1 (log)`.
    pub axes: [String; 2],
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Errors; null where the module's value is not finite.
    pub errors: Vec<Option<f64>>,
    /// Where the worst input is, in columns and rows; whole numbers are the middles of cells.
    #[serde(deserialize_with = "pair_or_nan")]
    pub worst: [f64; 2],
    /// `model` or `rounding`.
    pub of: String,
}

/// Device against evaluator for one function of one module.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Agreement {
    /// Experiment and label of the row.
    pub module: String,
    /// Its recipe.
    pub recipe: String,
    /// Function.
    pub function: String,
    /// Results compared, one for each number.
    pub results: usize,
    /// Of these, bit for bit the same.
    pub equal: usize,
    /// Outside what WGSL's accuracy table allows.
    pub outside: usize,
    /// Undecided: a branch hangs on a rounding, or WGSL bounds no result, so anything goes.
    pub undecided: usize,
    /// Largest difference in units in the last place, among those inside.
    #[serde(deserialize_with = "or_nan")]
    pub ulps: f64,
    /// Where the largest is, or one of those outside.
    pub worst: Option<Worst>,
}
