//! Files: opened, saved, dropped, exported, and the state that is kept.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{DroppedFile, Key, Modifiers};
use egui_kittest::Harness;
use explorer::compare::Pin;
use explorer::document::Document;
use explorer::files::Kept;
use explorer::{App, Start};
use shadewright_runtime::image::{decode_exr, decode_texture};
use shadewright_runtime::scene::{Files, SceneFile};

use crate::harness::{SMALL, click, fill, mean, open, open_small, said, select, settle, small, start};
use crate::modules::until;

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }
    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn drop_file(explorer: &mut Harness<App>, path: PathBuf) {
    explorer.input_mut().dropped_files.push(Arc::new(Dropped(path)));
    explorer.run_steps(1);
    explorer.input_mut().dropped_files.clear();
    settle(explorer);
}

fn menu(explorer: &mut Harness<App>, entry: &str, path: &Path) {
    click(explorer, "File");
    click(explorer, entry);
    fill(explorer, "Path", &path.display().to_string());
    click(explorer, "OK");
    settle(explorer);
}

/// Catches a save that loses something, a file that is replaced without a word, and an opened scene that is not the saved one.
#[test]
fn scenes_are_saved_and_opened() {
    let folder = tempfile::tempdir().unwrap();
    let mut explorer = open_small();
    explorer.state_mut().edit("size", |draft| draft.set(&[], "size", "(32, 24)"));
    let path = folder.path().join("a.scene.ron");
    menu(&mut explorer, "Save as... Ctrl+Shift+S", &path);
    let text = std::fs::read_to_string(&path).unwrap();
    assert_eq!(text, SMALL.replace("size: (64, 48)", "size: (32, 24)"));
    assert!(!explorer.state().document.is_changed());
    explorer.state_mut().edit("size", |draft| draft.set(&[], "size", "(16, 12)"));
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::S);
    settle(&mut explorer);
    assert!(std::fs::read_to_string(&path).unwrap().contains("(16, 12)"));
    let other = folder.path().join("other.scene.ron");
    std::fs::write(&other, SMALL).unwrap();
    click(&mut explorer, "File");
    click(&mut explorer, "Save as... Ctrl+Shift+S");
    fill(&mut explorer, "Path", &other.display().to_string());
    click(&mut explorer, "OK");
    assert_eq!(std::fs::read_to_string(&other).unwrap(), SMALL, "asked first");
    click(&mut explorer, "Cancel");
    menu(&mut explorer, "Open... Ctrl+O", &other);
    assert_eq!(*explorer.state().document.state().text, *SMALL);
    assert_eq!(explorer.state().kept.recent, [other, path]);
}

/// Catches a file that is taken for another kind, a model that is not seen, and a file without a use that says nothing.
#[test]
fn files_are_dropped() {
    let folder = tempfile::tempdir().unwrap();
    let mut explorer = open_small();
    select(&mut explorer, "materials.matt");
    let ies = std::path::absolute("../scenes/downlight.ies").unwrap();
    drop_file(&mut explorer, ies.clone());
    assert_eq!(said(&explorer, "lights[2].module"), Some("\"photometric\""));
    assert!(said(&explorer, "lights[2].files").unwrap().contains("downlight.ies"));
    assert!(explorer.state().problems.is_empty(), "{:?}", explorer.state().problems);
    let junk = folder.path().join("junk.bin");
    std::fs::write(&junk, [7; 33]).unwrap();
    drop_file(&mut explorer, junk);
    assert!(explorer.state().message.contains("junk.bin"), "{}", explorer.state().message);
    let gltf = folder.path().join("triangle.gltf");
    std::fs::write(&gltf, TRIANGLE).unwrap();
    drop_file(&mut explorer, gltf);
    assert!(explorer.state().problems.is_empty(), "{:?}", explorer.state().problems);
    assert_eq!(explorer.state().viewport.frame().unwrap().draws.len(), 1);
    let scene = folder.path().join("b.scene.ron");
    std::fs::write(&scene, SMALL).unwrap();
    drop_file(&mut explorer, scene.clone());
    assert_eq!(explorer.state().kept.recent, [scene]);
}

/// Catches an export of another size, an EXR that is encoded for a display, and texts of another recipe than the selected one.
#[test]
fn pictures_and_texts_are_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut explorer = open_small();
    select(&mut explorer, "materials.matt");
    let at = |name: &str| folder.path().join(name);
    menu(&mut explorer, "Export PNG...", &at("a.png"));
    let png = decode_texture(&std::fs::read(at("a.png")).unwrap()).unwrap();
    assert_eq!((png.width, png.height), (64, 48));
    menu(&mut explorer, "Export EXR...", &at("a.exr"));
    let exr = decode_exr(&std::fs::read(at("a.exr")).unwrap()).unwrap();
    assert!(exr.width == 64 && exr.texels.iter().any(|texel| texel[0] > 2.0), "cd/m2");
    menu(&mut explorer, "Export WGSL...", &at("a.wgsl"));
    let wgsl = std::fs::read_to_string(at("a.wgsl")).unwrap();
    assert!(wgsl.contains("@fragment") && !wgsl.contains("ggx"), "{wgsl}");
    menu(&mut explorer, "Export recipe...", &at("a.recipe.ron"));
    let recipe = std::fs::read_to_string(at("a.recipe.ron")).unwrap();
    let recipe = shadewright_compiler::Recipe::parse("a", &recipe).unwrap();
    let program = explorer.state().catalog.compile(&recipe, "main").unwrap();
    assert_eq!(program.wgsl(), wgsl);
}

/// Catches an edit in an editor that is not seen, that is no step, that takes what was changed here, or that is lost by saving; and an error in it that
/// takes the picture, or stays when it is mended.
#[test]
fn the_scenes_file_is_followed() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("mine.scene.ron");
    let text = |size: u32| SMALL.replace("size: (64, 48)", &format!("size: ({size}, 48)"));
    std::fs::write(&file, text(64)).unwrap();
    let mut explorer = open_small();
    explorer.state_mut().open_file(file.clone());
    until(&mut explorer, "opened", |app| app.document.state().name.ends_with("mine.scene.ron"));
    std::fs::write(&file, text(65)).unwrap();
    until(&mut explorer, "followed", |app| *app.document.state().text == text(65));
    assert!(!explorer.state().document.is_changed());
    assert!(explorer.state().can_undo().unwrap().starts_with("Take over "));
    let shown = mean(&explorer);
    std::fs::write(&file, "(pass:").unwrap();
    until(&mut explorer, "wrong", |app| !app.problems.is_empty());
    assert_eq!((&*explorer.state().document.state().text, mean(&explorer)), (&*text(65), shown));
    std::fs::write(&file, text(65)).unwrap();
    until(&mut explorer, "mended", |app| app.problems.is_empty());
    // Changed on both sides.
    explorer
        .state_mut()
        .edit("here", |draft| draft.set(&[], "background", "(1.0, 2.0, 3.0)"));
    let here = explorer.state().document.state().text.clone();
    std::fs::write(&file, text(66)).unwrap();
    until(&mut explorer, "told", |app| app.message.contains("another program too"));
    assert_eq!(explorer.state().document.state().text, here);
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::S);
    settle(&mut explorer);
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text(66), "it asks first");
    click(&mut explorer, "OK");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), text(66), "it asks again");
    click(&mut explorer, "OK");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), *here);
    settle(&mut explorer);
    assert!(!explorer.state().document.is_changed());
}

/// Catches opening that takes what was not saved, a way back to the wrong scene, pins of one scene in another, and a way forward that is lost.
#[test]
fn opening_can_be_undone() {
    let mut explorer = open("sphere");
    explorer.state_mut().pin();
    explorer
        .state_mut()
        .edit("darker", |draft| draft.set(&[], "background", "(0.0, 0.0, 0.0)"));
    settle(&mut explorer);
    let sphere = (explorer.state().document.state().clone(), mean(&explorer));
    click(&mut explorer, "File");
    click(&mut explorer, "Examples");
    click(&mut explorer, "spots");
    settle(&mut explorer);
    let spots = explorer.state().document.state().clone();
    assert_eq!(spots.name, "spots");
    assert!(explorer.state().compare.pins.all.is_empty());
    assert_eq!(explorer.state().can_undo().unwrap(), "opening spots");
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut explorer);
    assert_eq!((explorer.state().document.state().clone(), mean(&explorer)), sphere);
    assert_eq!(explorer.state().compare.pins.all.len(), 1);
    assert_eq!(explorer.state().can_undo().unwrap(), "darker");
    assert_eq!(explorer.state().can_redo().unwrap(), "opening spots");
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    settle(&mut explorer);
    assert_eq!(explorer.state().document.state(), &spots);
    // What was gone back from is still there when a third one is opened.
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    settle(&mut explorer);
    explorer.state_mut().open(small());
    settle(&mut explorer);
    let mut names = Vec::new();
    while explorer.state().can_undo().is_some() {
        explorer.state_mut().undo();
        names.push(explorer.state().document.state().name.clone());
    }
    assert_eq!(names, ["sphere", "sphere", "spots"]);
}

/// Catches work that a crash takes: the explorer is dropped without being closed.
#[test]
fn state_survives_a_crash() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("deeper/state.json");
    let begin = |document: Document, pins: Vec<Pin>| {
        let begin = Start {
            document,
            pins,
            state_file: Some(file.clone()),
            kept: Kept::read(&file),
            ..Start::with(small())
        };
        start(begin, [900.0, 600.0], 1.0)
    };
    let mut explorer = begin(Document::new(small()), Vec::new());
    explorer
        .state_mut()
        .edit("of the scene before", |draft| draft.set(&[], "size", "(10, 10)"));
    let before = explorer.state().document.state().clone();
    explorer.state_mut().open(small());
    explorer.run_steps(2);
    explorer.state_mut().pin();
    let pins = explorer.state().compare.pins.all.clone();
    explorer.state_mut().edit("size", |draft| draft.set(&[], "size", "(16, 12)"));
    explorer.state_mut().edit("off", |draft| draft.remove(&[], "lights", 1, true));
    select(&mut explorer, "lights[0]");
    for _ in 0..100 {
        std::thread::sleep(std::time::Duration::from_millis(10));
        explorer.run_steps(1);
    }
    settle(&mut explorer);
    let state = explorer.state().document.state().clone();
    std::mem::forget(explorer);
    let kept = Kept::read(&file);
    assert!(!kept.starting);
    let work = kept.work.unwrap();
    let document = Document::restored(work.state, work.saved, &Files::default()).unwrap();
    assert!(document.is_changed());
    let mut explorer = begin(document, work.pins);
    assert_eq!(
        (explorer.state().document.state(), explorer.state().selected.as_str()),
        (&state, "lights[0]")
    );
    assert_eq!(explorer.state().compare.pins.all, pins);
    explorer.state_mut().undo();
    settle(&mut explorer);
    assert_eq!(explorer.state().document.state(), &before);
    assert!(SceneFile::parse("x", &state.text, Path::new("")).is_ok());
    std::fs::write(&file, "{ damaged").unwrap();
    assert_eq!(Kept::read(&file), Kept::default());
}

const TRIANGLE: &str = r#"{
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]
}"#;
