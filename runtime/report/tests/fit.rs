//! Models fitted to tables of functions that are known.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use std::sync::atomic::{AtomicBool, Ordering};

use glam::DVec3;
use indexmap::IndexMap;
use serde_json::{Value, json};
use shadewright_compiler::manifest::Node;
use shadewright_compiler::{Catalog, Recipe};
use shadewright_modules::library;
use shadewright_modules::oracles::{self, At, reflection};
use shadewright_report::data::{Fit, Fits};
use shadewright_report::fit::{FitOptions, Subject, fit, read, subjects};
use shadewright_report::{MeasureError, Report, write};
use shadewright_runtime::measured::{Facets, Measured, Merl, Rgl, tabulate, write_tensors};

fn catalog() -> Catalog {
    Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"))
}

fn subject(catalog: &Catalog) -> Subject {
    let all = subjects(&*library(), catalog).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(all.len(), 1);
    all.into_iter().next().unwrap()
}

/// The closed form of a module, in double precision.
fn truth(folder: &str, surface: Value, params: Value) -> impl Fn(DVec3, DVec3) -> [f64; 3] {
    let function = oracles::truth(folder, "brdf").unwrap_or_else(|| panic!("{folder} has no truth"));
    move |v, l| {
        let mut s = json!({"normal": [0.0, 0.0, 1.0], "tangent": [1.0, 0.0, 0.0]});
        s.as_object_mut().unwrap().extend(surface.as_object().unwrap().clone());
        let inputs = json!({"s": s, "v": v.to_array(), "l": l.to_array()});
        let at = At {
            inputs: &inputs,
            params: &params,
            instances: &[],
        };
        function(&at).try_into().expect("three channels")
    }
}

fn merl(function: impl Fn(DVec3, DVec3) -> [f64; 3]) -> Measured {
    Measured::read(&Merl::tabulate([24, 20, 30], function).write()).expect("a table")
}

fn models(names: &[&str]) -> IndexMap<String, Recipe> {
    let recipe = |name: &&str| ((*name).to_owned(), Recipe::from(Node::new(format!("brdf/{name}"))));
    names.iter().map(recipe).collect()
}

fn fitted(table: &Measured, names: &[&str]) -> Result<Fits, MeasureError> {
    let catalog = catalog();
    let options = FitOptions {
        quick: true,
        cancel: &AtomicBool::new(false),
        progress: &|_, _, _| {},
    };
    fit(&catalog, &subject(&catalog), models(names), ("a table", table), &options)
}

/// Whether the parameters of a fit are those that the table was made of, within 1 %.
#[track_caller]
fn assert_found(fit: &Fit, expected: &[(&str, &[f64])]) {
    for (name, values) in expected {
        let found = fit.parameters.iter().find(|one| one.name == *name);
        let found = found.unwrap_or_else(|| panic!("no {name} in {:?}", fit.parameters));
        assert_eq!(found.values.len(), values.len());
        for (got, expected) in found.values.iter().zip(*values) {
            assert!(
                (got / expected - 1.0).abs() < 0.01,
                "{name}: {:?} instead of {values:?}",
                found.values
            );
        }
    }
    assert_eq!(fit.parameters.len(), expected.len(), "{:?}", fit.parameters);
}

/// Catches a fit that stops early, compares other directions than were measured, or writes a parameter elsewhere; a ranking by anything
/// but the error.
#[test]
fn a_table_of_ggx_is_recovered() {
    let surface = json!({"alpha": 0.18, "f0": [0.9, 0.6, 0.3], "diffuse": [0.05, 0.1, 0.2]});
    let table = merl(truth("brdf/microfacet", surface, json!({})));
    let fits = fitted(&table, &["ward", "microfacet", "lambert", "blinn-phong"]).unwrap_or_else(|error| panic!("{error}"));
    let best = &fits.rows[0];
    assert_eq!(best.label, "microfacet", "{:#?}", fits.rows);
    assert_found(
        best,
        &[("s.diffuse", &[0.05, 0.1, 0.2]), ("s.f0", &[0.9, 0.6, 0.3]), ("s.alpha", &[0.18])],
    );
    assert!(best.errors.rms < 1e-5 && fits.rows[1].errors.rms > 1e-2, "{:#?}", fits.rows);
    let order: Vec<f64> = fits.rows.iter().map(|row| row.errors.rms).collect();
    assert!(order.is_sorted() && order.len() == 4, "{order:?}");
    let lambert = fits.rows.iter().find(|row| row.label == "lambert").unwrap();
    assert!(!lambert.dominated && !best.dominated, "the cheapest and the best");
    // The same fits, to the last bit.
    let again = fitted(&table, &["ward", "microfacet", "lambert", "blinn-phong"]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again, fits);
}

/// Catches two widths that are told apart in an isotropic table, and a fit of one that is off.
#[test]
fn a_table_of_ward_is_recovered() {
    let surface = json!({"widths": [0.25, 0.25], "f0": [0.2, 0.1, 0.05], "diffuse": [0.3, 0.2, 0.4]});
    let fits = fitted(&merl(truth("brdf/ward", surface, json!({}))), &["microfacet", "ward", "lambert"]).unwrap_or_else(|e| panic!("{e}"));
    let best = &fits.rows[0];
    assert_eq!(best.label, "ward", "{:#?}", fits.rows);
    assert_found(
        best,
        &[
            ("s.diffuse", &[0.3, 0.2, 0.4]),
            ("s.f0", &[0.2, 0.1, 0.05]),
            ("s.widths", &[0.25, 0.25]),
        ],
    );
}

/// Catches a dear model that is put before a cheap one that is as right.
#[test]
fn a_table_of_lambert_is_recovered() {
    let surface = json!({"diffuse": [0.7, 0.35, 0.1]});
    let fits =
        fitted(&merl(truth("brdf/lambert", surface, json!({}))), &["ward", "microfacet", "lambert"]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(fits.rows[0].label, "lambert", "{:#?}", fits.rows);
    assert_found(&fits.rows[0], &[("s.diffuse", &[0.7, 0.35, 0.1])]);
    assert!(fits.rows[1].dominated && fits.rows[2].dominated, "{:#?}", fits.rows);
}

/// Catches a module's own parameter that is not free.
#[test]
fn a_modules_own_parameter_is_recovered() {
    let surface = json!({"widths": [0.3, 0.3], "f0": [0.4, 0.3, 0.2], "diffuse": [0.1, 0.1, 0.1]});
    let fits = fitted(&merl(truth("brdf/kurt", surface, json!({"alpha_k": 0.3}))), &["kurt"]).unwrap_or_else(|e| panic!("{e}"));
    assert_found(
        &fits.rows[0],
        &[
            ("s.diffuse", &[0.1, 0.1, 0.1]),
            ("s.f0", &[0.4, 0.3, 0.2]),
            ("s.widths", &[0.3, 0.3]),
            ("alpha_k", &[0.3]),
        ],
    );
}

/// Catches values of the other format that are off by a factor or a cosine.
#[test]
fn a_table_along_the_lobe_is_recovered() {
    let (alpha, f0) = (0.3, [0.5, 0.4, 0.3]);
    let surface = json!({"alpha": alpha, "f0": f0, "diffuse": [0.05, 0.05, 0.05]});
    let normals = |m: DVec3| reflection::ggx_d(alpha, reflection::angle(DVec3::Z, m));
    let area = |v: DVec3| v.z.max(1e-3) * (1.0 + reflection::ggx_lambda(alpha, v.z.max(1e-3).acos()));
    let facets = Facets {
        normals: &normals,
        area: &area,
    };
    let fields = tabulate([1, 8, 24], facets, truth("brdf/microfacet", surface, json!({})));
    let table = Measured::Rgl(Rgl::read(&write_tensors(&fields)).expect("a table"));
    let fits = fitted(&table, &["microfacet", "ward"]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(fits.rows[0].label, "microfacet", "{:#?}", fits.rows);
    assert_found(&fits.rows[0], &[("s.diffuse", &[0.05; 3]), ("s.f0", &f0), ("s.alpha", &[alpha])]);
}

/// Catches a fit that cannot be stopped, and a model of another category that is taken.
#[test]
fn what_cannot_be_fitted_is_told() {
    let table = merl(truth("brdf/lambert", json!({"diffuse": [0.5, 0.5, 0.5]}), json!({})));
    let catalog = catalog();
    let cancel = AtomicBool::new(false);
    cancel.store(true, Ordering::Relaxed);
    let options = FitOptions {
        quick: true,
        cancel: &cancel,
        progress: &|_, _, _| {},
    };
    let stopped = fit(&catalog, &subject(&catalog), models(&["lambert"]), ("a table", &table), &options);
    assert!(matches!(stopped, Err(MeasureError::Interrupted)), "{stopped:?}");
    let other = IndexMap::from([("ggx".to_owned(), Recipe::from(Node::new("ggx")))]);
    let error = fit(&catalog, &subject(&catalog), other, ("a table", &table), &options).unwrap_err();
    assert_eq!(error.to_string().trim(), "error[SW1105]: `ggx` is a module of `ndf`, not of `brdf`");
    let grazing = Measured::read(&Merl::tabulate([2, 2, 2], |_, _| [1.0; 3]).write()).expect("a table");
    let empty = grazing.samples(10, 0.01);
    assert!(empty.is_empty());
}

/// Catches a declaration that is taken with a function, an argument or a member that is not there, or told without its place.
#[test]
fn wrong_declarations_are_told_where_they_stand() {
    let catalog = catalog();
    let error = |text: &str| match read(&catalog, "brdf", "brdf/brdf.fit.ron", text) {
        Ok(_) => panic!("{text} is taken"),
        Err(report) => report.render().trim().to_owned(),
    };
    let at = |message: &str, text: &str, (column, length): (usize, usize), label: &str| {
        let (space, mark) = (" ".repeat(column - 1), "^".repeat(length));
        format!("error[SW1105]: {message}\n  --> brdf/brdf.fit.ron:1:{column}\n  |\n1 | {text}\n  | {space}{mark} {label}")
    };
    let text = "(function: \"bdrf\", view: \"v\", light: \"l\", free: {})";
    let told = at("`brdf` has no function `bdrf`", text, (12, 6), "no such function");
    let functions = "\n  |\n  = did you mean `brdf`?\n  = functions: brdf, brdf_sample, brdf_pdf";
    assert_eq!(error(text), format!("{told}{functions}"));
    let text = "(function: \"brdf\", view: \"v\", light: \"s\", free: {})";
    let told = at("`brdf` has no argument `s` with three numbers", text, (38, 3), "a direction is one");
    assert_eq!(error(text), told);
    let text = "(function: \"brdf\", view: \"v\", light: \"l\", free: {\"s.alhpa\": (0.0, 1.0)})";
    let told = at(
        "`brdf` has no floats at `s.alhpa`",
        text,
        (61, 10),
        "an argument's member, such as `s.alpha`",
    );
    assert_eq!(error(text), told);
    let text = "(function: \"brdf\", view: \"v\", light: \"l\", free: {\"s.f0\": (1.0, 0.0)})";
    let told = at(
        "the range of `s.f0` holds nothing",
        text,
        (58, 10),
        "the least value, then the largest",
    );
    assert_eq!(error(text), told);
}

/// Catches a page that loses the fits, is no XML with them, or speaks of experiments that were not asked for.
#[test]
fn the_page_shows_the_fits() {
    let table = merl(truth("brdf/lambert", json!({"diffuse": [0.5, 0.5, 0.5]}), json!({})));
    let mut fits = fitted(&table, &["lambert", "phong"]).unwrap_or_else(|error| panic!("{error}"));
    fits.without.insert("<none>".into(), "because".into());
    let report = Report {
        fits: vec![fits],
        ..Report::default()
    };
    let files = write::files(&report).unwrap();
    let page = std::str::from_utf8(&files[0].1).unwrap();
    let document = roxmltree::Document::parse_with_options(
        page,
        roxmltree::ParsingOptions {
            allow_dtd: true,
            ..roxmltree::ParsingOptions::default()
        },
    );
    let document = document.unwrap_or_else(|error| panic!("{error}"));
    let text: String = document.descendants().filter_map(|node| node.text()).collect();
    for said in [
        "Best fits to a table",
        "lambert",
        "s.diffuse (0.500, 0.500, 0.500)",
        "<none>: because",
        "phong",
    ] {
        assert!(text.contains(said), "no {said}");
    }
    assert!(!text.contains("Modules without a row") && !text.contains("Device against evaluator"));
    let markdown = write::markdown(&report);
    assert!(
        markdown.contains("## Best fits to a table\n") && markdown.contains("| lambert |"),
        "{markdown}"
    );
    let json: Report = serde_json::from_slice(&files[1].1).unwrap();
    assert_eq!(json, report);
}
