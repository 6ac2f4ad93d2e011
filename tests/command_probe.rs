//! `probe` on the CPU: no driver is asked for.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use serde_json::{Value, json};
use support::{Ran, bad, finish, shadewright};

const ROWS: &str = r#"[{"s": {"alpha": 0.3}, "h": [0, 0, 1]}, {"s": {"alpha": 0.3}, "h": [0.8, 0, 0.6]}]"#;

/// Runs a probe where no driver answers.
fn on_cpu(arguments: &[&str]) -> Ran {
    let mut command = shadewright();
    for variable in ["VK_ICD_FILENAMES", "VK_DRIVER_FILES", "VK_ADD_DRIVER_FILES"] {
        command.env(variable, "/nonexistent");
    }
    let mut all = vec!["probe", "ggx", "distribution", "--inputs", "-", "--device", "cpu"];
    all.extend(arguments);
    let ran = finish(command.args(all).write_stdin(ROWS));
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
    ran
}

/// Catches a GPU that is asked for all the same, a number type that is not taken, and bounds that are not written.
#[test]
fn the_cpu_needs_no_driver() {
    let f32s = on_cpu(&[]).json();
    assert_eq!((&f32s["device"], &f32s["function"]), (&json!("cpu f32"), &json!("distribution")));
    let truth = |c: f64| {
        let a2 = f64::from(0.3_f32).powi(2);
        a2 / (std::f64::consts::PI * (a2 * c * c + 1.0 - c * c).powi(2))
    };
    // Literals are f32: the factor 1 / pi is rounded also in double precision.
    let expected = [truth(1.0), truth(0.6)];
    let f64s = on_cpu(&["--number", "f64"]).json();
    assert_eq!(f64s["device"], "cpu f64");
    for (row, expected) in expected.iter().enumerate() {
        let (single, double) = (f32s["results"][row].as_f64().unwrap(), f64s["results"][row].as_f64().unwrap());
        assert!(
            (single / expected - 1.0).abs() < 1e-6 && (double / expected - 1.0).abs() < 2e-7,
            "{single} {double} {expected}"
        );
        assert!(single.to_string().len() < 12 && double.to_string().len() > 14, "{single} {double}");
    }
    let allowed = on_cpu(&["--number", "allowed"]).json();
    assert_eq!((&allowed["device"], &allowed["undecided"]), (&json!("cpu allowed"), &json!([])));
    let one = &allowed["results"][1];
    assert_eq!(one["value"], f32s["results"][1]);
    let bound = |of: &Value| of.as_f64().unwrap();
    assert!(
        bound(&one["low"]) < bound(&one["value"]) && bound(&one["value"]) < bound(&one["high"]),
        "{one}"
    );
    bad(
        &["probe", "ggx", "distribution", "--inputs", "-", "--number", "f64"],
        2,
        &["--number needs --device cpu"],
    );
}
