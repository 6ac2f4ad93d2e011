//! Errors of modules as the report of all experiments found them.

use indexmap::IndexMap;
use shadewright_compiler::Module;
use shadewright_report::Baseline;

/// The report that was made when the standard library was last accepted.
const BASELINE: &str = include_str!("../../../../spec/baseline.json");

/// Model errors, RMS, by module.
#[derive(Clone, Debug, Default)]
pub struct Stored {
    baseline: Baseline,
    /// By category and name: experiment and error.
    errors: IndexMap<(String, String), Vec<(String, f64)>>,
}

impl Stored {
    /// Reads the report; an empty one where that cannot be.
    pub fn read() -> Self {
        let baseline = Baseline::read("baseline.json", BASELINE).unwrap_or_else(|error| {
            log::error!("{}", error.render());
            Baseline::default()
        });
        Self {
            baseline,
            errors: IndexMap::new(),
        }
    }

    /// Model error of an experiment's row.
    pub(super) fn row(&self, experiment: &str, label: &str) -> Option<f64> {
        let line = self.baseline.rows.get(&format!("{experiment}: {label}"))?;
        line.model.map(|sizes| sizes.rms)
    }

    pub(super) fn add(&mut self, module: &Module, experiment: &str, error: Option<f64>) {
        if let Some(error) = error {
            let key = (module.category.clone(), module.name.clone());
            self.errors.entry(key).or_default().push((experiment.to_owned(), error));
        }
    }

    /// Experiments about a module, and its error in each.
    pub fn of(&self, module: &Module) -> &[(String, f64)] {
        let key = (module.category.clone(), module.name.clone());
        self.errors.get(&key).map(Vec::as_slice).unwrap_or_default()
    }
}
