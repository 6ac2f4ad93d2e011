//! The picture by mouse.

use eframe::egui::{Event, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, TouchPhase, Vec2, pos2};
use egui_kittest::Harness;
use explorer::App;

use crate::harness::{open_small, said, settle};

fn button(harness: &Harness<App>, at: eframe::egui::Pos2, pressed: bool, modifiers: Modifiers) {
    harness.event(Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers,
    });
}

/// Drags from the middle of the picture, in steps.
fn drag(harness: &mut Harness<App>, by: Vec2, modifiers: Modifiers) {
    let middle = harness.state().viewport.rect.unwrap().center();
    harness.event(Event::PointerMoved(middle));
    harness.run_steps(2);
    harness.event(Event::ModifiersChanged(modifiers));
    button(harness, middle, true, modifiers);
    harness.run_steps(2);
    for step in 1..=5 {
        harness.event(Event::PointerMoved(middle + by * (step as f32 / 5.0)));
        harness.run_steps(2);
    }
    button(harness, middle + by, false, modifiers);
    harness.run_steps(2);
    harness.event(Event::ModifiersChanged(Modifiers::NONE));
    settle(harness);
}

fn eye(harness: &Harness<App>) -> [f32; 3] {
    harness.state().document.scene().scene().camera.unwrap().eye
}

/// Catches a drag that does not turn, pans instead, changes the distance, or leaves a step for every pixel of the way.
#[test]
fn a_drag_is_one_step_of_turning() {
    let mut explorer = open_small();
    let before = (eye(&explorer), said(&explorer, "camera").unwrap().to_owned());
    drag(&mut explorer, Vec2::new(120.0, 0.0), Modifiers::NONE);
    let after = eye(&explorer);
    let length = |v: [f32; 3]| v.iter().map(|x| x * x).sum::<f32>().sqrt();
    assert!((length(after) - length(before.0)).abs() < 1e-3 && after[0] < -0.5, "{after:?}");
    explorer.state_mut().document.undo();
    assert_eq!(said(&explorer, "camera").unwrap(), before.1);
    assert!(explorer.state().document.can_undo().is_none(), "one step");
    drag(&mut explorer, Vec2::new(60.0, 0.0), Modifiers::SHIFT);
    let camera = explorer.state().document.scene().scene().camera.unwrap();
    assert!(
        camera.target[0] < -0.1 && (camera.target[0] - camera.eye[0]).abs() < 1e-4,
        "{camera:?}"
    );
}

/// Catches a wheel that does nothing, and a picture whose size is not that of its place once all is still.
#[test]
fn the_wheel_goes_nearer() {
    let mut explorer = open_small();
    let middle = explorer.state().viewport.rect.unwrap().center();
    explorer.event(Event::PointerMoved(middle));
    explorer.run_steps(2);
    let before = eye(&explorer);
    explorer.event(Event::MouseWheel {
        unit: MouseWheelUnit::Point,
        delta: Vec2::new(0.0, 100.0),
        modifiers: Modifiers::NONE,
        phase: TouchPhase::Move,
        source: MouseWheelSource::Wheel,
    });
    explorer.run_steps(60);
    settle(&mut explorer);
    let after = eye(&explorer);
    assert!(after[2] < before[2] * 0.95 && after[2] > before[2] * 0.5, "{before:?} {after:?}");
    let app = explorer.state();
    let size = app.viewport.rect.unwrap().size();
    assert_eq!(
        app.viewport.painted.as_ref().unwrap().frame.size,
        [size.x.round() as u32, size.y.round() as u32]
    );
}

/// Catches a click that selects something else than what is there.
#[test]
fn a_click_selects_the_material() {
    let mut explorer = open_small();
    let rect = explorer.state().viewport.rect.unwrap();
    let click = |explorer: &mut Harness<App>, at| {
        explorer.event(Event::PointerMoved(at));
        explorer.run_steps(2);
        button(explorer, at, true, Modifiers::NONE);
        explorer.run_steps(1);
        button(explorer, at, false, Modifiers::NONE);
        explorer.run_steps(3);
        explorer.state().selected.clone()
    };
    assert_eq!(click(&mut explorer, rect.center()), "materials.shiny");
    assert_eq!(click(&mut explorer, pos2(rect.center().x, rect.bottom() - 10.0)), "materials.matt");
}
