//! The commands that look: list, show, graph, why, diff.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use serde_json::Value;
use support::{GLOSSY, MATTE, SHADOWED, bad, good, run_with_input};

fn strings<'a>(list: &'a Value, member: &str) -> Vec<&'a str> {
    let items = list.as_array().unwrap_or_else(|| panic!("no list: {list}"));
    items.iter().map(|item| item[member].as_str().expect("a string")).collect()
}

/// Catches a category or module that `list` forgets, and a filter that lets others through.
#[test]
fn list_shows_modules_by_category() {
    let all = good(&["list"]);
    for line in [
        "brdf: How a surface reflects light",
        "  lambert",
        "  microfacet",
        "  point",
        "  forward",
    ] {
        assert!(all.text().contains(line), "no `{line}` in\n{}", all.text());
    }
    let json = good(&["list", "--category", "brdf", "--format", "json"]).json();
    assert_eq!(strings(&json["categories"], "name"), ["brdf"]);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("modules/brdf");
    let mut folders: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_dir())
        .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
        .collect();
    folders.sort();
    assert!(folders.contains(&"lambert".to_owned()));
    assert_eq!(strings(&json["categories"][0]["modules"], "name"), folders);
}

/// Catches a misspelt category that gives an empty list and success.
#[test]
fn list_knows_its_categories() {
    bad(&["list", "--category", "bdrf"], 1, &["`bdrf`", "`brdf`"]);
}

/// Catches a part of the manifest that `show` leaves out.
#[test]
fn show_tells_everything() {
    let text = good(&["show", "microfacet"]);
    for word in ["Walter", "ndf", "default ggx", "reciprocal"] {
        assert!(text.text().contains(word), "no `{word}` in\n{}", text.text());
    }
    let point = good(&["show", "light/point"]);
    for word in ["intensity", "cd", "1 lm = 0.0795774715459477 cd", "0 to 1000000000", "visibility"] {
        assert!(point.text().contains(word), "no `{word}` in\n{}", point.text());
    }
    let cube = good(&["show", "cube-map"]);
    for word in ["draws depth into six views", "shadow_map", "needs `position` in its parent"] {
        assert!(cube.text().contains(word), "no `{word}` in\n{}", cube.text());
    }
    let json = good(&["show", "manual", "--format", "json"]).json();
    assert_eq!(json["category"], "exposure");
    assert_eq!(json["manifest"]["params"]["ev100"]["unit"], "EV");
}

/// Catches an unknown module without advice, and diagnostics in JSON that are not JSON.
#[test]
fn show_names_the_nearest() {
    bad(&["show", "lambrt"], 1, &["SW0201", "lambert"]);
    let ran = bad(&["show", "lambrt", "--format", "json"], 1, &[]);
    let json: Value = serde_json::from_str(&ran.err).expect("JSON on standard error");
    assert_eq!(json["status"], 1);
    assert_eq!(json["diagnostics"][0]["code"], "SW0201");
}

/// Catches a tree without the defaults, or with a slot in the wrong place.
#[test]
fn graph_writes_out_defaults() {
    let recipe = r#"(module: "microfacet", fill: {"fresnel": "schlick"})"#;
    let expected = "\
brdf/microfacet
├─ ndf: ndf/ggx (default)
├─ masking: masking/smith-ggx-correlated (default)
├─ fresnel: fresnel/schlick
├─ diffuse: diffuse/lambertian (default)
└─ compensation: (empty)
";
    assert_eq!(good(&["graph", recipe]).text(), expected);
    let json = good(&["graph", recipe, "--format", "json"]).json();
    assert_eq!(json["slots"][2]["filled"][0]["path"], "main.fresnel");
    assert_eq!(json["slots"][0]["filled"][0]["by_default"], true);
    let dot = good(&["graph", recipe, "--dot"]);
    assert!(dot.text().starts_with("digraph recipe {\n"));
    assert!(dot.text().contains("  \"main\" -> \"main.fresnel\" [label=\"fresnel\"];\n"));
    assert!(dot.text().ends_with("}\n"));
}

/// Catches an empty slot, an element of a list or a frozen parameter that the tree does not show.
#[test]
fn graph_shows_lists_and_frozen_parameters() {
    let recipe = r#"(module: "tonemap", fill: {"exposure": (module: "manual", freeze: {"ev100": 3.0})})"#;
    let text = good(&["graph", recipe]);
    assert!(text.text().contains("exposure: exposure/manual {ev100 = 3}"), "{}", text.text());
    let lights = good(&["graph", r#"(module: "forward", fill: {"lights": ["point", "directional"]})"#]);
    assert!(lights.text().contains("lights[1]: light/directional"), "{}", lights.text());
    let none = good(&["graph", "forward"]);
    assert!(none.text().contains("lights: (empty)"), "{}", none.text());
}

/// Catches a graph of what is no recipe.
#[test]
fn graph_refuses_what_is_no_recipe() {
    bad(&["graph", r#"(module: "microfacet", fill: {"ndff": "ggx"})"#], 1, &["ndff", "ndf"]);
    bad(&["graph", r#"(module: "microfacet", fill: {"ndf": "lambert"})"#], 1, &["SW0202"]);
    bad(&["graph", "(module: "], 1, &["SW0101"]);
    bad(&["graph", "absent.recipe.ron"], 1, &["absent.recipe.ron: there is no such file"]);
}

/// Catches a reason that names the wrong module, or no place in the recipe.
#[test]
fn why_names_module_and_place() {
    let json = good(&["why", SHADOWED, "shadow_map", "--format", "json"]).json();
    assert_eq!(json[0]["kind"], "binding");
    assert_eq!(json[0]["module"], "cube-map");
    assert_eq!(json[0]["place"], "main.lights[0].visibility");
    let text = good(&["why", SHADOWED, "shadow_map"]);
    assert!(text.text().contains("cube-map at main.lights[0].visibility"), "{}", text.text());
    assert!(text.text().contains("fragment_main -> "), "{}", text.text());
}

/// Catches a reason for what is not there.
#[test]
fn why_knows_what_is_not_there() {
    bad(
        &["why", MATTE, "shadow_map"],
        1,
        &["`shadow_map` is not in the shader of pass `main`"],
    );
    bad(&["why", MATTE, "fragment_man"], 1, &["`fragment_main`"]);
    bad(&["why", MATTE, "brdf", "--pass", "absent"], 1, &["absent"]);
}

/// Catches a difference that is missed, or laid to the wrong choice.
#[test]
fn diff_lays_differences_to_choices() {
    let json = good(&["diff", MATTE, SHADOWED, "--format", "json"]).json();
    assert_eq!(json["equal"], false);
    assert_eq!(
        json["choices"],
        serde_json::json!([{"path": "main.lights[0].visibility", "a": "visibility/none", "b": "visibility/cube-map"}])
    );
    let added = json["bindings"]["added"].as_array().expect("a list");
    let map = added
        .iter()
        .find(|item| item["name"] == "cube_map_shadow_map")
        .expect("the map is added");
    assert_eq!(map["because"], "main.lights[0].visibility");
    assert!(
        json["bindings"]["removed"]
            .as_array()
            .expect("a list")
            .iter()
            .all(|item| item["name"] != "cube_map_shadow_map")
    );

    let text = good(&["diff", SHADOWED, MATTE]);
    assert!(
        text.text()
            .contains("main.lights[0].visibility: visibility/cube-map -> visibility/none"),
        "{}",
        text.text()
    );
    assert!(text.text().contains("- cube_map_shadow_map  "), "{}", text.text());
}

/// Catches choices that are laid to one another, and one above the place that hides the one at it.
#[test]
fn diff_tells_choices_apart() {
    let other = r#"(
        module: "forward",
        fill: {"brdf": "microfacet", "lights": ["point", (module: "directional", fill: {"visibility": "perspective"})]},
        freeze: {"double_sided": true},
    )"#;
    let json = good(&["diff", MATTE, other, "--format", "json"]).json();
    assert_eq!(
        strings(&json["choices"], "path"),
        ["main.double_sided", "main.brdf", "main.lights[1]"]
    );
    let because = |kind: &str, name: &str| {
        let added = json[kind]["added"].as_array().expect("a list");
        let item = added.iter().find(|item| item["name"] == name);
        item.unwrap_or_else(|| panic!("no {name} in {added:?}"))["because"].clone()
    };
    assert_eq!(because("functions", "ggx_distribution"), "main.brdf");
    assert_eq!(because("functions", "directional_light"), "main.lights[1]");
    assert_eq!(because("bindings", "perspective_shadow_map"), "main.lights[1]");
    assert_eq!(because("params", "perspective.bias"), "main.lights[1]");
    // Named by the shadow map's views alone.
    assert_eq!(because("structs", "View"), "main.lights[1]");
}

/// Catches a difference between a recipe and itself, and a function that only one of two BRDFs has and is not named.
#[test]
fn diff_of_equals_is_empty() {
    let json = good(&["diff", MATTE, MATTE, "--format", "json"]).json();
    assert_eq!(json["equal"], true);
    assert_eq!(json["choices"], serde_json::json!([]));
    let text = good(&["diff", MATTE, GLOSSY]);
    assert!(text.text().contains("+ ggx_distribution "), "{}", text.text());
    // Lambert's surface has no f0, so that its material doesn't read this: owed to the BRDF, though not below it.
    assert!(
        text.text().contains("+ metalness.reflectance  because of main.brdf\n"),
        "{}",
        text.text()
    );
}

/// Catches two recipes read from one standard input, and `-` that reads nothing.
#[test]
fn recipes_come_from_standard_input() {
    bad(&["diff", "-", "-"], 2, &["standard input"]);
    let ran = run_with_input(&["graph", "-"], "\"lambert\"");
    assert_eq!((ran.status, ran.text()), (0, "brdf/lambert\n"));
    let ran = run_with_input(&["diff", "-", MATTE, "--format", "json"], MATTE);
    assert_eq!(ran.json()["equal"], true);
}

/// Catches usage errors with another status, and help that fails.
#[test]
fn usage_is_status_2() {
    bad(&[], 2, &["Usage"]);
    bad(&["frobnicate"], 2, &["frobnicate"]);
    bad(&["list", "--format", "yaml"], 2, &["yaml"]);
    bad(&["why", MATTE], 2, &["NAME"]);
    assert!(good(&["--help"]).text().contains("Exit status: 0 done"));
    assert!(good(&["--version"]).text().starts_with("shadewright "));
}

/// Catches a folder of modules that is not there and is passed over in silence.
#[test]
fn an_absent_modules_folder_is_an_error() {
    bad(
        &["list", "--modules", "/nonexistent"],
        1,
        &["--modules /nonexistent: there is no such folder"],
    );
}
