//! The report finds what is planted: a bad approximation, a NaN at one input, a slow module. Each by its name.

#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use shadewright::compiler::Catalog;
use shadewright::modules::{Embedded, Folder, Overlay, library};
use shadewright::report::data::{Report, Row};
use shadewright::report::{Baseline, Done, Options, run};
use shadewright::runtime::gpu::Gpu;

/// A library of modules over the standard one.
fn with(modules: &[(&str, &str)]) -> (tempfile::TempDir, Arc<Overlay>) {
    let folder = tempfile::tempdir().unwrap();
    for (path, text) in modules {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let overlay = Overlay(vec![Arc::new(Folder::new(folder.path())), library()]);
    (folder, Arc::new(overlay))
}

fn report_on(
    library: &Arc<Overlay>,
    categories: &[&str],
    device: Option<&Gpu>,
    done: &dyn Done,
    cancel: &AtomicBool,
) -> Result<Report, String> {
    let catalog = Catalog::load(Arc::clone(library) as _).unwrap_or_else(|report| panic!("{report}"));
    let experiments = shadewright::report::experiments(&**library, &catalog).unwrap_or_else(|report| panic!("{report}"));
    let categories: Vec<String> = categories.iter().map(|&c| c.to_owned()).collect();
    let options = Options {
        categories: &categories,
        device,
        quick: true,
        done,
        cancel,
        progress: &|_, _, _| {},
    };
    run(&catalog, &experiments, &options).map_err(|error| error.to_string())
}

fn row<'r>(report: &'r Report, label: &str) -> &'r Row {
    report.experiments[0]
        .rows
        .iter()
        .find(|row| row.label == label)
        .unwrap_or_else(|| panic!("no row {label}"))
}

/// GGX with a change at the end: `return DISTRIBUTION;` of `d`.
fn ggx(end: &str) -> String {
    let text = Embedded
        .files()
        .find(|(path, _)| *path == "ndf/ggx/ggx.wgsl")
        .map(|(_, text)| text)
        .unwrap();
    let (head, _) = text.split_once("return").unwrap();
    format!("{head}let d = select(0.0, k * k * INV_PI, cosine > 0.0);\n    {end}\n}}\n")
}

const MANIFEST: &str = r#"(summary: "planted", uses: ["lobe", "math"])"#;

/// The experiment on distributions of the standard library, with GGX as the truth of all.
fn experiment() -> String {
    let text = Embedded
        .files()
        .find(|(path, _)| *path == "ndf/ndf.experiment.ron")
        .map(|(_, text)| text)
        .unwrap();
    assert!(text.contains("truth: Own"));
    text.replace("truth: Own", "truth: Closed(\"ndf/ggx\")")
}

/// Catches a truth that is given what the alternative reads instead of what it reads itself: what ignores an input would then be compared with the
/// truth at that input's default, and be right. And all errors of a sampled truth that are left out, or stand in another order than their inputs.
#[test]
fn a_truth_reads_its_own_inputs() {
    for truth in ["Reference", "Sampled"] {
        let experiment = format!(
            r#"[(
                title: "Sizes", alternatives: Of({{"blind": "falloff/blind", "inverse-square": "inverse-square"}}),
                inputs: {{"distance": Value(0.5), "range": Value(0.0), "size": Log(0.5, 2.0)}}, configurations: 8, hard: [{{"size": Values([2.0])}}],
                truth: {truth}("inverse-square"), metric: Relative(floor: 1e-6),
            )]"#
        );
        let (_folder, library) = with(&[
            ("falloff/falloff.experiment.ron", experiment.as_str()),
            ("falloff/blind/module.ron", "(summary: \"planted\")"),
            (
                "falloff/blind/blind.wgsl",
                "fn falloff(distance: f32, range: f32, size: f32) -> f32 {\n    return 1.0 / (distance * distance);\n}\n",
            ),
        ]);
        let report = report_on(&library, &["falloff"], None, &(), &AtomicBool::new(false)).unwrap();
        // The hard size is four times the distance: 1 / 0.25 instead of 1 / 4.
        let blind = row(&report, "blind").model.clone().unwrap();
        assert!((blind.max - 15.0).abs() < 1e-6, "{truth}: {blind:?}");
        assert_eq!(row(&report, "inverse-square").model.clone().unwrap().max, 0.0);
        let samples = &report.experiments[0].samples;
        assert_eq!(samples.is_some(), truth == "Sampled");
        if let Some(samples) = samples {
            assert_eq!(samples.inputs.len(), 9);
            for (input, error) in samples.inputs.iter().zip(&samples.errors["blind"]) {
                let size = input["size"].as_f64().unwrap();
                assert!((error.unwrap() - (4.0 * size * size - 1.0)).abs() < 1e-5, "{input}: {error:?}");
            }
        }
    }
}

/// Catches a report that averages a bad corner away, that sees no NaN but on a grid, or that does not see what a module costs.
#[test]
fn planted_faults_are_found_and_named() {
    let corner = ggx("return d * select(1.0, 1.03, s.alpha > 0.3 && h.x > 0.8);");
    // 0 / 0 where alpha is 0.01 and the facet lies flat, one of the hard inputs; a factor of one elsewhere.
    let nan = ggx("let x = abs(s.alpha - 0.01) + abs(h.x) + abs(h.z - 1.0);\n    return d * (sqrt(x) / sqrt(x));");
    let slow = ggx(
        "var sum = 0.0;\n    for (var i = 0; i < 64; i++) { let x = f32(i) * h.x; sum += d * (cos(x) * cos(x) + sin(x) * sin(x)); }\n    return sum / 64.0;",
    );
    let experiment = experiment();
    let (_folder, library) = with(&[
        ("ndf/ndf.experiment.ron", experiment.as_str()),
        ("ndf/corner/module.ron", MANIFEST),
        ("ndf/corner/corner.wgsl", corner.as_str()),
        ("ndf/nan/module.ron", MANIFEST),
        ("ndf/nan/nan.wgsl", nan.as_str()),
        ("ndf/slow/module.ron", MANIFEST),
        ("ndf/slow/slow.wgsl", slow.as_str()),
    ]);
    let gpu = common::gpu();
    let report = report_on(&library, &["ndf"], Some(&gpu), &(), &AtomicBool::new(false)).unwrap();

    let good = row(&report, "ggx");
    let model = |row: &Row| row.model.clone().unwrap();
    // 1 / pi in 32 bits is off by 4e-8: the constants are the formula's.
    assert!(model(good).searched < 1e-6, "{good:#?}");
    assert_eq!(
        (good.verdict.nan.count, good.verdict.infinite.count, good.verdict.negative.count),
        (0, 0, 0)
    );
    assert_eq!(good.verdict.discontinuous.count, 0, "{:#?}", good.verdict);

    let bad = row(&report, "corner");
    let worst = model(bad).worst;
    println!("corner: {:.4} at {}", model(bad).searched, worst.input);
    assert!((model(bad).searched - 0.03).abs() < 1e-4, "{bad:#?}");
    assert!(
        worst.input["s"]["alpha"].as_f64().unwrap() > 0.3 && worst.input["h"][0].as_f64().unwrap() > 0.8,
        "{worst:?}"
    );
    assert!(bad.verdict.discontinuous.count > 0, "{:#?}", bad.verdict);

    let nan = row(&report, "nan");
    let fault = nan.verdict.nan.worst.as_ref().unwrap();
    println!("nan: {} at {}", fault.got, fault.input);
    assert_eq!(nan.verdict.nan.count, 1);
    assert!((fault.input["s"]["alpha"].as_f64().unwrap() - 0.01).abs() < 1e-8, "{fault:?}");
    assert_eq!(fault.input["h"], serde_json::json!([0.0, 0.0, 1.0]));
    assert!(model(nan).searched < 1e-6, "the rest is right");

    let slow = row(&report, "slow");
    let time = slow
        .time
        .as_ref()
        .map_or(f64::NAN, |time| time.median / good.time.as_ref().unwrap().median);
    println!(
        "slow: {} operations against {}, {time:.2} of the time",
        slow.executed.mean, good.executed.mean
    );
    assert!(slow.executed.mean > 10.0 * good.executed.mean && slow.executed.trips == 64.0 && slow.dominated && !good.dominated);
    // The operations decide; the time only has to point the same way, on a machine that does other things too.
    assert!(time > 1.2, "{time}");
}

/// Catches a baseline that lets a worse module pass, or that does not say which.
#[test]
fn a_module_that_gets_worse_is_named() {
    let done = |library: &Arc<Overlay>| Baseline::of(&report_on(library, &["ndf"], None, &(), &AtomicBool::new(false)).unwrap());
    let (_folder, plain) = with(&[]);
    let before = done(&plain);
    assert_eq!(before.compare(&before), Default::default());
    let read = Baseline::read("baseline.json", &before.to_json()).unwrap();
    assert!(before.compare(&read).worse.is_empty(), "what is written reads back");

    let manifest = Embedded
        .files()
        .find(|(path, _)| *path == "ndf/ggx/module.ron")
        .map(|(_, text)| text)
        .unwrap();
    for (change, what) in [
        ("return d * select(1.0, 1.03, s.alpha > 0.3 && h.x > 0.8);", "largest model error"),
        ("return select(d, -1e-9, d < 1e-8);", "negatives"),
        ("return d * cos(0.0 * s.alpha);", "transcendental"),
        ("return (d + 1e6) - 1e6;", "rounding error (rms)"),
    ] {
        let text = ggx(change);
        let (_folder, changed) = with(&[("ndf/ggx/module.ron", manifest), ("ndf/ggx/ggx.wgsl", text.as_str())]);
        let comparison = before.compare(&done(&changed));
        let named = comparison
            .worse
            .iter()
            .any(|line| line.starts_with("ndf: ggx: ") && line.contains(what));
        assert!(named, "{change}: {comparison:#?}");
        assert!(!done(&changed).compare(&before).better.is_empty(), "{change}");
    }
    let mut fewer = before.clone();
    fewer.rows.shift_remove("ndf: ggx");
    assert_eq!(before.compare(&fewer).worse, ["ndf: ggx: is gone"]);
    assert_eq!(fewer.compare(&before).worse, ["ndf: ggx: is not in the baseline"]);
}

/// The errors and costs of the library as it is, against those that were accepted. `shadewright report --accept spec/baseline.json` accepts
/// others.
#[test]
fn nothing_is_worse_than_the_baseline() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("spec/baseline.json");
    let accepted =
        Baseline::read("spec/baseline.json", &std::fs::read_to_string(path).unwrap()).unwrap_or_else(|report| panic!("{report}"));
    let (_folder, library) = with(&[]);
    let now = Baseline::of(&report_on(&library, &[], None, &(), &AtomicBool::new(false)).unwrap());
    assert!(now.rows.len() >= 15, "{}", now.rows.len());
    let comparison = accepted.compare(&now);
    println!("{} rows; better: {:#?}", now.rows.len(), comparison.better);
    assert!(comparison.worse.is_empty(), "{:#?}", comparison.worse);
    // The page for people is of the same rows.
    let page = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("spec/errors.md")).unwrap();
    for name in now.rows.keys() {
        let (experiment, label) = name.split_once(": ").unwrap();
        let section = page
            .split(&format!("\n## {experiment}\n"))
            .nth(1)
            .unwrap_or_else(|| panic!("spec/errors.md has no {experiment}"));
        let section = section.split("\n## ").next().unwrap();
        assert!(section.contains(&format!("\n| {label} |")), "spec/errors.md has no {name}");
    }
}

/// Rows kept in memory.
#[derive(Default)]
struct Kept {
    rows: RefCell<HashMap<String, String>>,
    reused: Cell<usize>,
}

impl Done for Kept {
    fn get(&self, key: &str) -> Option<String> {
        let found = self.rows.borrow().get(key).cloned();
        self.reused.set(self.reused.get() + usize::from(found.is_some()));
        found
    }

    fn put(&self, key: &str, row: &str) -> std::io::Result<()> {
        self.rows.borrow_mut().insert(key.to_owned(), row.to_owned());
        Ok(())
    }
}

/// Catches a report that begins anew, one that takes a row of another module's text for this one's, and one that cannot be stopped.
#[test]
fn an_interrupted_report_goes_on() {
    let (_folder, plain) = with(&[]);
    let kept = Kept::default();
    let cancel = AtomicBool::new(true);
    assert_eq!(report_on(&plain, &["ndf"], None, &kept, &cancel).unwrap_err(), "interrupted");
    assert!(kept.rows.borrow().is_empty());
    cancel.store(false, Ordering::Relaxed);
    let first = report_on(&plain, &["ndf"], None, &kept, &cancel).unwrap();
    let rows = first.experiments.iter().map(|e| e.rows.len()).sum();
    assert_eq!((kept.rows.borrow().len(), kept.reused.get()), (rows, 0));
    let again = report_on(&plain, &["ndf"], None, &kept, &cancel).unwrap();
    assert_eq!((kept.reused.get(), &again), (rows, &first));

    let manifest = Embedded
        .files()
        .find(|(path, _)| *path == "ndf/ggx/module.ron")
        .map(|(_, text)| text)
        .unwrap();
    let text = ggx("return d * 1.5;");
    let (_folder, changed) = with(&[("ndf/ggx/module.ron", manifest), ("ndf/ggx/ggx.wgsl", text.as_str())]);
    let other = report_on(&changed, &["ndf"], None, &kept, &cancel).unwrap();
    assert!(row(&other, "ggx").model.as_ref().unwrap().searched > 0.4, "an old row was taken");
}

/// Catches a module that no experiment looks at and that nobody hears of.
#[test]
fn every_module_has_a_row_or_a_reason() {
    let (_folder, library) = with(&[("ndf/new/module.ron", MANIFEST), ("ndf/new/new.wgsl", ggx("return d;").as_str())]);
    let report = report_on(&library, &[], None, &(), &AtomicBool::new(false)).unwrap();
    let catalog = Catalog::load(library as _).unwrap_or_else(|report| panic!("{report}"));
    let rows: Vec<String> = report
        .experiments
        .iter()
        .flat_map(|e| e.rows.iter().map(|r| format!("{} {}", e.category, r.recipe)))
        .collect();
    // One that is added by a folder has its row.
    assert!(rows.iter().any(|row| row == "ndf ndf/new"), "{rows:#?}");
    for module in catalog.modules() {
        let name = format!("{}/{}", module.category, module.name);
        let has_row = rows
            .iter()
            .any(|row| row.starts_with(&format!("{} ", module.category)) && row.contains(&module.name));
        assert!(has_row || report.without.contains_key(&name), "{name}");
    }
    println!("{:#?}", report.without);
    assert!(
        report.without.iter().all(|(_, why)| !why.contains("no experiment")),
        "{:#?}",
        report.without
    );
}
