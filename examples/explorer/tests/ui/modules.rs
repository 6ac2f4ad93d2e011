//! Modules of one's own, edited while the explorer shows them.

use std::path::Path;
use std::time::{Duration, Instant};

use egui_kittest::Harness;
use explorer::App;

use crate::harness::{mean, open_small, said, settle};

fn module(folder: &Path, body: &str) {
    let module = folder.join("brdf/mine");
    std::fs::create_dir_all(&module).unwrap();
    std::fs::write(module.join("module.ron"), "(summary: \"One of my own\")").unwrap();
    std::fs::write(
        module.join("mine.wgsl"),
        format!("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {{\n    return {body};\n}}\n"),
    )
    .unwrap();
}

/// Runs until something is so.
pub fn until(explorer: &mut Harness<App>, what: &str, is_so: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !is_so(explorer.state()) {
        assert!(start.elapsed() < Duration::from_secs(60), "never: {what}");
        std::thread::sleep(Duration::from_millis(10));
        settle(explorer);
    }
    settle(explorer);
}

/// Catches an edit that is not seen, a picture that goes with an error, an error without its place, and one that stays when it is mended.
#[test]
fn an_edit_of_a_module_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    module(folder.path(), "vec3f(0.05)");
    let mut explorer = open_small();
    explorer.state_mut().use_modules(Some(folder.path().to_owned()));
    until(&mut explorer, "loaded", |app| app.catalog.module("mine").is_ok());
    explorer
        .state_mut()
        .edit("mine", |draft| draft.set(&[], "materials.matt.brdf", "\"mine\""));
    settle(&mut explorer);
    let dark = mean(&explorer);
    module(folder.path(), "vec3f(0.3)");
    until(&mut explorer, "brighter", |app| {
        let painted = app.viewport.painted.as_ref().unwrap();
        painted.version == app.version && app.version > 3
    });
    let bright = mean(&explorer);
    assert!(bright[1] > dark[1] * 1.2, "{dark:?} {bright:?}");
    module(folder.path(), "vec3f(0.3) + nothing");
    until(&mut explorer, "an error", |app| !app.problems.is_empty());
    let explorer::Problem::Report(report) = &explorer.state().problems[0] else {
        panic!()
    };
    let text = report.render();
    assert!(text.contains("mine.wgsl:2:"), "{text}");
    assert_eq!(mean(&explorer), bright, "the last good picture stays");
    module(folder.path(), "vec3f(0.05)");
    until(&mut explorer, "mended", |app| app.problems.is_empty());
    assert_eq!(mean(&explorer), dark);
    assert_eq!(said(&explorer, "materials.matt.brdf"), Some("\"mine\""));
    // What the explorer reads itself is no change: three edits here, each seen at most twice, and three versions before.
    assert!(explorer.state().version <= 9, "{}", explorer.state().version);
}
