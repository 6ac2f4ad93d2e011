//! Choices by menu.

use egui_kittest::kittest::Queryable;

use crate::harness::{click, mean, open, settle};

/// Catches a choice that changes nothing, a picture that stays, and an undo that leaves something.
#[test]
fn a_choice_changes_the_picture_and_undo_brings_it_back() {
    let mut explorer = open("first");
    let before = (explorer.state().document.state().clone(), mean(&explorer));
    click(&mut explorer, "materials.copper.brdf: microfacet");
    click(&mut explorer, "materials.copper.brdf = lambert");
    settle(&mut explorer);
    assert_eq!(explorer.state().document.scene().get("materials.copper.brdf"), Some("\"lambert\""));
    assert!(explorer.query_by_label("materials.copper.brdf: lambert").is_some());
    assert_ne!(mean(&explorer), before.1);
    click(&mut explorer, "Edit");
    click(&mut explorer, "Undo Choose lambert for materials.copper.brdf Ctrl+Z");
    settle(&mut explorer);
    assert_eq!((explorer.state().document.state().clone(), mean(&explorer)), before);
    explorer.snapshot("first");
}
