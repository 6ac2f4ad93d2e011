//! Experiments as text: what is right is read, what is wrong is told where it stands.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use shadewright_compiler::Catalog;
use shadewright_modules::library;
use shadewright_report::{Baseline, experiment, experiments};

fn catalog() -> Catalog {
    Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"))
}

/// The errors of an experiment on distributions with these fields beside a title.
fn error(fields: &str) -> String {
    let text = format!("[\n    (\n        title: \"tested\",\n        {fields}\n    ),\n]\n");
    match experiment::read(&catalog(), "ndf", "ndf", "ndf/ndf.experiment.ron", &text) {
        Ok(_) => panic!("{text} is taken"),
        Err(report) => report.render(),
    }
}

#[track_caller]
fn assert_text(found: &str, expected: &str) {
    assert_eq!(found.trim(), expected.trim(), "found\n{found}");
}

/// Catches an experiment of the library that is not found, or has lost its alternatives.
#[test]
fn the_library_has_experiments() {
    let library = library();
    let all = experiments(&*library, &catalog()).unwrap_or_else(|report| panic!("{report}"));
    let names: Vec<&str> = all.iter().map(|e| e.name.as_str()).collect();
    for name in ["ndf", "brdf", "fresnel", "fresnel/form", "light/point", "filtering"] {
        assert!(names.contains(&name), "{names:?}");
    }
    assert!(all.iter().all(|e| !e.alternatives.is_empty() && !e.function.is_empty()));
    let brdf = all.iter().find(|e| e.name == "brdf").unwrap();
    let labels: Vec<&str> = brdf.alternatives.iter().map(|a| a.label.as_str()).collect();
    assert_eq!(labels, ["lambert", "microfacet"]);
}

#[test]
fn sw1101_experiment_invalid() {
    assert_text(
        &error("function: \"distributoin\", truth: Itself, metric: Absolute(),"),
        "",
    );
    assert_text(
        &error("alternatives: Of({\"a\": (module: \"lambert\")}), truth: Itself, metric: Absolute(),"),
        "",
    );
    assert_text(
        &error("configurations: 0, truth: Itself, metric: Relative(floor: 0.0), baseline: \"gxg\","),
        "",
    );
    assert_text(
        &error("inputs: {\"s.alpha\": Linear(0, 1), \"s\": Value(1)}, truth: Itself, metric: Absolute(),"),
        "",
    );
}

#[test]
fn sw1102_bad_input_range() {
    assert_text(
        &error(
            "inputs: {\"s.alpha\": Log(0, 1), \"h\": Lobe(\"width\"), \"_v\": Linear(2, 1)},\n        hard: [{\"h\": Angles([])}], truth: Itself, metric: Absolute(),",
        ),
        "",
    );
}

#[test]
fn sw1103_unknown_truth() {
    assert_text(&error("truth: Closed(\"ndf/gxg\"), metric: Absolute(),"), "");
}

#[test]
fn sw1104_baseline_invalid() {
    let text = "{\n  \"rows\": {\n    \"ndf: ggx\": {\"model\": 1}\n  }\n}\n";
    let report = Baseline::read("spec/baseline.json", text).unwrap_err();
    assert_text(&report.render(), "");
}
