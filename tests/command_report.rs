//! `report`: what it writes, what it compares, what it says of what is wrong.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use serde_json::Value;
use support::{bad, good, names, run};

fn read(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Catches a missing output, a report that begins anew what is done, and one whose figures are others the second time.
#[test]
fn writes_a_page_with_all_that_belongs_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let arguments = ["report", "fresnel", "--quick", "--no-device", "-o", out.to_str().unwrap()];
    let text = good(&arguments);
    assert!(text.text().contains("report.html"), "{}", text.text());
    let files = names(&out);
    for file in ["report.html", "report.json", "rows.csv", "plots", ".done"] {
        assert!(files.iter().any(|name| name.starts_with(file)), "{file}: {files:?}");
    }
    let first = read(&out.join("report.json"));
    let rows = first["experiments"]
        .as_array()
        .unwrap()
        .iter()
        .map(|e| e["rows"].as_array().unwrap().len())
        .sum::<usize>();
    let done = |out: &Path| std::fs::read_dir(out.join(".done")).unwrap().count();
    assert_eq!(done(&out), rows);
    assert_eq!(first["provenance"]["device"], "");

    // What is done is taken as it is: a mark in it comes back.
    let kept = std::fs::read_dir(out.join(".done")).unwrap().next().unwrap().unwrap().path();
    let mut marked = read(&kept);
    marked["row"]["summary"] = "kept".into();
    std::fs::write(&kept, marked.to_string()).unwrap();
    good(&arguments);
    let again = read(&out.join("report.json"));
    assert!(again.to_string().contains("\"summary\":\"kept\""));
    assert_eq!(done(&out), rows);
    // A file that is no row is measured again.
    std::fs::write(&kept, "{").unwrap();
    good(&arguments);
    let third = read(&out.join("report.json"));
    assert_eq!(third["experiments"], first["experiments"]);
}

/// Catches a comparison that is silent, or that does not name the row; and a baseline that is half written over.
#[test]
fn compares_with_a_baseline() {
    let accepted = Path::new(env!("CARGO_MANIFEST_DIR")).join("spec/baseline.json");
    let folder = tempfile::tempdir().unwrap();
    let mut baseline = read(&accepted);
    baseline["rows"]["fresnel: schlick"]["model"]["rms"] = 1e-3.into();
    baseline["rows"]["fresnel: schlick"]["cost"]["add"] = 99.into();
    let changed = folder.path().join("baseline.json");
    std::fs::write(&changed, baseline.to_string()).unwrap();
    let ran = run(&["report", "--check", changed.to_str().unwrap(), "--format", "json"]);
    assert_eq!(ran.status, 1);
    let json = ran.json();
    let line = |list: &str| json[list][0].as_str().unwrap_or_default().to_owned();
    assert_eq!(json["worse"].as_array().unwrap().len(), 1);
    assert!(line("worse").contains("fresnel: schlick: model error (rms)"), "{json}");
    assert!(line("better").contains("fresnel: schlick: add"), "{json}");
    std::fs::write(&changed, "{\"rows\": 1}").unwrap();
    bad(
        &["report", "--check", changed.to_str().unwrap()],
        1,
        &["SW1104", "baseline.json:1:"],
    );
    bad(&["report", "--check", "/no/such/file"], 1, &["/no/such/file"]);
}

/// Catches a misspelt category that gives an empty report, an experiment that is wrong and taken, and options that contradict each other.
#[test]
fn what_is_wrong_is_said() {
    bad(
        &["report", "fresnl", "--no-device"],
        1,
        &["no experiment is about a category `fresnl`; did you mean `fresnel`?"],
    );
    bad(&["report", "--check", "a", "--accept", "b"], 2, &["--accept"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ndf");
    std::fs::create_dir_all(&path).unwrap();
    std::fs::write(
        path.join("ndf.experiment.ron"),
        "[(title: \"a\", function: \"distribution\", inputs: {\"h\": Hemispher}, truth: Own, metric: Absolute())]",
    )
    .unwrap();
    let modules = folder.path().to_str().unwrap();
    bad(
        &["report", "ndf", "--modules", modules, "--no-device"],
        1,
        &["SW0104", "Hemisphere", "ndf/ndf.experiment.ron:1:"],
    );
}
