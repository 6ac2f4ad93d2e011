//! Pictures of all that could stand in the selected slot.

use eframe::egui::{self, Button, ScrollArea, TextEdit, TextureOptions, vec2};
use shadewright_report::write::Tile;

use super::pareto::{choose, describe, heading};
use crate::App;
use crate::compare::SweepView;
use crate::work::{WriteSheet, picture};

/// Width of a picture, points.
const WIDTH: f32 = 132.0;
/// Largest height of a picture, points.
const HEIGHT: f32 = 99.0;

/// Shows them.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let sweep = heading(app, ui);
    if cfg!(not(target_arch = "wasm32")) {
        files(app, ui, sweep.as_ref());
    }
    let Some(sweep) = sweep else { return };
    load(app, ui, &sweep);
    let mut clicked = None;
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            for (index, alternative) in sweep.alternatives.iter().enumerate() {
                let sides = sweep.size.map(|side| side.max(1) as f32);
                let shrink = (WIDTH / sides[0]).min(HEIGHT / sides[1]);
                let size = vec2(sides[0], sides[1]) * shrink;
                ui.allocate_ui(vec2(WIDTH + 8.0, size.y + 48.0), |ui| {
                    ui.vertical(|ui| {
                        ui.set_width(WIDTH + 8.0);
                        let texture = app.compare.tiles.get(index).filter(|_| alternative.outcome.is_ok());
                        let button = match texture {
                            Some(texture) => Button::image(egui::Image::new((texture.id(), size)).fit_to_exact_size(size)),
                            None => Button::new("not legal").min_size(size),
                        };
                        let is_legal = alternative.outcome.is_ok();
                        let response = ui.add_enabled(is_legal, button.selected(alternative.is_present));
                        let name = format!("Choose {} for {}", alternative.name, sweep.path);
                        let is_present = alternative.is_present;
                        response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, is_legal, is_present, &name));
                        let about = describe(alternative);
                        if response.on_hover_text(&about).on_disabled_hover_text(&about).clicked() {
                            clicked = Some(alternative.clone());
                        }
                        ui.add(egui::Label::new(&alternative.name).truncate());
                        if let Ok(measured) = &alternative.outcome {
                            ui.add(egui::Label::new(egui::RichText::new(&measured.summary).weak().small()).truncate());
                        }
                    });
                });
            }
        });
    });
    if let Some(alternative) = clicked {
        choose(app, &sweep, &alternative);
    }
}

/// Puts the pictures that are new into the window's memory.
fn load(app: &mut App, ui: &egui::Ui, sweep: &SweepView) {
    for alternative in sweep.alternatives.iter().skip(app.compare.tiles.len()) {
        let pixels = alternative.outcome.as_ref().map(|measured| measured.pixels.as_slice());
        let image = match pixels {
            Ok(pixels) => picture(sweep.size, pixels),
            Err(_) => picture([1, 1], &[]),
        };
        let texture = ui.ctx().load_texture("alternative", image, TextureOptions::LINEAR);
        app.compare.tiles.push(texture);
    }
}

/// A space instead of the slot's modules, and the sheet as a file.
fn files(app: &mut App, ui: &mut egui::Ui, sweep: Option<&SweepView>) {
    ui.horizontal_wrapped(|ui| {
        let label = ui.label("Space");
        let typed = ui.scope_id().with("space");
        let mut path: String = ui.data(|data| data.get_temp(typed)).unwrap_or_else(|| app.compare.space.clone());
        let field = TextEdit::singleline(&mut path)
            .hint_text("*.space.ron, else all modules")
            .desired_width(220.0);
        let field = ui.add(field).labelled_by(label.id);
        if field.changed() {
            ui.data_mut(|data| data.insert_temp(typed, path.clone()));
        }
        if field.lost_focus() {
            app.compare.space = path.trim().to_owned();
            ui.data_mut(|data| data.remove_temp::<String>(typed));
        }
        ui.separator();
        let label = ui.label("Write to");
        let field = TextEdit::singleline(&mut app.compare.sheet_path)
            .hint_text("sheet.png")
            .desired_width(160.0);
        ui.add(field).labelled_by(label.id);
        let is_done = sweep.is_some_and(|sweep| sweep.alternatives.len() == sweep.of);
        let can = is_done && !app.compare.sheet_path.is_empty();
        if ui.add_enabled(can, Button::new("Write the sheet")).clicked()
            && let Some(sweep) = sweep
        {
            let tiles = sweep.alternatives.iter().filter_map(|alternative| {
                let measured = alternative.outcome.as_ref().ok()?;
                Some(Tile {
                    name: format!("{}: {}", alternative.name, measured.summary),
                    pixels: measured.pixels.clone(),
                })
            });
            app.lanes.desk.ask(WriteSheet {
                tiles: tiles.collect(),
                size: sweep.size,
                path: app.compare.sheet_path.clone(),
            });
        }
    });
}
