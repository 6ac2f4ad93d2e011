//! Two pictures: pins, the line between, heat maps, the probe, the truth.

use std::time::{Duration, Instant};

use eframe::egui::{Key, Pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use explorer::App;
use explorer::compare::{Mode, Other};

use crate::harness::{click, mean, open, open_sized, settle};

/// Longest that anything takes.
const PATIENCE: Duration = Duration::from_secs(240);

/// Lets the lanes work until something is so.
pub fn until(harness: &mut Harness<App>, what: &str, is_so: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !is_so(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "not {what}: {}", harness.state().compare.problem);
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    settle(harness);
}

/// The place of a picture on the screen, by shares of its sides.
fn place(harness: &Harness<App>, x: f32, y: f32) -> Pos2 {
    let rect = harness.state().viewport.rect.unwrap();
    rect.min + eframe::egui::vec2(x, y) * rect.size()
}

/// Colour of the screen at a place.
fn colour(harness: &mut Harness<App>, at: Pos2) -> [u8; 3] {
    let image = harness.render().unwrap();
    let [r, g, b, _] = image.get_pixel(at.x as u32, at.y as u32).0;
    [r, g, b]
}

/// Catches a pin that keeps another scene than the present one, a way back that is no edit or cannot be undone, a name that is not taken, a pin that stays
/// when it is removed, and a picture that stays with it.
#[test]
fn pins_are_kept_gone_back_to_renamed_and_removed() {
    let mut explorer = open("sphere");
    let start = (explorer.state().document.state().clone(), mean(&explorer));
    click(&mut explorer, "Pins");
    click(&mut explorer, "Pin");
    click(&mut explorer, "materials.ball.brdf: microfacet");
    click(&mut explorer, "materials.ball.brdf = lambert");
    settle(&mut explorer);
    click(&mut explorer, "Pin");
    let names = |explorer: &Harness<App>| {
        explorer
            .state()
            .compare
            .pins
            .all
            .iter()
            .map(|pin| pin.name.clone())
            .collect::<Vec<_>>()
    };
    assert_eq!(names(&explorer), ["sphere", "brdf lambert"]);
    until(&mut explorer, "pictured", |app| app.compare.pins.without_picture().is_none());
    explorer.snapshot("pins");
    click(&mut explorer, "Go to sphere");
    settle(&mut explorer);
    assert_eq!((explorer.state().document.state().clone(), mean(&explorer)), start);
    assert_eq!(explorer.state().document.can_undo(), Some("Go to sphere"));
    explorer.state_mut().document.undo();
    settle(&mut explorer);
    assert_eq!(explorer.state().document.scene().get("materials.ball.brdf"), Some("\"lambert\""));
    let field = explorer.get_by_label("Name of pin 1");
    field.focus();
    explorer.run_steps(2);
    explorer.get_by_label("Name of pin 1").type_text(" two");
    explorer.run_steps(2);
    assert_eq!(names(&explorer), ["sphere two", "brdf lambert"]);
    click(&mut explorer, "Compare with sphere two");
    until(&mut explorer, "drawn", |app| app.compare.beside.is_some());
    assert_eq!(
        (explorer.state().compare.mode, explorer.state().compare.other),
        (Mode::Split, Other::Pin(1))
    );
    click(&mut explorer, "Remove pin sphere two");
    settle(&mut explorer);
    assert_eq!(names(&explorer), ["brdf lambert"]);
    assert_eq!(explorer.state().compare.pins.pictures.len(), 1);
    assert_eq!(explorer.state().compare.other, Other::Reference);
}

/// Catches sides that are changed over, a second picture from where the first was seen before, a line that the mouse or the keyboard does not move, and a line
/// that the camera moves with.
#[test]
fn a_split_picture_follows_the_camera_and_its_line_moves() {
    let mut explorer = open("sphere");
    click(&mut explorer, "Pin");
    explorer.state_mut().edit("White", |draft| {
        draft.set(&[], "materials.ball.material.params.base_color", "(0.05, 0.1, 0.9)")
    });
    settle(&mut explorer);
    let pin = explorer.state().compare.pins.all[0].id;
    explorer.state_mut().compare_with(Other::Pin(pin));
    until(&mut explorer, "drawn", |app| app.compare.beside.is_some());
    let (left, right) = (place(&explorer, 0.45, 0.45), place(&explorer, 0.55, 0.45));
    let is_blue = |[r, _, b]: [u8; 3]| b > r;
    assert!(is_blue(colour(&mut explorer, left)) && !is_blue(colour(&mut explorer, right)));
    explorer.snapshot("split");
    // By mouse.
    let (from, to) = (place(&explorer, 0.5, 0.3), place(&explorer, 0.8, 0.3));
    let camera = explorer.state().document.scene().get("camera").map(str::to_owned);
    explorer.drag_at(from);
    explorer.run_steps(2);
    explorer.hover_at(to);
    explorer.run_steps(2);
    explorer.drop_at(to);
    settle(&mut explorer);
    assert!(
        (explorer.state().compare.split - 0.8).abs() < 0.01,
        "{}",
        explorer.state().compare.split
    );
    assert_eq!(explorer.state().document.scene().get("camera").map(str::to_owned), camera);
    assert!(is_blue(colour(&mut explorer, right)));
    // By keyboard.
    explorer.get_by_label("Line between the pictures").focus();
    explorer.run_steps(2);
    let before = (explorer.state().compare.split, explorer.state().selected.clone());
    for _ in 0..2 {
        explorer.key_press(Key::ArrowLeft);
        explorer.run_steps(2);
    }
    assert!(
        (explorer.state().compare.split - before.0 + 0.04).abs() < 1e-3,
        "{}",
        explorer.state().compare.split
    );
    assert_eq!(explorer.state().selected, before.1);
    // Both are seen from the new place: the ball is gone from the middle of both.
    explorer.state_mut().compare.split = 0.5;
    explorer.state_mut().edit("Camera", |draft| {
        draft.set(&[], "camera", "(eye: (0.0, 0.0, 6.0), target: (0.0, 30.0, 0.0), fov: 22.0)")
    });
    let version = explorer.state().document.version();
    until(&mut explorer, "drawn", |app| {
        app.document.version() == version && app.compare.beside.as_ref().is_some_and(|beside| beside.first.0 == app.version)
    });
    let (left, right) = (colour(&mut explorer, left), colour(&mut explorer, right));
    assert_eq!(left, right);
}

/// Catches a heat map that is of something else, that stays when the range or the scene changes, without its numbers, and a probe that shows values of
/// another place or none.
#[test]
fn a_heat_map_and_a_probe_say_how_far_the_pictures_are() {
    let mut explorer = open("sphere");
    click(&mut explorer, "Pin");
    explorer
        .state_mut()
        .edit("Brighter", |draft| draft.set(&[], "lights[key].fields.illuminance", "16000.0"));
    settle(&mut explorer);
    explorer.state_mut().compare_with(Other::Pin(1));
    click(&mut explorer, "Show difference");
    until(&mut explorer, "compared", |app| app.compare.heat.is_some());
    let errors = explorer.state().compare.errors().unwrap().clone();
    assert!(errors.rms > 0.05, "{}", errors.summary);
    assert!(explorer.query_by_label_contains(&errors.summary).is_some(), "its numbers");
    let lit = place(&explorer, 0.42, 0.5);
    let [r, _, b] = colour(&mut explorer, lit);
    assert!(r > b, "too bright is red");
    explorer.snapshot("heat");
    explorer.state_mut().compare.full = 50.0;
    explorer.run_steps(4);
    settle(&mut explorer);
    explorer.run_steps(2);
    let faint = colour(&mut explorer, lit);
    assert!(faint[0] < r / 2, "{faint:?}");
    click(&mut explorer, "Probe");
    explorer.hover_at(lit);
    explorer.run_steps(2);
    until(&mut explorer, "read", |app| {
        app.compare.beside.as_ref().is_some_and(|beside| beside.first_values.is_some())
    });
    explorer.run_steps(2);
    let beside = explorer.state().compare.beside.as_ref().unwrap();
    let at = [0.42, 0.5];
    let [found, truth] = [&beside.first_values, &beside.second_values].map(|values| values.as_ref().unwrap().at(at).unwrap());
    assert!((found[0] / truth[0] - 2.0).abs() < 0.05, "twice the light: {found:?} {truth:?}");
    for (name, value) in [("present", found), ("sphere", truth)] {
        let words = format!("{name}: {}", explorer::compare::describe(&value));
        assert!(explorer.query_by_label(&words).is_some(), "{words}");
    }
    assert!(explorer.query_by_label_contains("error against sphere").is_some());
}

/// Catches a truth that is not drawn, is that of another scene, does not get better, goes on when it is switched off, or is not begun again after an edit.
#[test]
fn the_truth_is_drawn_in_the_background() {
    let mut explorer = open_sized("area", [760.0, 480.0], 1.0);
    click(&mut explorer, "Reference");
    click(&mut explorer, "Draw the reference in the background");
    until_early(&mut explorer, "coarse", |app| app.compare.refined.is_some());
    assert_eq!(explorer.get_all_by_label("reference instead of split").count(), 5);
    assert!(
        explorer
            .state()
            .compare
            .made
            .as_ref()
            .unwrap()
            .1
            .iter()
            .any(|replaced| replaced.to == "reference")
    );
    click(&mut explorer, "Show error");
    until_early(&mut explorer, "mapped", |app| app.compare.heat.is_some());
    assert!(explorer.query_by_label_contains("against reference").is_some());
    let errors = explorer.state().compare.errors().unwrap().clone();
    assert!(errors.rms > 0.0 && errors.rms < 1.0, "{}", errors.summary);
    // It begins again.
    explorer
        .state_mut()
        .edit("Darker", |draft| draft.set(&[], "lights[0].fields.luminance", "10.0"));
    explorer.run_steps(2);
    let version = explorer.state().version;
    until_early(&mut explorer, "of the new scene", |app| {
        app.compare.refined.as_ref().is_some_and(|refined| refined.version == version)
    });
    click(&mut explorer, "Draw the reference in the background");
    until(&mut explorer, "stopped", |app| !app.lanes.long.is_busy("reference"));
    assert!(!explorer.state().compare.is_refining);
    let divisor = explorer.state().compare.refined.as_ref().map(|refined| refined.divisor);
    assert!(divisor.is_some_and(|divisor| divisor > 1), "it went on to the end: {divisor:?}");
}

/// The same without waiting for what else is done.
fn until_early(harness: &mut Harness<App>, what: &str, is_so: impl Fn(&App) -> bool) {
    let start = Instant::now();
    while !is_so(harness.state()) {
        assert!(start.elapsed() < PATIENCE, "not {what}: {}", harness.state().compare.problem);
        std::thread::sleep(Duration::from_millis(5));
        harness.run_steps(1);
    }
    harness.run_steps(2);
}

/// Everything by its name.
#[test]
fn the_bar_fits_a_narrow_window() {
    let mut explorer = open_sized("sphere", [900.0, 640.0], 1.0);
    click(&mut explorer, "Show split");
    until(&mut explorer, "drawn", |app| app.compare.refined.is_some());
    for name in [
        "Show picture",
        "Show split",
        "Show difference",
        "Show error",
        "Compare with: reference",
        "Pin",
        "Probe",
    ] {
        let node = explorer.get_by_label(name);
        let bounds = node.accesskit_node().bounding_box().unwrap();
        assert!(bounds.x0 > 290.0 && bounds.x1 < 620.0, "{name}: {bounds:?}");
    }
    explorer.snapshot("narrow_split");
}
