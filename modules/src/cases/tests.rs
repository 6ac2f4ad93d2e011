use std::collections::BTreeMap;

use shadewright_compiler::Library;

use super::*;
use crate::Embedded;

fn only(text: &str) -> Case {
    let mut cases = parse(text).unwrap();
    assert_eq!(cases.len(), 1);
    cases.remove(0)
}

#[test]
fn reads_structs_vectors_and_numbers() {
    let case = only(
        r#"[(function: "f", inputs: {"s": {"alpha": 0.25, "normal": (0, 0, 1)}, "h": (0.0, 0.0, 1.0), "x": 2}, expect: 1, relative: 1e-5)]"#,
    );
    let Input::Struct(s) = &case.inputs["s"] else {
        panic!("{:?}", case.inputs)
    };
    assert_eq!(s["alpha"], Value::Number(0.25));
    assert_eq!(s["normal"], Value::List(vec![0.0, 0.0, 1.0]));
    assert_eq!(case.inputs["h"], Input::Value(Value::List(vec![0.0, 0.0, 1.0])));
    assert_eq!(case.inputs["x"], Input::Value(Value::Number(2.0)));
    assert_eq!(case.expect, Expected::Value(Value::Number(1.0)));
}

/// Catches a misspelt field being ignored.
#[test]
fn unknown_fields_are_errors() {
    let error = parse(r#"[(function: "f", inputs: {}, expect: 1.0, relativ: 1e-5)]"#).unwrap_err();
    assert!(error.contains("relativ"), "{error}");
}

/// Catches a case that could never fail, or never hold.
#[test]
fn a_case_needs_a_tolerance() {
    let error = parse(r#"[(function: "f", inputs: {}, expect: 1.0)]"#).unwrap_err();
    assert!(error.contains("case 0") && error.contains("relative"), "{error}");
    assert!(parse(r#"[(function: "f", inputs: {}, expect: 1.0, relative: -1.0)]"#).is_err());
}

/// Catches a tolerance that lets NaN through.
#[test]
fn tolerances() {
    let case = only(r#"[(function: "f", inputs: {}, expect: 2.0, relative: 0.1, absolute: 0.05)]"#);
    assert!(case.accepts(2.0, 2.249) && case.accepts(2.0, 1.751) && !case.accepts(2.0, 2.251));
    assert!(!case.accepts(2.0, f64::NAN) && !case.accepts(0.0, 0.051));
}

/// Catches a module without documentation, without its one WGSL file, or with cases that do not parse.
#[test]
fn every_module_is_complete() {
    let mut modules: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (path, _) in Embedded.files() {
        if let [category, module, file] = path.split('/').collect::<Vec<_>>()[..] {
            modules.entry(format!("{category}/{module}")).or_default().push(file);
        }
    }
    assert!(modules.len() >= 20, "{}", modules.len());
    for (module, files) in modules {
        let name = module.split('/').next_back().unwrap();
        let wgsl = format!("{name}.wgsl");
        // What a module may have beside that.
        let experiment = format!("{name}.experiment.ron");
        let mut files: Vec<&str> = files.into_iter().filter(|file| *file != experiment).collect();
        files.sort_unstable();
        let mut wanted = vec!["README.md", "cases.ron", "module.ron", wgsl.as_str()];
        wanted.sort_unstable();
        assert_eq!(files, wanted, "{module}");

        let read = |file: &str| Embedded.read(&format!("{module}/{file}")).unwrap().unwrap();
        assert!(read("README.md").starts_with(&format!("# {name}\n")), "{module}");
        let cases = parse(&read("cases.ron")).unwrap_or_else(|e| panic!("{module}/cases.ron: {e}"));
        for case in &cases {
            assert!(
                !case.source.is_empty(),
                "{module}/cases.ron: `{}` does not say where its value is from",
                case.function
            );
        }
    }
}

/// Catches a manifest that the compiler's types do not accept.
#[test]
fn every_manifest_parses() {
    use shadewright_compiler::manifest::{CategoryManifest, ModuleManifest};
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    for (path, text) in Embedded.files() {
        let said = if path.ends_with("/category.ron") {
            options.from_str::<CategoryManifest>(text).map(|_| ()).map_err(|e| e.to_string())
        } else if path.ends_with("/module.ron") {
            options.from_str::<ModuleManifest>(text).map(|_| ()).map_err(|e| e.to_string())
        } else {
            Ok(())
        };
        assert_eq!(said, Ok(()), "{path}");
    }
}
