//! Everything by keyboard.

use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;

use crate::harness::{field, open_small, said, select, settle};

/// Catches a row that cannot be reached, a menu that does not open, and a choice that needs a mouse.
#[test]
fn a_choice_by_keys_alone() {
    let mut explorer = open_small();
    select(&mut explorer, "materials.shiny");
    for _ in 0..40 {
        if explorer.state().selected == "materials.shiny.brdf" {
            break;
        }
        explorer.key_press(Key::ArrowDown);
        explorer.run_steps(2);
    }
    assert_eq!(explorer.state().selected, "materials.shiny.brdf");
    explorer.key_press(Key::ArrowLeft);
    explorer.run_steps(2);
    assert!(explorer.query_by_label("materials.shiny.brdf.fill.ndf: ggx").is_none(), "folded");
    explorer.key_press(Key::ArrowRight);
    explorer.run_steps(2);
    assert!(explorer.query_by_label("materials.shiny.brdf.fill.ndf: ggx").is_some(), "unfolded");
    explorer.key_press(Key::Enter);
    explorer.run_steps(4);
    explorer.get_by_label("materials.shiny.brdf = ward").focus();
    explorer.run_steps(2);
    explorer.key_press(Key::Enter);
    settle(&mut explorer);
    assert_eq!(
        explorer
            .state()
            .rows
            .iter()
            .find(|row| row.path == "materials.shiny.brdf")
            .unwrap()
            .module
            .as_ref()
            .unwrap()
            .name,
        "ward"
    );
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    explorer.run_steps(3);
    assert_eq!(said(&explorer, "materials.shiny.brdf"), Some("\"microfacet\""));
    explorer.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    explorer.run_steps(3);
    assert!(said(&explorer, "materials.shiny.brdf").unwrap().contains("ward"));
}

/// Catches elements that cannot be moved and removed without a mouse, and a selection that stays behind.
#[test]
fn elements_move_by_keys() {
    let mut explorer = open_small();
    select(&mut explorer, "lights[0]");
    explorer.key_press_modifiers(Modifiers::ALT, Key::ArrowDown);
    explorer.run_steps(3);
    assert_eq!(
        (explorer.state().selected.as_str(), said(&explorer, "lights[1].name")),
        ("lights[1]", Some("\"lamp\""))
    );
    explorer.key_press_modifiers(Modifiers::ALT, Key::ArrowUp);
    explorer.run_steps(3);
    assert_eq!(
        (explorer.state().selected.as_str(), said(&explorer, "lights[0].name")),
        ("lights[0]", Some("\"lamp\""))
    );
    explorer.key_press_modifiers(Modifiers::ALT, Key::ArrowDown);
    explorer.run_steps(3);
    explorer.key_press(Key::Delete);
    settle(&mut explorer);
    assert_eq!(
        (said(&explorer, "lights[1]"), said(&explorer, "lights[0].name")),
        (None, Some("\"sky\""))
    );
}

/// Catches a search that finds nothing, hides where it is found, or leaves the keys to the tree.
#[test]
fn the_search_shows_what_it_finds() {
    let mut explorer = open_small();
    explorer.key_press_modifiers(Modifiers::COMMAND, Key::F);
    explorer.run_steps(3);
    field(&explorer, "Search slots and modules").type_text("masking");
    explorer.run_steps(3);
    assert!(
        explorer
            .query_by_label("materials.shiny.brdf.fill.masking: smith-ggx-correlated")
            .is_some()
    );
    assert!(
        explorer.query_by_label("materials.shiny.brdf: microfacet").is_some(),
        "what is above it"
    );
    assert!(explorer.query_by_label("materials.matt.brdf: lambert").is_none());
}
