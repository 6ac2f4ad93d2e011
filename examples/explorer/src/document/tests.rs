use std::path::Path;

use super::*;

const TEXT: &str = r#"(
    // Kept.
    camera: (eye: (0.0, 0.0, 6.0), target: (0.0, 0.0, 0.0)),
    pass: "forward", display: "display",
    post: [(module: "tonemap", fill: {"exposure": "manual"})],
    meshes: {"ball": Sphere(radius: 1.0)},
    materials: {"two words": {"material": "metalness", "brdf": "microfacet"}},
    lights: [(name: "a", module: "directional"), (name: "b", module: "point"), (name: "c", module: "spot")],
    objects: [(mesh: "ball", material: "two words")],
)"#;

fn document() -> Document {
    Document::new(SceneFile::parse("test", TEXT, Path::new("")).unwrap())
}

fn names(document: &Document) -> Vec<&str> {
    document
        .scene()
        .scene()
        .lights
        .iter()
        .map(|light| light.name.as_deref().unwrap())
        .collect()
}

/// Catches an edit that is lost or doubled by undo and redo, a slider that leaves a step for every pixel, and a comment that goes.
#[test]
fn every_step_is_undone_and_done_again() {
    let mut document = document();
    let set = |path: &'static str, value: &'static str| move |draft: &mut Draft| draft.set(&[], path, value);
    document.edit("brdf", set("materials[two words].brdf", "\"lambert\"")).unwrap();
    let one = document.state().clone();
    for value in ["1.0", "2.0", "3.0"] {
        document.continued("x", set("lights[0].fields.illuminance", value)).unwrap();
    }
    document.close();
    document.continued("x", set("lights[0].fields.illuminance", "4.0")).unwrap();
    assert!(document.state().text.contains("// Kept.") && document.is_changed());
    let last = document.state().clone();
    document.undo();
    assert!(document.state().text.contains("3.0"), "the closed step is one of its own");
    document.undo();
    assert_eq!(*document.state(), one);
    document.undo();
    assert_eq!(&*document.state().text, TEXT);
    assert!(document.can_undo().is_none() && !document.is_changed());
    document.undo();
    (0..5).for_each(|_| document.redo());
    assert_eq!(*document.state(), last);
    document.undo();
    document.edit("other", set("size", "(8, 8)")).unwrap();
    assert!(document.can_redo().is_none(), "another edit ends what could be done again");
}

/// Catches an edit that fails and leaves something behind.
#[test]
fn a_wrong_edit_changes_nothing() {
    let mut document = document();
    let before = document.state().clone();
    let wrong = document.edit("wrong", |draft| {
        draft.set(&[], "size", "(8, 8)")?;
        draft.set(&[], "lights[7].module", "\"point\"")
    });
    assert!(wrong.is_err());
    assert_eq!((document.state(), document.version()), (&before, 0));
    assert!(document.edit("no scene", |draft| draft.set(&[], "size", "\"large\"")).is_err());
    assert_eq!(*document.state(), before);
}

/// Catches elements that change places wrongly, are lost when switched off, or come back elsewhere.
#[test]
fn lists_are_edited() {
    let mut document = document();
    document.edit("down", |draft| draft.shift(&[], "lights", 0, false)).unwrap();
    assert_eq!(names(&document), ["b", "a", "c"]);
    document.edit("up", |draft| draft.shift(&[], "lights", 0, true)).unwrap();
    assert_eq!(names(&document), ["b", "a", "c"], "the first cannot go up");
    document.edit("off", |draft| draft.remove(&[], "lights", 1, true)).unwrap();
    assert_eq!(names(&document), ["b", "c"]);
    document.edit("gone", |draft| draft.remove(&[], "lights", 0, false)).unwrap();
    document.edit("gone", |draft| draft.remove(&[], "lights", 0, false)).unwrap();
    assert!(names(&document).is_empty());
    document.edit("on", |draft| draft.unpark(&[], 0)).unwrap();
    assert_eq!(names(&document), ["a"]);
    assert!(document.state().parked.is_empty());
    document
        .edit("add", |draft| draft.add(&[], "lights", "(name: \"d\", module: \"sun\")"))
        .unwrap();
    assert_eq!(names(&document), ["a", "d"]);
    (0..3).for_each(|_| document.undo());
    assert_eq!(document.state().parked.len(), 1);
}

/// Catches a default that is not written out before something is put below it, and a parameter that is set and frozen at once.
#[test]
fn defaults_are_written_out_and_parameters_frozen() {
    let mut document = document();
    let above = [Ancestor {
        path: "materials[two words].brdf.fill.ndf".into(),
        text: "(module:\"ggx\")".into(),
    }];
    let module = "materials[two words].brdf.fill.ndf";
    let value = Value::Number(0.5);
    document
        .edit("freeze", |draft| draft.freeze(&above, module, "x", true, &value))
        .unwrap();
    assert_eq!(document.scene().get(&format!("{module}.freeze.x")), Some("0.5"));
    document
        .edit("thaw", |draft| draft.freeze(&above, module, "x", false, &value))
        .unwrap();
    assert_eq!(document.scene().get(&format!("{module}.freeze.x")), None);
    assert_eq!(document.scene().get(&format!("{module}.params.x")), Some("0.5"));
}

use shadewright_compiler::manifest::Value;
