//! Experiments as text: what is right is read, what is wrong is told where it stands.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use shadewright_compiler::Catalog;
use shadewright_modules::{library, oracles};
use shadewright_report::{Baseline, experiment, experiments};

fn catalog() -> Catalog {
    Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"))
}

/// The errors of an experiment on distributions with these fields beside a title.
fn error(fields: &str) -> String {
    let function = if fields.contains("function:") {
        ""
    } else {
        ", function: \"distribution\""
    };
    let text = format!("[\n    (\n        title: \"tested\"{function},\n        {fields}\n    ),\n]\n");
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
    // A category may be left with none: its modules then have experiments of their own.
    assert!(
        all.iter()
            .all(|e| !e.function.is_empty() && (!e.alternatives.is_empty() || e.folder == e.category))
    );
    let brdf = all.iter().find(|e| e.name == "brdf").unwrap();
    let labels: Vec<&str> = brdf.alternatives.iter().map(|a| a.label.as_str()).collect();
    // Of its own category, all of them.
    let own = |name: &str| all.iter().any(|e| e.folder == format!("brdf/{name}") && e.function == "brdf");
    let modules = catalog().modules().filter(|m| m.category == "brdf" && !own(&m.name)).count();
    assert!(
        labels.contains(&"lambert") && labels.contains(&"microfacet") && labels.len() == modules,
        "{labels:?}"
    );
}

#[test]
fn sw1101_experiment_invalid() {
    assert_text(
        &error("function: \"distributoin\", inputs: {\"h\": Hemisphere}, truth: Itself, metric: Absolute(),"),
        r#"
error[SW1101]: `ndf` has no function `distributoin`
  --> ndf/ndf.experiment.ron:4:19
  |
4 |         function: "distributoin", inputs: {"h": Hemisphere}, truth: Itself, metric: Absolute(),
  |                   ^^^^^^^^^^^^^^ no such function
  |
  = did you mean `distribution`?
  = functions: distribution, facet_sample, facet_pdf
"#,
    );
    assert_text(
        &error("alternatives: Of({\"a\": (module: \"lambert\")}), inputs: {\"h\": Hemisphere}, truth: Itself, metric: Absolute(),"),
        r#"
error[SW1101]: `a` is a module of `brdf`, not of `ndf`
  --> ndf/ndf.experiment.ron:4:23
  |
4 |         alternatives: Of({"a": (module: "lambert")}), inputs: {"h": Hemisphere}, truth: Itself, metric: Absolute(),
  |                       ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ named here
"#,
    );
    assert_text(
        &error("configurations: 0, inputs: {\"h\": Hemisphere}, truth: Itself, metric: Relative(floor: 0.0), baseline: \"gxg\","),
        r#"
error[SW1101]: the configurations are not from 1 to 1048576
  --> ndf/ndf.experiment.ron:4:25
  |
4 |         configurations: 0, inputs: {"h": Hemisphere}, truth: Itself, metric: Relative(floor: 0.0), baseline: "gxg",
  |                         ^ this many

error[SW1101]: the floor of a relative error is not above 0
  --> ndf/ndf.experiment.ron:4:78
  |
4 |         configurations: 0, inputs: {"h": Hemisphere}, truth: Itself, metric: Relative(floor: 0.0), baseline: "gxg",
  |                                                                              ^^^^^^^^^^^^^^^^^^^^ below it a value counts as 0

error[SW1101]: no alternative is called `gxg`
  --> ndf/ndf.experiment.ron:4:110
  |
4 |         configurations: 0, inputs: {"h": Hemisphere}, truth: Itself, metric: Relative(floor: 0.0), baseline: "gxg",
  |                                                                                                              ^^^^^ named here
"#,
    );
    assert_text(
        &error("inputs: {\"s.alpha\": Linear(0, 1), \"s\": Value(1)}, truth: Itself, metric: Absolute(),"),
        r#"
error[SW1101]: `s` and `s.alpha` are parts of each other
  --> ndf/ndf.experiment.ron:4:48
  |
4 |         inputs: {"s.alpha": Linear(0, 1), "s": Value(1)}, truth: Itself, metric: Absolute(),
  |                                                ^^^^^^^^ drawn twice

error[SW1101]: the argument `h` of type vec3f is not among the inputs
  --> ndf/ndf.experiment.ron:4:17
  |
4 |         inputs: {"s.alpha": Linear(0, 1), "s": Value(1)}, truth: Itself, metric: Absolute(),
  |                 ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ it has no default
"#,
    );
}

#[test]
fn sw1102_bad_input_range() {
    assert_text(
        &error(
            "inputs: {\"s.alpha\": Log(0, 1), \"h\": Lobe(\"width\"), \"_v\": Linear(2, 1)},\n        hard: [{\"h\": Angles([])}], truth: Itself, metric: Absolute(),",
        ),
        r#"
error[SW1102]: `s.alpha` cannot be drawn
  --> ndf/ndf.experiment.ron:4:29
  |
4 |         inputs: {"s.alpha": Log(0, 1), "h": Lobe("width"), "_v": Linear(2, 1)},
  |                             ^^^^^^^^^ 0 has no logarithm, up to 1

error[SW1102]: `h` cannot be drawn
  --> ndf/ndf.experiment.ron:4:45
  |
4 |         inputs: {"s.alpha": Log(0, 1), "h": Lobe("width"), "_v": Linear(2, 1)},
  |                                             ^^^^^^^^^^^^^ `width` is not drawn before it

error[SW1102]: `_v` cannot be drawn
  --> ndf/ndf.experiment.ron:4:66
  |
4 |         inputs: {"s.alpha": Log(0, 1), "h": Lobe("width"), "_v": Linear(2, 1)},
  |                                                                  ^^^^^^^^^^^^ 2 is not below 1

error[SW1102]: `h` has no values
  --> ndf/ndf.experiment.ron:5:22
  |
5 |         hard: [{"h": Angles([])}], truth: Itself, metric: Absolute(),
  |                      ^^^^^^^^^^ empty
"#,
    );
}

#[test]
fn sw1103_unknown_truth() {
    let folders: Vec<&str> = oracles::folders()
        .filter(|folder| oracles::truth(folder, "distribution").is_some())
        .collect();
    assert!(folders.contains(&"ndf/ggx") && !folders.contains(&"fresnel"), "{folders:?}");
    let expected = r#"
error[SW1103]: `ndf/gxg` has no closed form for `distribution`
  --> ndf/ndf.experiment.ron:4:43
  |
4 |         inputs: {"h": Hemisphere}, truth: Closed("ndf/gxg"), metric: Absolute(),
  |                                           ^^^^^^^^^^^^^^^^^ asked for here
  |
  = did you mean `ndf/ggx`?
  = folders: "#;
    assert_text(
        &error("inputs: {\"h\": Hemisphere}, truth: Closed(\"ndf/gxg\"), metric: Absolute(),"),
        &format!("{expected}{}", folders.join(", ")),
    );
}

#[test]
fn sw1104_baseline_invalid() {
    let text = "{\n  \"rows\": {\n    \"ndf: ggx\": {\"model\": 1}\n  }\n}\n";
    let report = Baseline::read("spec/baseline.json", text).unwrap_err();
    assert_text(
        &report.render(),
        r#"
error[SW1104]: this is no baseline of errors and costs
  --> spec/baseline.json:3:27
  |
3 |     "ndf: ggx": {"model": 1}
  |                           ^ invalid type: integer `1`, expected struct Sizes at line 3 column 27
  |
  = `shadewright report --accept FILE` writes one
"#,
    );
}
