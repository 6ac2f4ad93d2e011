//! Device against evaluator: every function of every module that can be probed, on the device and on the CPU with what the WGSL
//! specification allows of it.

// A helper that fails is a test that fails.
#![allow(clippy::expect_used, clippy::unwrap_used)]

#[path = "../common/mod.rs"]
mod common;
mod hostile;
mod rows;
mod snippets;

use std::fmt::Write as _;

use common::{catalog, gpu};
use serde_json::Value as Json;
use shadewright::compiler::diagnostics::codes;
use shadewright::compiler::manifest::{Arity, Filling, Node};
use shadewright::compiler::{Module, Recipe, Report};
use shadewright::evaluate::{Allowed, Number};
use shadewright::runtime::gpu::RuntimeError;
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::probe::Probe;

/// Rows of each function.
const ROWS: usize = 400;

/// Functions of which WGSL leaves more open than [`MOST_OPEN`], how much at most, and why.
const OPEN: &[(&str, f64, &str)] = &[
    (
        "brdf/cook-torrance brdf_sample",
        0.4,
        "the root of -log near 1, whose absolute error may take it below 0",
    ),
    ("brdf/kurt brdf_sample", 0.4, "the same"),
    (
        "albedo/integrated facet_albedo_mean",
        0.6,
        "a sum of thousands of terms, in one of which a branch hangs on a rounding",
    ),
    (
        "light/disk light",
        0.6,
        "outlines are cut at the horizon and at the middle of the polynomials of angles: which side a rounded number is on is left open; \
         `cases.ron` and `area_lights` hold the numbers themselves, and both sides meet there",
    ),
    ("light/polygon light", 1.0, "the same, edge by edge"),
    (
        "light/rectangle light",
        1.0,
        "the same, and of a square's sides, which alone are drawn here, either may be the longer one",
    ),
    ("light/tube light", 0.5, "the same, line by line"),
    (
        "highlight/ltc-anisotropic highlight",
        0.7,
        "the table is read between the corners of a simplex, and which one a rounded place is in is left open; neighbours meet",
    ),
    (
        "highlight/phong-lobe highlight",
        0.4,
        "the same, and turns around the lobe are counted",
    ),
];
/// How far the device may be there from the evaluator's f32, of the larger one or of 0.01: which way a branch goes must not matter more.
const MOST_APART: f64 = 0.01;
/// Largest share of numbers of a function of which nothing can be said.
const MOST_OPEN: f64 = 0.3;

/// A module with its slots' defaults; slots that need a module and have no default get the first that fits.
fn alone(module: &Module, depth: usize) -> Node {
    let mut node = Node::new(format!("{}/{}", module.category, module.name));
    for (name, slot) in &module.manifest.slots {
        if slot.arity == Arity::Single && slot.default.is_none() && depth < 8 {
            let first = catalog()
                .modules()
                .find(|known| known.category == slot.interface)
                .expect("a module that fits");
            node.fill.insert(name.clone(), Filling::One(alone(first, depth + 1)));
        }
    }
    node
}

/// What is compared of a function.
#[derive(Default)]
struct Agreement {
    results: usize,
    equal: usize,
    /// A branch hangs on a rounding.
    undecided: usize,
    /// The specification allows anything.
    open: usize,
    outside: usize,
    ulps: f64,
    worst: String,
    /// Of what is undecided or open: the largest difference of the device from the evaluator's f32, of the larger one or of 0.01.
    apart: f64,
}

impl Agreement {
    /// Compares the device's numbers with what is allowed.
    fn compare(&mut self, row: &Json, names: &[String], device: &[f64], allowed: &[Allowed], undecided: bool) {
        assert_eq!(device.len(), allowed.len());
        for ((got, expected), name) in device.iter().zip(allowed).zip(names) {
            self.results += 1;
            let (got, value) = (*got as f32, expected.value());
            self.equal += usize::from(got.to_bits() == value.to_bits() || got == value || got.is_nan() && value.is_nan());
            if undecided || !expected.is_bounded() {
                let (a, b) = (f64::from(got), f64::from(value));
                let apart = (a - b).abs() / a.abs().max(b.abs()).max(0.01);
                self.apart = self.apart.max(if apart.is_nan() { f64::INFINITY } else { apart });
            }
            if undecided {
                self.undecided += 1;
            } else if !expected.is_bounded() {
                self.open += 1;
            } else if !expected.allows(got) {
                self.outside += 1;
                let _ = writeln!(
                    self.worst,
                    "{row} .{name}: {got:?} is not in {:?} to {:?} around {value:?}",
                    expected.low(),
                    expected.high()
                );
            } else {
                let step = f64::from(value.abs().next_up() - value.abs());
                self.ulps = self.ulps.max((f64::from(got) - f64::from(value)).abs() / step);
            }
        }
    }
}

/// A function that only fragments can call.
fn only_for_fragments(report: &Report) -> bool {
    report.diagnostics.iter().all(|diagnostic| diagnostic.code == codes::WRONG_STAGE)
}

/// Catches a driver or an evaluator that computes something else: a wrong operation, a wrong operand, a bound that is too narrow;
/// and an evaluator that gets out of it by calling everything undecided.
#[test]
fn every_function_is_within_what_wgsl_allows() {
    let pipelines = Pipelines::new(&gpu(), None);
    let (mut table, mut wrong, mut skipped) = (String::new(), String::new(), Vec::new());
    let (mut functions, mut results, mut open) = (0, 0, 0);
    for module in catalog().modules() {
        let recipe = Recipe::from(alone(module, 0));
        for function in catalog().functions(&module.category).expect("an interface").keys() {
            let name = format!("{}/{} {function}", module.category, module.name);
            let probe = match Probe::new(catalog(), &recipe, function) {
                Err(RuntimeError::Compile(report)) if only_for_fragments(&report) => {
                    skipped.push(format!("{name}: takes derivatives, which only a fragment has"));
                    continue;
                }
                probe => probe.unwrap_or_else(|error| panic!("{name}: {error}")),
            };
            let rows = rows::rows(probe.program().reflection(), probe.input().map(|(_, layout)| layout), ROWS);
            let inputs = probe.table(&rows).unwrap_or_else(|error| panic!("{name}: {error}"));
            let device = probe
                .on_gpu(&pipelines, &gpu(), &inputs)
                .unwrap_or_else(|error| panic!("{name}: {error}"));
            let allowed = probe.on_cpu::<Allowed>(&inputs).unwrap_or_else(|error| panic!("{name}: {error}"));
            let single = probe.on_cpu::<f32>(&inputs).unwrap_or_else(|error| panic!("{name}: {error}"));
            let mut found = Agreement::default();
            for (i, row) in rows.iter().enumerate() {
                found.compare(row, &probe.components(), &device[i], &allowed.values[i], allowed.undecided[i]);
                // The value beside the bounds is f32's.
                let same = single.values[i]
                    .iter()
                    .zip(&allowed.values[i])
                    .all(|(s, a)| s.to_bits() == a.to_f32().to_bits());
                assert!(same, "{name}: {row}");
            }
            let _ = writeln!(
                table,
                "{name:<44} {:>6} {:>6} {:>6} {:>6} {:>6} {:>9.1} {:>8.1e}",
                found.results, found.equal, found.undecided, found.open, found.outside, found.ulps, found.apart
            );
            functions += 1;
            let known = OPEN.iter().find(|(open, ..)| *open == name);
            if known.is_none() {
                results += found.results;
                open += found.undecided + found.open;
            }
            if found.outside > 0 {
                let _ = writeln!(
                    wrong,
                    "{name}: {} outside\n{}",
                    found.outside,
                    found.worst.lines().take(3).collect::<Vec<_>>().join("\n")
                );
            }
            let share = (found.undecided + found.open) as f64 / found.results as f64;
            if known.is_some() && found.apart > MOST_APART {
                let _ = writeln!(wrong, "{name}: {:.1e} apart where nothing is decided", found.apart);
            }
            if share > known.map_or(MOST_OPEN, |(_, most, _)| *most) {
                let _ = writeln!(wrong, "{name}: {:.0} % undecided", share * 100.0);
            }
        }
    }
    println!(
        "{} on {}\n{:<44} {:>6} {:>6} {:>6} {:>6} {:>6} {:>9} {:>8}\n{table}",
        functions,
        gpu().name(),
        "function",
        "number",
        "equal",
        "undec.",
        "open",
        "outs.",
        "ulps",
        "apart"
    );
    skipped.iter().for_each(|skip| println!("skipped {skip}"));
    assert!(wrong.is_empty(), "{wrong}");
    assert_eq!(skipped.len(), 3, "{skipped:?}");
    assert!(functions >= 18, "only {functions} functions");
    assert!(open as f64 <= 0.05 * results as f64, "{open} of {results} undecided");
}
