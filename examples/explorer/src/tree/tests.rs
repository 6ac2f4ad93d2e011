use std::path::Path;

use shadewright_runtime::scene::SceneFile;

use super::*;
use crate::document::{Document, Parked};

fn catalog() -> Catalog {
    Catalog::load(shadewright_modules::library()).unwrap()
}

fn document() -> Document {
    let text = r#"(
        camera: (eye: (0.0, 0.0, 6.0), target: (0.0, 0.0, 0.0)),
        pass: "forward", display: "display",
        post: [(module: "tonemap", fill: {"exposure": (module: "manual", params: {"ev100": 3.0})})],
        meshes: {"ball": Sphere(radius: 1.0)},
        materials: {"two words": {"material": (module: "metalness", params: {"roughness": 0.3}), "brdf": "microfacet"}},
        lights: [(name: "a", module: "point", fields: {"position": (0, 3, 0), "intensity": 100.0}, visibility: "cube-map"), (module: "directional")],
        objects: [(mesh: "ball", material: "two words")],
    )"#;
    Document::new(SceneFile::parse("test", text, Path::new("")).unwrap())
}

fn row<'r>(rows: &'r [Row], path: &str) -> &'r Row {
    rows.iter()
        .find(|row| row.path == path)
        .unwrap_or_else(|| panic!("{path} of {:#?}", rows.iter().map(|r| &r.path).collect::<Vec<_>>()))
}

/// Catches a place that is left out, stands there twice, is called stated where it is a default, or whose path leads elsewhere.
#[test]
fn every_place_is_a_row() {
    let (catalog, document) = (catalog(), document());
    let off = [Parked {
        list: "lights".into(),
        index: 0,
        text: "(name: \"off\", module: \"sun\")".into(),
    }];
    let rows = rows(document.scene(), &catalog, &off);
    let mut paths: Vec<&str> = rows.iter().map(|row| row.path.as_str()).collect();
    let all = paths.len();
    paths.sort_unstable();
    paths.dedup();
    assert_eq!(paths.len(), all);
    let module = |path: &str| row(&rows, path).module.as_ref().map(|m| m.name.clone());
    assert_eq!(module("materials[two words].brdf").as_deref(), Some("microfacet"));
    assert_eq!(module("materials[two words].brdf.fill.ndf").as_deref(), Some("ggx"));
    assert!(!row(&rows, "materials[two words].brdf.fill.ndf").is_stated);
    assert_eq!(module("lights[0].visibility").as_deref(), Some("cube-map"));
    assert_eq!(module("lights[0].visibility.fill.filtering").as_deref(), Some("hard"));
    assert_eq!(module("post[0].fill.exposure").as_deref(), Some("manual"));
    assert_eq!(row(&rows, "lights(off 0)").label, "off");
    assert!(
        !rows.iter().any(|row| row.path.contains("fill.post")),
        "post effects have one place"
    );
    for stated in rows.iter().filter(|row| row.is_stated && row.is_choice()) {
        assert!(document.scene().get(&stated.path).is_some(), "{}", stated.path);
    }
}

/// Catches a choice that cannot be made because a default is in the way, and one that loses what both modules understand.
#[test]
fn every_place_takes_every_module_that_fits() {
    let (catalog, document) = (catalog(), document());
    let before = rows(document.scene(), &catalog, &[]);
    let mut choices = 0;
    for place in before.iter().filter(|row| row.is_choice()) {
        for module in options(&catalog, place.interface().unwrap()) {
            let mut document = document.clone();
            document
                .edit("choose", |draft| choose(draft, &catalog, place, Some(module)))
                .unwrap_or_else(|error| panic!("{}: {}", place.path, error.render()));
            let after = rows(document.scene(), &catalog, &[]);
            let found = row(&after, &place.path);
            assert!(
                found.module.as_ref().is_some_and(|m| Arc::ptr_eq(m, module)) && found.is_stated,
                "{} {}",
                place.path,
                module.name
            );
            choices += 1;
        }
    }
    assert!(choices > 90, "{choices}");
    let change = |path: &str, name: &str| {
        let mut document = document.clone();
        document
            .edit("choose", |draft| {
                choose(draft, &catalog, row(&before, path), Some(catalog.module(name).unwrap()))
            })
            .unwrap();
        document
    };
    let spot = change("lights[0]", "spot");
    assert_eq!(spot.scene().get("lights[0].fields.position"), Some("(0, 3, 0)"));
    assert_eq!(spot.scene().get("lights[0].visibility"), Some("\"cube-map\""));
    let layered = change("materials[two words].material", "metalness-layered");
    assert_eq!(layered.scene().get("materials[two words].material.params.roughness"), Some("0.3"));
}
