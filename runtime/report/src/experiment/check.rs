//! What an experiment says, held against the library; errors point into the experiment's file.

use indexmap::IndexMap;
use shadewright_compiler::Report;
use shadewright_compiler::catalog::Signature;
use shadewright_compiler::diagnostics::codes;
use shadewright_compiler::manifest::{Parsed, Step};
use shadewright_modules::oracles;

use super::domain::coordinates;
use super::format::{Declared, Metric, Range, TruthSource};
use super::{Alternative, MOST_CONFIGURATIONS};

/// Most coordinates that an experiment's inputs may take.
const MOST_COORDINATES: usize = 64;

/// The experiments of a file under examination.
pub(super) struct Checker<'a> {
    pub parsed: &'a Parsed<Vec<Declared>>,
    /// Functions of the category's interface, with their text.
    pub functions: &'a IndexMap<String, String>,
    pub category: &'a str,
    pub errors: Vec<shadewright_compiler::diagnostics::Diagnostic>,
}

impl Checker<'_> {
    fn error(&mut self, index: usize, path: &[Step], code: &'static str, message: impl Into<String>, label: impl Into<String>) {
        let path = [&[Step::Index(index)], path].concat();
        self.errors.push(self.parsed.error_at(&path, code, message, label));
    }

    /// Takes an error without a place of its own.
    pub(super) fn adopt(&mut self, index: usize, report: Report) {
        let span = self.parsed.places.find_near(&[Step::Index(index), Step::Key("alternatives")]);
        let file = &self.parsed.file;
        self.errors
            .extend(report.diagnostics.into_iter().map(|d| d.at(file, span.clone(), "named here")));
    }

    pub(super) fn unique<'n>(&mut self, index: usize, name: &str, mut others: impl Iterator<Item = &'n str>) {
        if others.any(|other| other == name) {
            let message = format!("two experiments are called `{name}`");
            self.error(index, &[Step::Key("name")], codes::EXPERIMENT_INVALID, message, "the second");
        }
    }

    /// The function that an experiment is about.
    pub(super) fn function(&mut self, index: usize, declared: &Declared) -> Option<String> {
        let code = codes::EXPERIMENT_INVALID;
        match &declared.function {
            Some(function) if self.functions.contains_key(function) => Some(function.clone()),
            Some(function) => {
                let message = format!("`{}` has no function `{function}`", self.category);
                self.error(index, &[Step::Key("function")], code, message, "no such function");
                if let Some(error) = self.errors.pop() {
                    let known = self.functions.keys().map(String::as_str);
                    self.errors.push(error.suggest(function, "functions", known));
                }
                None
            }
            None if self.functions.len() == 1 => self.functions.keys().next().cloned(),
            None => {
                let known: Vec<_> = self.functions.keys().map(|name| format!("`{name}`")).collect();
                let message = format!("`{}` has {} functions; say which", self.category, known.len());
                let label = if known.is_empty() {
                    "nothing to call".to_owned()
                } else {
                    format!("`function` is one of {}", known.join(", "))
                };
                self.error(index, &[], code, message, label);
                None
            }
        }
    }

    /// Every argument that has no default of its own is drawn: only structs' members have one.
    pub(super) fn arguments(&mut self, index: usize, declared: &Declared, signature: &Signature) {
        for (name, ty) in &signature.arguments {
            let is_drawn = declared.inputs.keys().any(|path| is_part(path, name));
            if !is_drawn && !signature.structs.contains_key(ty) {
                let message = format!("the argument `{name}` of type {ty} is not among the inputs");
                self.error(
                    index,
                    &[Step::Key("inputs")],
                    codes::EXPERIMENT_INVALID,
                    message,
                    "it has no default",
                );
            }
        }
    }

    pub(super) fn experiment(&mut self, index: usize, declared: &Declared, function: Option<&str>, alternatives: &[Alternative]) {
        let code = codes::EXPERIMENT_INVALID;
        if declared.configurations == 0 || declared.configurations > MOST_CONFIGURATIONS {
            let message = format!("the configurations are not from 1 to {MOST_CONFIGURATIONS}");
            self.error(index, &[Step::Key("configurations")], code, message, "this many");
        }
        if let Metric::Relative { floor } = declared.metric
            && !(floor > 0.0 && floor.is_finite())
        {
            let message = "the floor of a relative error is not above 0";
            self.error(index, &[Step::Key("metric")], code, message, "below it a value counts as 0");
        }
        if let Some(baseline) = &declared.baseline
            && !alternatives.iter().any(|a| a.label == *baseline)
        {
            let message = format!("no alternative is called `{baseline}`");
            self.error(index, &[Step::Key("baseline")], code, message, "named here");
        }
        if let (TruthSource::Closed(folder), Some(function)) = (&declared.truth, function)
            && oracles::truth(folder, function).is_none()
        {
            let message = format!("`{folder}` has no closed form for `{function}`");
            self.error(index, &[Step::Key("truth")], codes::UNKNOWN_TRUTH, message, "asked for here");
            if let Some(error) = self.errors.pop() {
                self.errors.push(error.suggest(
                    folder,
                    "folders",
                    oracles::folders().filter(|of| oracles::truth(of, function).is_some()),
                ));
            }
        }
        self.inputs(index, declared);
        self.hard(index, declared);
    }

    fn inputs(&mut self, index: usize, declared: &Declared) {
        let mut before: Vec<&str> = Vec::new();
        for (name, range) in &declared.inputs {
            let path = [Step::Key("inputs"), Step::Key(name)];
            if let Err(why) = sound(range, &before) {
                self.error(index, &path, codes::BAD_INPUT_RANGE, format!("`{name}` cannot be drawn"), why);
            }
            if let Some(other) = before.iter().find(|other| is_part(other, name) || is_part(name, other)) {
                let message = format!("`{name}` and `{other}` are parts of each other");
                self.error(index, &path, codes::EXPERIMENT_INVALID, message, "drawn twice");
            }
            before.push(name);
        }
        if declared.inputs.values().map(coordinates).sum::<usize>() > MOST_COORDINATES {
            let message = format!("the inputs take more than {MOST_COORDINATES} coordinates");
            self.error(index, &[Step::Key("inputs")], codes::EXPERIMENT_INVALID, message, "too many");
        }
    }

    fn hard(&mut self, index: usize, declared: &Declared) {
        for (at, block) in declared.hard.iter().enumerate() {
            let mut count = 1usize;
            let mut before: Vec<&str> = declared.inputs.keys().map(String::as_str).collect();
            for (name, values) in block {
                let path = [Step::Key("hard"), Step::Index(at), Step::Key(name)];
                let ranges = values.ranges();
                if ranges.is_empty() {
                    self.error(index, &path, codes::BAD_INPUT_RANGE, format!("`{name}` has no values"), "empty");
                }
                for range in &ranges {
                    if let Err(why) = sound(range, &before) {
                        self.error(index, &path, codes::BAD_INPUT_RANGE, format!("`{name}` cannot be drawn"), why);
                        break;
                    }
                }
                before.push(name);
                count = count.saturating_mul(ranges.len());
            }
            if count > MOST_CONFIGURATIONS {
                let message = format!("the block multiplies out to more than {MOST_CONFIGURATIONS} configurations");
                let path = [Step::Key("hard"), Step::Index(at)];
                self.error(index, &path, codes::EXPERIMENT_INVALID, message, "too many");
            }
        }
    }
}

/// Whether `part` is a member of `whole`, or the same.
fn is_part(part: &str, whole: &str) -> bool {
    part == whole || part.strip_prefix(whole).is_some_and(|rest| rest.starts_with('.'))
}

/// Whether a range can be drawn from, given the inputs that are drawn before it.
fn sound(range: &Range, before: &[&str]) -> Result<(), String> {
    let finite = |x: f64| if x.is_finite() { Ok(()) } else { Err(format!("{x} is not finite")) };
    let ordered = |lo: f64, hi: f64| {
        finite(lo)?;
        finite(hi)?;
        if lo < hi { Ok(()) } else { Err(format!("{lo} is not below {hi}")) }
    };
    let known = |name: &str| {
        if before.contains(&name) {
            Ok(())
        } else {
            Err(format!("`{name}` is not drawn before it"))
        }
    };
    let all = |ranges: &[Range]| {
        if ranges.is_empty() {
            return Err("it holds nothing".to_owned());
        }
        ranges.iter().try_for_each(|range| sound(range, before))
    };
    match range {
        Range::Value(_) | Range::Sphere | Range::Hemisphere => Ok(()),
        Range::Linear(lo, hi) => ordered(*lo, *hi),
        Range::Log(lo, hi) if *lo <= 0.0 => Err(format!("{lo} has no logarithm, up to {hi}")),
        Range::Log(lo, hi) => ordered(*lo, *hi),
        Range::Whole(lo, hi) if lo > hi || hi.abs_diff(*lo) > 1 << 32 => Err(format!("{lo} to {hi} is no range of whole numbers")),
        Range::Whole(..) => Ok(()),
        Range::Choice(values) if values.is_empty() => Err("it holds nothing".to_owned()),
        Range::Choice(_) => Ok(()),
        Range::Vector(parts) if parts.len() > 4 => Err(format!("a vector has no {} components", parts.len())),
        Range::Vector(parts) => all(parts),
        Range::Angles(theta, phi) => finite(*theta).and_then(|()| finite(*phi)),
        Range::Polar(angle) => sound(angle, before),
        Range::Lobe(width) => known(width),
        Range::Mirror { of, about } => known(of).and_then(|()| known(about)),
        Range::Half(a, b) => known(a).and_then(|()| known(b)),
        Range::Either(ways) => all(ways),
    }
}
