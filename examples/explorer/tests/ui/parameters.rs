//! Values, by the names of their parameters.

use eframe::egui::Role;
use egui_kittest::kittest::Queryable;

use crate::harness::{click, mean, open_small, said, select, settle};

/// Catches a slider that sets another value, one that is not set where it is frozen, a reset that resets nothing.
#[test]
fn a_slider_sets_freezes_and_resets() {
    let mut explorer = open_small();
    select(&mut explorer, "materials.shiny.material");
    let before = mean(&explorer);
    explorer.get_by_role_and_label(Role::Slider, "roughness").focus();
    explorer.run_steps(2);
    explorer.key_press(eframe::egui::Key::ArrowRight);
    settle(&mut explorer);
    let turned: f64 = said(&explorer, "materials.shiny.material.params.roughness")
        .unwrap()
        .parse()
        .unwrap();
    assert!(turned > 0.4 && turned < 0.6, "{turned}");
    assert_ne!(mean(&explorer), before);
    click(&mut explorer, "Freeze roughness");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "materials.shiny.material.params.roughness"), None);
    assert_eq!(
        said(&explorer, "materials.shiny.material.freeze.roughness"),
        Some(turned.to_string().as_str())
    );
    assert!(explorer.state().problems.is_empty());
    click(&mut explorer, "Freeze roughness");
    settle(&mut explorer);
    assert_eq!(
        said(&explorer, "materials.shiny.material.params.roughness"),
        Some(turned.to_string().as_str())
    );
    click(&mut explorer, "Reset roughness");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "materials.shiny.material.params.roughness"), None);
}

/// Catches a light whose own values cannot be changed, and a temperature that is lost.
#[test]
fn a_light_has_values_of_its_own() {
    let mut explorer = open_small();
    select(&mut explorer, "lights[0]");
    let before = mean(&explorer);
    assert!(explorer.query_by_label("color temperature").is_some());
    explorer.get_by_label("color temperature").focus();
    explorer.run_steps(2);
    explorer.key_press(eframe::egui::Key::ArrowUp);
    settle(&mut explorer);
    let color = said(&explorer, "lights[0].fields.color").unwrap();
    assert!(color.contains(" K") && color != "\"3000 K\"", "{color}");
    assert_ne!(mean(&explorer), before);
}

/// Catches objects that cannot be hidden, moved or given another material.
#[test]
fn an_object_is_changed() {
    let mut explorer = open_small();
    select(&mut explorer, "objects[0]");
    let before = mean(&explorer);
    click(&mut explorer, "visible");
    settle(&mut explorer);
    assert_eq!(said(&explorer, "objects[0].visible"), Some("false"));
    assert_ne!(mean(&explorer), before);
    click(&mut explorer, "Go to its material");
    assert_eq!(explorer.state().selected, "materials.shiny");
}
