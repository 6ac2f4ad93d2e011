//! Recipes become Rust: `matte.rs` and `glossy.rs` for the renderer, the others for the tests, which compile and run what is written.

use std::path::PathBuf;

fn main() {
    let mut build = shadewright_modules::build::Build::new()
        .modules("tests/modules")
        .recipe("shaders/matte.recipe.ron")
        .recipe("shaders/glossy.recipe.ron")
        .recipe("tests/corners.recipe.ron");
    // Every recipe of the examples, in an order of its own. A folder that cannot be read is found out by the program, which lacks their files.
    let entries = std::fs::read_dir("../recipes").into_iter().flatten().flatten();
    let mut recipes: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    recipes.sort();
    for recipe in recipes {
        build = build.recipe(recipe);
    }
    build.write();
}
