//! `report --measured`: models fitted to a file.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use glam::DVec3;
use shadewright::modules::oracles::reflection::{Surface, microfacet};
use shadewright::runtime::measured::Merl;
use support::{bad, good, names, run};

fn table() -> Vec<u8> {
    let glossy = |v: DVec3, l: DVec3| {
        [(0.1, 0.5), (0.2, 0.4), (0.3, 0.3)].map(|(diffuse, f0)| {
            let surface = Surface {
                normal: DVec3::Z,
                diffuse,
                f0,
                alpha: 0.25,
            };
            microfacet(&surface, v, l)
        })
    };
    Merl::tabulate([16, 12, 16], glossy).write()
}

/// Catches a command that ranks otherwise than the library, writes no page, or other bytes the second time.
#[test]
fn fits_models_to_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("glossy.binary");
    std::fs::write(&file, table()).unwrap();
    let file = file.to_str().unwrap();
    let reports = ["first", "second"].map(|name| {
        let out = folder.path().join(name);
        let markdown = folder.path().join(format!("{name}.md"));
        let said = good(&[
            "report",
            "--measured",
            file,
            "lambert",
            "brdf/microfacet",
            "(module: \"microfacet\", fill: {\"ndf\": \"beckmann\"})",
            "--quick",
            "-o",
            out.to_str().unwrap(),
            "--markdown",
            markdown.to_str().unwrap(),
        ]);
        let lines: Vec<&str> = said.text().lines().collect();
        assert!(
            lines[0].starts_with("brdf/microfacet: RMS ") && lines[0].contains("s.alpha 0.250"),
            "{}",
            said.text()
        );
        assert_eq!(lines.len(), 4, "{}", said.text());
        assert!(lines[2].starts_with("lambert: RMS "), "{}", said.text());
        assert_eq!(lines[3], format!("3 rows: {}", out.join("report.html").display()));
        let files = names(&out);
        assert!(
            files.contains(&"report.html".to_owned()) && files.contains(&"report.json".to_owned()),
            "{files:?}"
        );
        let text = std::fs::read_to_string(&markdown).unwrap();
        assert!(text.contains("| brdf/microfacet |"), "{text}");
        let mut json: serde_json::Value = serde_json::from_slice(&std::fs::read(out.join("report.json")).unwrap()).unwrap();
        json["provenance"]["date"].take();
        (json, text)
    });
    assert_eq!(reports[0], reports[1]);
    let fit = &reports[0].0["fits"][0];
    assert_eq!(fit["name"], file);
    assert_eq!(fit["rows"][1]["label"], "(module: \"microfacet\", fill: {\"ndf\": \"beckmann\"})");
}

/// Catches a damaged file, a wrong model or a wrong option that is taken, or told without its place.
#[test]
fn says_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("cut.binary");
    std::fs::write(&path, &table()[..1000]).unwrap();
    let file = path.to_str().unwrap();
    let ran = run(&["report", "--measured", file]);
    assert_eq!(ran.status, 1);
    let expected =
        format!("error[SW1106]: {file}: byte 1000: expected 73740 bytes for 16 x 12 x 16 cells of three channels, found 1000 bytes");
    assert_eq!(ran.err.trim(), expected);
    std::fs::write(&path, table()).unwrap();
    let ran = run(&["report", "--measured", file, "ggx", "-o", folder.path().to_str().unwrap()]);
    assert_eq!(ran.err.trim(), "error[SW1105]: `ggx` is a module of `ndf`, not of `brdf`");
    bad(&["report", "--measured", file, "labmert"], 1, &["SW0201", "lambert"]);
    bad(&["report", "--measured", "nowhere.binary"], 1, &["nowhere.binary: cannot be read"]);
    bad(&["report", "--measured", file, "--check", "spec/baseline.json"], 2, &["--check"]);
    assert_eq!(names(folder.path()), ["cut.binary"]);
}
