//! The camera and what is behind everything.

use std::sync::Arc;

use eframe::egui::{self, Slider};

use super::object::vector;
use crate::App;
use crate::document::ron_of;
use crate::panels::viewport::{Camera, move_to};

/// Shows them.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    if let Some(frame) = app.viewport.frame().map(Arc::clone) {
        let mut camera = Camera::of(app.document.scene().scene(), &frame);
        let decl = &mut camera.decl;
        let mut changed = false;
        for (name, place) in [("eye", &mut decl.eye), ("target", &mut decl.target), ("up", &mut decl.up)] {
            let mut value = [place.0, place.1, place.2];
            if vector(ui, name, &mut value, 0.01, "") {
                *place = value.into();
                changed = true;
            }
        }
        let label = ui.label("field of view");
        let slider = Slider::new(&mut decl.fov, 1.0..=150.0).suffix("°");
        changed |= ui.add(slider).labelled_by(label.id).changed();
        if changed {
            move_to(app, &camera);
        }
    }
    let mut background = app.document.scene().scene().background;
    if vector(ui, "background", &mut background, 0.01, " cd/m²") {
        let value = background.map(|x| x.max(0.0));
        app.continued("background", |draft| {
            draft.set(&[], "background", &ron_of(&(value[0], value[1], value[2])))
        });
    }
}
