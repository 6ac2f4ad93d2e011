//! What is selected: its parameters, as its manifest declares them.

mod knob;
mod object;
mod view;

use std::sync::Arc;

use eframe::egui::{self, RichText, ScrollArea};
use indexmap::IndexMap;
use shadewright_compiler::Module;
use shadewright_compiler::manifest::{Param, ParamMode, ResourceKind, Value, ron_options};

use crate::App;
use crate::document::{quoted, ron_of, step_path};
use crate::tree::{Kind, Part, Row};

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let Some(row) = app.selected_row().cloned() else {
        ui.label("Nothing is selected.");
        return;
    };
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.push_id(&row.path, |ui| {
            ui.strong(&row.label);
            ui.weak(&row.path);
            match &row.kind {
                Kind::Heading(Part::View) => view::show(app, ui),
                Kind::Object { index } => object::show(app, ui, *index),
                Kind::Material => object::of_material(app, ui, &row.label),
                _ => {}
            }
            if let Some(module) = row.module.clone() {
                about(ui, &module);
                of_module(app, ui, &row, &module);
            }
        });
    });
}

fn about(ui: &mut egui::Ui, module: &Module) {
    ui.separator();
    ui.label(RichText::new(format!("{}/{}", module.category, module.name)).strong());
    ui.label(&module.manifest.summary);
    for source in &module.manifest.source {
        ui.weak(source);
    }
    if !module.manifest.properties.is_empty() {
        ui.weak(format!("claims: {}", module.manifest.properties.join(", ")));
    }
}

/// The parameters of a module that stands somewhere; of a light, also what is said of this one.
fn of_module(app: &mut App, ui: &mut egui::Ui, row: &Row, module: &Arc<Module>) {
    let manifest = &module.manifest;
    if row.is_light() && !manifest.instances.is_empty() {
        ui.separator();
        ui.strong("This light");
        group(app, ui, row, &manifest.instances, "fields", false);
    }
    let params: IndexMap<String, Param> = manifest
        .params
        .iter()
        .filter(|(_, param)| param.filled_slot().is_none())
        .map(|(name, param)| (name.clone(), param.clone()))
        .collect();
    if !params.is_empty() {
        ui.separator();
        ui.strong(if row.is_light() { "All of its kind" } else { "Parameters" });
        group(app, ui, row, &params, "params", true);
    }
    files(app, ui, row, module);
}

/// Values of one group. `part` is where the scene has them.
fn group(app: &mut App, ui: &mut egui::Ui, row: &Row, params: &IndexMap<String, Param>, part: &str, can_freeze: bool) {
    for (name, param) in params {
        let path = format!("{}.{part}{}", row.path, step_path(name));
        let frozen_path = format!("{}.freeze{}", row.path, step_path(name));
        let said = |path: &str| {
            let text = app.document.scene().get(path)?;
            ron_options().from_str::<Value>(text).ok()
        };
        let frozen = if can_freeze { said(&frozen_path) } else { None };
        let stated = said(&path);
        let value = frozen.clone().or_else(|| stated.clone()).unwrap_or_else(|| param.default.clone());
        let is_frozen = frozen.is_some();
        ui.push_id(name, |ui| {
            let label = ui
                .horizontal(|ui| {
                    let label = ui.label(name).on_hover_text(hover(param));
                    if can_freeze && param.mode != ParamMode::Constant {
                        let sign = ui.selectable_label(is_frozen, "❄");
                        let accessible = format!("Freeze {name}");
                        sign.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_frozen, &accessible));
                        if sign.on_hover_text("A constant of the shader, not a uniform").clicked() {
                            app.edit(&accessible, |draft| draft.freeze(&row.through, &row.path, name, !is_frozen, &value));
                        }
                    }
                    if stated.is_some() || is_frozen {
                        let reset = ui.small_button("↺");
                        let accessible = format!("Reset {name}");
                        reset.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &accessible));
                        if reset.on_hover_text("Back to the default").clicked() {
                            app.edit(&accessible, |draft| {
                                draft.unset(&path)?;
                                draft.unset(&frozen_path)
                            });
                        }
                    }
                    label
                })
                .inner;
            if let Some(new) = knob::show(ui, &label, name, param, &value) {
                let at = if is_frozen { &frozen_path } else { &path };
                app.continued(at, |draft| draft.set(&row.through, at, &ron_of(&new)));
            }
        });
    }
}

/// Files of pictures and tables that a module takes.
fn files(app: &mut App, ui: &mut egui::Ui, row: &Row, module: &Module) {
    for (name, resource) in &module.manifest.resources {
        let part = match &resource.kind {
            ResourceKind::Texture { .. } => "textures",
            ResourceKind::Data { format: Some(_), .. } => "files",
            _ => continue,
        };
        let path = format!("{}.{part}{}", row.path, step_path(name));
        let said = app
            .document
            .scene()
            .get(&path)
            .and_then(|text| ron_options().from_str::<String>(text).ok());
        let mut file = said.clone().unwrap_or_default();
        let label = ui.label(name).on_hover_text(&resource.doc);
        let edit = egui::TextEdit::singleline(&mut file).hint_text("file").desired_width(f32::INFINITY);
        let field = ui.add(edit).labelled_by(label.id);
        if field.changed() && !file.is_empty() {
            app.continued(&path, |draft| draft.set(&row.through, &path, &quoted(&file)));
        } else if field.changed() {
            app.edit(&path, |draft| draft.unset(&path));
        }
    }
}

/// What a parameter says of itself.
fn hover(param: &Param) -> String {
    let mut text = param.doc.clone();
    if !param.unit.is_empty() && param.unit != "1" {
        text += &format!("\nunit: {}", param.unit);
    }
    if let Some((low, high)) = param.range {
        text += &format!("\n{low} to {high}");
    }
    for unit in param.also.keys() {
        text += &format!("\nalso in {unit}");
    }
    text.trim_start().to_owned()
}
