//! Lists by their buttons, and choices that cannot be made.

use egui_kittest::kittest::{NodeT, Queryable};

use crate::harness::{click, mean, open_small, said, settle};

/// Catches a button that does another's work, an element that does not come back, and a picture that does not follow.
#[test]
fn elements_are_added_moved_disabled_and_removed() {
    let mut explorer = open_small();
    let lit = mean(&explorer);
    click(&mut explorer, "Disable lamp of lights");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "lights[0].name"), Some("\"sky\""));
    assert!(mean(&explorer)[0] < lit[0] * 0.9, "darker without the lamp");
    click(&mut explorer, "Enable lamp");
    settle(&mut explorer);
    assert_eq!((said(&explorer, "lights[0].name"), mean(&explorer)), (Some("\"lamp\""), lit));
    click(&mut explorer, "Move down lamp of lights");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "lights[1].name"), Some("\"lamp\""));
    click(&mut explorer, "Remove lamp of lights");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "lights[1]"), None);
    click(&mut explorer, "Add to lights");
    click(&mut explorer, "lights = spot");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "lights[1].module"), Some("\"spot\""));
    assert!(explorer.state().problems.is_empty(), "{:?}", explorer.state().problems);
    let row = |path: &str| explorer.state().rows.iter().any(|row| row.path == path);
    assert!(row("lights[1].fill.cone"), "what the new one can be told");
}

/// Catches an illegal choice that can be made, a legal one that cannot, and a reason that is not said.
#[test]
fn illegal_choices_are_grey() {
    let mut explorer = open_small();
    click(&mut explorer, "lights[0].visibility: cube-map");
    settle(&mut explorer);
    let disabled = |explorer: &egui_kittest::Harness<explorer::App>, name: &str| explorer.get_by_label(name).accesskit_node().is_disabled();
    assert!(disabled(&explorer, "lights[0].visibility = perspective"));
    assert!(!disabled(&explorer, "lights[0].visibility = none"));
    explorer.get_by_label("lights[0].visibility = perspective").hover();
    explorer.run_steps(60);
    let reason = explorer.query_all_by(|node| {
        node.value()
            .or(node.label())
            .is_some_and(|text| text.contains("direction") && text.contains("perspective"))
    });
    assert!(reason.count() > 0, "the reason is shown");
    explorer.get_by_label("lights[0].visibility = perspective").click();
    settle(&mut explorer);
    assert_eq!(said(&explorer, "lights[0].visibility"), Some("\"cube-map\""));
}
