//! The command `table`: the numbers that fill a module's buffer.
#![allow(clippy::unwrap_used)]

mod support;

use std::fs;

use support::{bad, good};

/// A library with a module that has a table of its own, one that a recipe must name, and an example.
fn library() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let module = folder.path().join("ndf/stepped");
    fs::create_dir_all(&module).unwrap();
    fs::write(
        module.join("module.ron"),
        "(summary: \"Steps\", resources: {
            \"own\": (kind: Data(file: \"own.f32\")),
            \"named\": (kind: Data(format: \"f32\")),
        })",
    )
    .unwrap();
    fs::write(
        module.join("stepped.wgsl"),
        "var<storage> own: array<f32, 2>;\nvar<storage> named: array<f32>;\nfn distribution(s: Surface, h: vec3f) -> f32 { return own[0] * named[1]; }\n",
    )
    .unwrap();
    fs::write(module.join("own.f32"), [0, 0, 0x80, 0x3f, 0, 0, 0, 0x40]).unwrap();
    folder
}

/// Catches bytes that are not the file's, a recomputed table that is another one, and half a file.
#[test]
fn tables_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let (kept, made) = (folder.path().join("kept.f32"), folder.path().join("made.f32"));
    good(&["table", "albedo/tabulated", "albedo", "-o", kept.to_str().unwrap()]);
    good(&["table", "albedo/tabulated", "albedo", "--make", "-o", made.to_str().unwrap()]);
    let bytes = fs::read(&kept).unwrap();
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/modules/albedo/tabulated/albedo.f32");
    assert_eq!(bytes, fs::read(own).unwrap());
    assert_eq!(bytes, fs::read(&made).unwrap());
}

/// Catches a module's own table that another file takes the place of, a file that nobody checks, and errors without a way out.
#[test]
fn what_cannot_be_written_is_said() {
    let library = library();
    let modules = library.path().to_str().unwrap();
    fn with<'a>(modules: &'a str, more: &[&'a str]) -> Vec<&'a str> {
        [&["--modules", modules, "table"], more].concat()
    }
    let file = library.path().join("ndf/stepped/own.f32");
    let named = file.to_str().unwrap();
    let out = library.path().join("out.f32");
    let to = out.to_str().unwrap();
    good(&with(modules, &["stepped", "named", "--file", named, "-o", to]));
    assert_eq!(fs::read(&out).unwrap(), [0, 0, 0x80, 0x3f, 0, 0, 0, 0x40]);
    fs::remove_file(&out).unwrap();
    bad(&with(modules, &["stepped", "named", "-o", to]), 1, &["--file", "`f32`"]);
    bad(
        &with(modules, &["stepped", "own", "--file", named, "-o", to]),
        2,
        &["takes no other file"],
    );
    bad(&with(modules, &["stepped", "own", "--make", "-o", to]), 1, &["no `table.rs`"]);
    bad(&with(modules, &["stepped", "owm", "-o", to]), 1, &["SW0214", "did you mean `own`?"]);
    fs::write(library.path().join("cut"), [0; 7]).unwrap();
    let cut = library.path().join("cut");
    bad(
        &with(modules, &["stepped", "named", "--file", cut.to_str().unwrap(), "-o", to]),
        1,
        &["7 bytes are no whole number"],
    );
    assert!(!out.exists());
}

/// Catches a probe that reads another table than the module's, and a file named by a recipe that is looked for beside the working folder.
#[test]
fn a_recipe_names_files_beside_itself() {
    let library = library();
    let modules = library.path().to_str().unwrap();
    fs::write(library.path().join("mine.f32"), [0, 0, 0, 0, 0, 0, 0x40, 0x40]).unwrap();
    let recipe = library.path().join("steps.recipe.ron");
    fs::write(&recipe, "(module: \"stepped\", files: {\"named\": \"mine.f32\"})").unwrap();
    let inputs = library.path().join("in.json");
    fs::write(&inputs, "[{\"h\": [0, 0, 1]}]").unwrap();
    let said = good(&[
        "--modules",
        modules,
        "probe",
        recipe.to_str().unwrap(),
        "distribution",
        "--inputs",
        inputs.to_str().unwrap(),
        "--device",
        "cpu",
    ]);
    assert_eq!(said.json()["results"], serde_json::json!([3.0]));
}
