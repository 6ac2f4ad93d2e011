//! `new`.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use support::{bad, good, names, run};

/// Catches a category whose skeleton does not pass `check`, or whose module the library does not find.
#[test]
fn a_skeleton_of_every_category_passes_check() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().to_str().expect("UTF-8");
    let list = good(&["list", "--format", "json"]).json();
    for category in list["categories"].as_array().expect("a list") {
        let category = category["name"].as_str().expect("a name");
        let ran = good(&["new", category, "my-own", "--dir", root]);
        let made = folder.path().join(category).join("my-own");
        assert_eq!(names(&made), ["README.md", "cases.ron", "module.ron", "my-own.wgsl"], "{category}");
        assert!(ran.text().contains("module.ron"));
        good(&["check", made.to_str().unwrap()]);
        assert!(
            good(&["show", &format!("{category}/my-own"), "--modules", root])
                .text()
                .starts_with(&format!("{category}/my-own"))
        );
    }
    // All at once, as a library.
    good(&["check", root]);
}

/// Catches a skeleton whose comments describe fields that don't exist.
#[test]
fn the_examples_in_the_comments_are_valid() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().to_str().expect("UTF-8");
    good(&["new", "brdf", "mine", "--dir", root]);
    let made = folder.path().join("brdf/mine");
    let declaration = std::fs::read_to_string(made.join("module.ron")).unwrap();
    let example = |line: &str| line.trim_start().starts_with("// \"");
    let uncommented: Vec<String> = declaration
        .lines()
        .map(|line| {
            if example(line) {
                line.replacen("// ", "", 1)
            } else {
                line.to_owned()
            }
        })
        .collect();
    assert_ne!(uncommented.join("\n"), declaration.trim_end());
    std::fs::write(made.join("module.ron"), uncommented.join("\n")).unwrap();
    let wgsl = std::fs::read_to_string(made.join("mine.wgsl")).unwrap();
    std::fs::write(made.join("mine.wgsl"), format!("var ramp: texture_2d<f32>;\n{wgsl}")).unwrap();
    good(&["check", made.to_str().unwrap()]);
    let shown = good(&["show", "mine", "--modules", root]);
    for word in ["width", "0 to 1", "Distribution of microfacet normals", "ramp"] {
        assert!(shown.text().contains(word), "no `{word}` in\n{}", shown.text());
    }
}

/// Catches names that would be no folder, no WGSL file, or lead out of the directory; and a module written over another.
#[test]
fn bad_names_make_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().to_str().expect("UTF-8");
    let long = "a".repeat(65);
    for name in ["../escape", "Upper", "with space", "1st", "", "a/b", "a_b", "trailing-", &long] {
        bad(&["new", "brdf", name, "--dir", root], 1, &["cannot be a module's name"]);
    }
    bad(&["new", "brdff", "mine", "--dir", root], 1, &["`brdff`", "`brdf`"]);
    bad(&["new", "brdf", "lambert", "--dir", root], 1, &["already"]);
    assert_eq!(names(folder.path()), Vec::<String>::new());

    good(&["new", "brdf", "mine", "--dir", root]);
    let file = folder.path().join("brdf/mine/module.ron");
    std::fs::write(&file, "mine").unwrap();
    bad(&["new", "brdf", "mine", "--dir", root], 1, &["already"]);
    assert_eq!(std::fs::read_to_string(file).unwrap(), "mine");
    assert_eq!(names(&folder.path().join("brdf")), ["mine"]);
}

/// Catches a folder that is there by half when it cannot be written, and the wrong status for it.
#[test]
fn an_unwritable_folder_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    bad(&["new", "brdf", "mine", "--dir", file.to_str().unwrap()], 1, &["cannot be written"]);
}

/// Catches a list of modules kept by hand somewhere: a folder made by hand is found, edited code is seen.
#[test]
fn a_folder_is_all_that_a_module_needs() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = folder.path().to_str().expect("UTF-8");
    let module = folder.path().join("brdf/half");
    std::fs::create_dir_all(&module).unwrap();
    std::fs::write(module.join("module.ron"), "(summary: \"Half of white\")").unwrap();
    let code = |text: &str| std::fs::write(module.join("half.wgsl"), text).unwrap();
    code("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return vec3f(0.15915494);\n}\n");
    let listed = good(&["list", "--modules", root, "--category", "brdf"]);
    let line = listed
        .text()
        .lines()
        .find(|line| line.trim_start().starts_with("half "))
        .unwrap_or_default();
    assert!(line.ends_with(" Half of white"), "{}", listed.text());
    let recipe = r#"(module: "forward", fill: {"brdf": "half", "lights": ["point"]})"#;
    assert!(good(&["emit", recipe, "--modules", root]).text().contains("0.15915494"));
    bad(&["emit", recipe], 1, &["SW0201", "half"]);

    code("fn brdf(s: Surface, v: vec3f) -> vec3f {\n    return vec3f(0.0);\n}\n");
    wrong(&module, "half.wgsl:1:");
    code("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return vec3f(0.0)\n}\n");
    wrong(&module, "half.wgsl:");
}

/// Catches folders of modules in the wrong order, a file list in JSON that names other files than were made, and a check of a module's
/// neighbours instead of it.
#[test]
fn the_last_folder_counts() {
    let folders = [tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder")];
    for (folder, value) in folders.iter().zip(["0.125", "0.875"]) {
        let json = good(&["new", "brdf", "mine", "--dir", folder.path().to_str().unwrap(), "--format", "json"]).json();
        let made = json["files"].as_array().expect("a list");
        assert!(
            made.len() == 4 && made.iter().all(|file| Path::new(file.as_str().expect("a path")).is_file()),
            "{made:?}"
        );
        let code = format!("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {{\n    return vec3f({value});\n}}\n");
        std::fs::write(folder.path().join("brdf/mine/mine.wgsl"), code).unwrap();
    }
    let [first, second] = folders.each_ref().map(|folder| folder.path().to_str().unwrap());
    let recipe = r#"(module: "forward", fill: {"brdf": "mine", "lights": ["point"]})"#;
    let emitted = |a: &str, b: &str| good(&["emit", recipe, "--modules", a, "--modules", b]).text().to_owned();
    assert!(emitted(first, second).contains("vec3f(0.875)"));
    assert!(emitted(second, first).contains("vec3f(0.125)"));
    // A module's folder is that module; its category's folder and the whole are all modules in them.
    good(&["new", "brdf", "other", "--dir", first]);
    assert_eq!(good(&["check", &format!("{first}/brdf/mine")]).text(), "ok     module brdf/mine\n");
    for path in [&format!("{first}/brdf"), first] {
        assert_eq!(good(&["check", path]).text(), "ok     module brdf/mine\nok     module brdf/other\n");
    }
}

/// `check` finds the module wrong at this place.
fn wrong(module: &Path, place: &str) {
    let ran = run(&["check", module.to_str().unwrap()]);
    assert_eq!(ran.status, 1, "{}{}", ran.text(), ran.err);
    assert!(ran.err.contains(place), "no `{place}` in\n{}", ran.err);
}
