//! The helper for build scripts.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};

use shadewright_modules::build::{Build, BuildError};

/// A folder with a module, a recipe that has it, and a folder to write into.
fn project() -> tempfile::TempDir {
    let base = tempfile::tempdir().unwrap();
    let put = |path: &str, text: &str| {
        let path = base.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    put("out/keep", "");
    put(
        "modules/brdf/chalk/module.ron",
        "(summary: \"Chalk\", params: {\"rim\": (type: F32, default: 0.25)})",
    );
    put(
        "modules/brdf/chalk/chalk.wgsl",
        "fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return s.diffuse * params.rim;\n}\n",
    );
    put("modules/brdf/other/module.ron", "(summary: \"Not asked for\")");
    put("modules/brdf/other/other.wgsl", "fn brdf(");
    put(
        "chalk-board.recipe.ron",
        "(module: \"forward\", fill: {\"brdf\": \"chalk\", \"lights\": [(module: \"point\", fill: {\"visibility\": \"cube-map\"})]})",
    );
    base
}

fn build(base: &Path) -> Build {
    Build::new()
        .modules(base.join("modules"))
        .recipe(base.join("chalk-board.recipe.ron"))
        .out_dir(base.join("out"))
}

/// Catches a pass that is not written, a file that cargo is not told of, and one that it need not look at.
#[test]
fn writes_every_pass_and_says_what_was_read() {
    let base = project();
    let root = fs::canonicalize(base.path()).unwrap();
    let written = build(base.path()).run().unwrap();
    assert_eq!(written.files, [base.path().join("out/chalk_board.rs")]);
    let text = fs::read_to_string(&written.files[0]).unwrap();
    for part in ["pub mod chalk_board {", "pub mod chalk_board_cube_map_shadow {", "chalk_rim: 0.25,"] {
        assert!(text.contains(part), "no `{part}` in\n{text}");
    }
    let read: Vec<_> = written
        .read
        .iter()
        .map(|path| path.strip_prefix(&root).unwrap().display().to_string())
        .collect();
    let expected = [
        "chalk-board.recipe.ron",
        "modules",
        "modules/brdf/chalk/chalk.wgsl",
        "modules/brdf/chalk/module.ron",
        "modules/brdf/other/module.ron",
    ];
    assert_eq!(read, expected);
}

/// Catches a file that is written again although nothing has changed, for which cargo would build everything again, and one that is not
/// although something has.
#[test]
fn only_what_changes_is_written() {
    let base = project();
    let file = build(base.path()).run().unwrap().files.remove(0);
    let long_ago = SystemTime::now() - Duration::from_secs(1000);
    let set = || fs::File::options().write(true).open(&file).unwrap().set_modified(long_ago).unwrap();
    let age = || fs::metadata(&file).unwrap().modified().unwrap();
    set();
    build(base.path()).run().unwrap();
    assert_eq!(age(), long_ago);
    fs::write(
        base.path().join("modules/brdf/chalk/module.ron"),
        "(summary: \"Chalk\", params: {\"rim\": (type: F32, default: 0.5)})",
    )
    .unwrap();
    build(base.path()).run().unwrap();
    assert!(age() > long_ago && fs::read_to_string(&file).unwrap().contains("chalk_rim: 0.5,"));
}

/// Catches errors without a place, and files of some recipes where another is wrong.
#[test]
fn nothing_is_written_where_something_is_wrong() {
    let base = project();
    fs::write(
        base.path().join("wrong.recipe.ron"),
        "(module: \"forward\", fill: {\"brdf\": \"other\"})",
    )
    .unwrap();
    let error = build(base.path()).recipe(base.path().join("wrong.recipe.ron")).run().unwrap_err();
    assert!(
        matches!(error, BuildError::Shader(_)) && error.to_string().contains("brdf/other/other.wgsl:1:"),
        "{error}"
    );
    let absent = build(base.path()).recipe("absent.recipe.ron").run().unwrap_err();
    assert!(absent.to_string().starts_with("error: absent.recipe.ron: "), "{absent}");
    let absent = build(base.path()).modules(base.path().join("absent")).run().unwrap_err();
    assert!(matches!(absent, BuildError::File { .. }), "{absent}");
    let same = build(base.path())
        .recipe(base.path().join("./chalk-board.recipe.ron"))
        .run()
        .unwrap_err();
    assert!(matches!(same, BuildError::Twice(_)), "{same}");
    let names: Vec<_> = fs::read_dir(base.path().join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    assert_eq!(names, ["keep"]);
}

/// Does what a build script does, in a process of its own: only where the next test asks for it.
#[test]
fn in_a_process_of_its_own() {
    if let Some(base) = std::env::var_os("SHADEWRIGHT_TEST_BUILD") {
        build(Path::new(&base)).write();
    }
}

/// Catches a build script that succeeds although something is wrong, that says errors to cargo, and one that is not run again when a
/// shader changes.
#[test]
fn a_build_script_speaks_to_cargo() {
    let base = project();
    let run = || {
        let mut command = Command::new(std::env::current_exe().unwrap());
        command.args(["--exact", "in_a_process_of_its_own", "--nocapture"]);
        command.env("SHADEWRIGHT_TEST_BUILD", base.path()).output().unwrap()
    };
    let good = run();
    let out = String::from_utf8(good.stdout).unwrap();
    let line = format!(
        "cargo::rerun-if-changed={}/modules/brdf/chalk/chalk.wgsl\n",
        fs::canonicalize(base.path()).unwrap().display()
    );
    assert!(good.status.success() && out.contains(&line), "{out}");
    fs::write(base.path().join("modules/brdf/chalk/chalk.wgsl"), "fn brdf(s: Surface").unwrap();
    let bad = run();
    assert_eq!(bad.status.code(), Some(1));
    let (out, err) = (String::from_utf8(bad.stdout).unwrap(), String::from_utf8(bad.stderr).unwrap());
    assert!(err.contains("error[SW") && err.contains("brdf/chalk/chalk.wgsl:1:"), "{err}");
    assert!(!out.contains("rerun"), "{out}");
}
