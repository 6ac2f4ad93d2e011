//! `bindings`, and that the example package compiles what the first scene is drawn with.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::collections::BTreeSet;
use std::path::Path;

use shadewright::compiler::{Catalog, Recipe};
use shadewright::runtime::scene::SceneFile;
use support::{MATTE, SHADOWED, bad, good, names, run_with_input};

/// Catches a file that differs from what standard output says, a pass that is lost, and modules that are not called as the manual says.
#[test]
fn modules_are_called_after_recipes_and_passes() {
    let modules = |text: &str| -> Vec<String> {
        let lines = text.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(" {"));
        lines.map(str::to_owned).collect()
    };
    assert_eq!(modules(good(&["bindings", MATTE]).text()), ["forward"]);
    assert_eq!(
        modules(good(&["bindings", SHADOWED, "--pass", "all"]).text()),
        ["forward", "forward_cube_map_shadow"]
    );
    assert_eq!(
        modules(good(&["bindings", SHADOWED, "--pass", "cube_map.shadow", "--pass", "main"]).text()),
        ["forward_cube_map_shadow", "forward"]
    );
    let recipes = ["examples/recipes/auto-exposure.recipe.ron", "examples/recipes/depth.recipe.ron"];
    assert_eq!(
        modules(good(&["bindings", recipes[0], recipes[1]]).text()),
        ["auto_exposure", "depth"]
    );
    assert_eq!(modules(run_with_input(&["bindings", "-"], MATTE).text()), ["forward"]);

    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("shaders.rs");
    let path = file.to_str().expect("UTF-8");
    assert_eq!(good(&["bindings", MATTE, "-o", path]).text(), "");
    assert_eq!(std::fs::read_to_string(&file).expect("written"), good(&["bindings", MATTE]).text());
    let json = good(&["bindings", MATTE, "--format", "json"]).json();
    assert_eq!(json["text"], good(&["bindings", MATTE]).text());
    assert_eq!(json["modules"][0]["module"], "forward");
    assert_eq!(
        json["modules"][0]["hash"],
        good(&["emit", MATTE, "--format", "json"]).json()["hash"]
    );
}

/// Catches a frozen parameter that still has a field.
#[test]
fn frozen_parameters_have_no_field() {
    let field = "pub metalness_base_color: [f32; 3],";
    assert!(good(&["bindings", MATTE]).text().contains(field));
    let frozen = good(&["bindings", MATTE, "--freeze", "material.base_color=(1.0, 0.5, 0.2)"]);
    assert!(!frozen.text().contains(field), "{}", frozen.text());
}

/// Catches half a file where something is wrong, and two modules of one name.
#[test]
fn nothing_is_written_where_something_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("shaders.rs");
    let path = file.to_str().expect("UTF-8");
    bad(
        &["bindings", MATTE, SHADOWED, "-o", path],
        2,
        &["two passes would be the module `forward`"],
    );
    bad(&["bindings", MATTE, "--pass", "all", "--pass", "main", "-o", path], 2, &["forward"]);
    bad(&["bindings", MATTE, "forwrad", "-o", path], 1, &["SW0201", "forward"]);
    bad(&["bindings", MATTE, "--pass", "absent", "-o", path], 1, &["SW0", "absent"]);
    bad(&["bindings", "lambert", "-o", path], 1, &["SW0"]);
    bad(&["bindings", "-o", path], 2, &["RECIPE"]);
    assert_eq!(names(folder.path()), [""; 0]);
}

/// Catches a pass of the first scene that no recipe of `examples/recipes` stands for: the build script of `examples/renderer` writes Rust
/// for these recipes, and its tests make pipelines of it.
#[test]
fn the_examples_have_every_pass_of_the_first_scene() {
    let catalog = Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}"));
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let hashes = |recipe: &Recipe| -> Vec<(String, u128)> {
        let programs = catalog.compile_all(recipe).unwrap_or_else(|report| panic!("{report}"));
        let both = programs.iter().map(|program| (program.reflection().pass.clone(), program.hash()));
        both.collect()
    };
    let mut known = BTreeSet::new();
    for entry in std::fs::read_dir(examples.join("recipes")).expect("recipes") {
        let text = std::fs::read_to_string(entry.expect("an entry").path()).expect("a recipe");
        let recipe = Recipe::parse("example", &text).unwrap_or_else(|report| panic!("{report}"));
        known.extend(hashes(&recipe).into_iter().map(|(_, hash)| hash));
    }
    let scene = SceneFile::read(&examples.join("scenes/first.scene.ron")).unwrap_or_else(|report| panic!("{report}"));
    let frame = scene.frame(&catalog, Some([8, 8])).unwrap_or_else(|report| panic!("{report}"));
    let mut count = 0;
    for material in frame.materials.iter().chain(&frame.display) {
        let recipe: Recipe = (*material.recipe).clone().into();
        for (pass, hash) in hashes(&recipe) {
            assert!(known.contains(&hash), "pass {pass} of {}", recipe.source.text);
            count += 1;
        }
    }
    assert!(count >= 4, "{count} passes");
}
