//! The modules of the standard library fit together: recipes over all of them link and validate, and no shader has what it does not need.

use shadewright_compiler::{Catalog, Program, Recipe};
use shadewright_modules::library;

fn compile(recipe: &str, pass: &str) -> Program {
    let catalog = Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"));
    let parsed = Recipe::parse("test", recipe).unwrap_or_else(|report| panic!("{report}"));
    catalog.compile(&parsed, pass).unwrap_or_else(|report| panic!("{recipe}\n{report}"))
}

fn bindings(program: &Program) -> Vec<&str> {
    program.reflection().bindings.iter().map(|b| b.name.as_str()).collect()
}

const LIGHTS: &str = r#"[
    (module: "point", fill: {"visibility": (module: "cube-map", fill: {"filtering": (module: "pcf", freeze: {"radius": 2})})}),
    (module: "directional", fill: {"visibility": "perspective"}),
    "point",
]"#;
const MAPS: &str = r#"(module: "metalness", fill: {
    "base_color_map": (module: "color-texture", label: "base_color"),
    "emission_map": (module: "color-texture", label: "emission"),
    "metallic_roughness_map": "data-texture",
    "normal_map": "normal-map",
})"#;

/// Catches modules that do not fit: a slot's function called by another name, a resource without a declaration, types that differ.
#[test]
fn everything_at_once() {
    let program = compile(
        &format!(r#"(module: "forward", fill: {{"lights": {LIGHTS}, "material": {MAPS}}})"#),
        "main",
    );
    let images = bindings(&program)
        .iter()
        .filter(|b| b.contains("image") && !b.contains("sampler"))
        .count();
    assert_eq!(images, 4, "{:?}", bindings(&program));
}

/// Catches shadow code or textures that a recipe without them drags along.
#[test]
fn nothing_more_than_needed() {
    let program = compile(r#"(module: "forward", fill: {"lights": ["point"], "brdf": "lambert"})"#, "main");
    // Comments may speak of anything.
    let text: String = program.wgsl().lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    for absent in ["shadow", "textureSample", "tangent", "uv", "alpha", "front_facing", "views"] {
        assert!(!text.contains(absent), "`{absent}` in\n{text}");
    }
    let inputs: Vec<_> = program.reflection().entry_points[0].inputs.iter().map(|i| i.location).collect();
    assert_eq!(inputs, [0, 1], "position and normal only");
}

/// Catches a constant that does not prune its branch, or one that does not reach it.
#[test]
fn double_sided() {
    for sides in [true, false] {
        let recipe = format!(r#"(module: "forward", freeze: {{"double_sided": {sides}}}, fill: {{"lights": ["point"]}})"#);
        assert_eq!(compile(&recipe, "main").wgsl().contains("front_facing"), sides);
    }
}

#[test]
fn every_pass_of_the_modules() {
    let program = compile(
        r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": "log-average"})]})"#,
        "main",
    );
    let passes: Vec<_> = program
        .reflection()
        .passes
        .iter()
        .map(|p| format!("{}.{}", p.instance, p.name))
        .collect();
    assert_eq!(passes.len(), 2, "{passes:?}");
    for pass in passes {
        let compute = compile(
            r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": "log-average"})]})"#,
            &pass,
        );
        assert_eq!(compute.reflection().entry_points.len(), 1, "{pass}");
    }
    let program = compile(&format!(r#"(module: "forward", fill: {{"lights": {LIGHTS}}})"#), "main");
    let passes: Vec<_> = program
        .reflection()
        .passes
        .iter()
        .map(|p| format!("{}.{}", p.instance, p.name))
        .collect();
    assert_eq!(passes.len(), 2, "{passes:?}");
    for pass in passes {
        let depth = compile(&format!(r#"(module: "forward", fill: {{"lights": {LIGHTS}}})"#), &pass);
        let inputs: Vec<_> = depth.reflection().entry_points[0].inputs.iter().map(|i| i.location).collect();
        assert_eq!(inputs, [0], "a depth pass fetches positions only");
    }
}
