//! An object: where it is, what it is made of, and what it takes part in.

use eframe::egui::{self, ComboBox, DragValue};

use crate::App;
use crate::document::{quoted, ron_of};

/// Shows an object of the scene.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui, index: usize) {
    let Some(object) = app.document.scene().scene().objects.get(index).cloned() else {
        return;
    };
    let materials: Vec<String> = app.document.scene().scene().materials.keys().cloned().collect();
    let mut chosen = object.material.clone();
    let label = ui.label("material");
    ComboBox::from_id_salt("material")
        .selected_text(&chosen)
        .show_ui(ui, |ui| {
            for name in materials {
                ui.selectable_value(&mut chosen, name.clone(), name);
            }
        })
        .response
        .labelled_by(label.id);
    if chosen != object.material {
        app.edit("material", |draft| {
            draft.set(&[], &format!("objects[{index}].material"), &quoted(&chosen))
        });
    }
    let rows = [
        ("translate", object.translate, 0.01, " m"),
        ("rotate", object.rotate, 0.5, "°"),
        ("scale", object.scale, 0.01, ""),
    ];
    for (name, mut value, speed, unit) in rows {
        if vector(ui, name, &mut value, speed, unit) {
            let path = format!("objects[{index}].{name}");
            app.continued(&path, |draft| draft.set(&[], &path, &ron_of(&(value[0], value[1], value[2]))));
        }
    }
    let flags = [
        ("visible", object.visible),
        ("double_sided", object.double_sided),
        ("alpha_blend", object.alpha_blend),
        ("casts_shadow", object.casts_shadow),
        ("receives_light", object.receives_light),
    ];
    for (name, mut on) in flags {
        if ui.checkbox(&mut on, name).changed() {
            app.edit(name, |draft| draft.set(&[], &format!("objects[{index}].{name}"), &on.to_string()));
        }
    }
    ui.separator();
    if ui.button("Go to its material").clicked() {
        app.selected = format!("materials{}", crate::document::step_path(&object.material));
    }
}

/// The objects that are made of a material.
pub(super) fn of_material(app: &mut App, ui: &mut egui::Ui, material: &str) {
    let objects = &app.document.scene().scene().objects;
    let names: Vec<String> = objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.material == material)
        .map(|(index, object)| object.name.clone().unwrap_or_else(|| format!("object {}", index + 1)))
        .collect();
    ui.label(format!(
        "Made of it: {}",
        if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
    ));
}

/// Three numbers; whether one has changed.
pub(super) fn vector(ui: &mut egui::Ui, name: &str, value: &mut [f32; 3], speed: f64, unit: &str) -> bool {
    ui.label(name);
    let mut changed = false;
    ui.horizontal(|ui| {
        for (component, x) in ["x", "y", "z"].into_iter().zip(value) {
            let response = ui.add(DragValue::new(x).speed(speed).suffix(unit));
            let (accessible, shown) = (format!("{name}.{component}"), f64::from(*x));
            response.widget_info(|| egui::WidgetInfo {
                label: Some(accessible.clone()),
                ..egui::WidgetInfo::drag_value(true, shown)
            });
            changed |= response.changed();
        }
    });
    changed
}
