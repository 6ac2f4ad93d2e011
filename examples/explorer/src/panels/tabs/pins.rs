//! Permutations that are kept.

use eframe::egui::{self, Button, ScrollArea, TextEdit, TextureOptions, vec2};

use crate::App;
use crate::compare::{Other, Pin, Thumbnail};

/// Width of a pin's place, points.
const WIDTH: f32 = 144.0;

/// What is asked of a pin.
enum Asked {
    Go,
    Compare,
    Remove,
    Rename(String),
}

/// Shows them.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    if app.compare.pins.all.is_empty() {
        ui.label("Nothing is pinned. “Pin” above the picture keeps the present permutation.");
        return;
    }
    let pins = app.compare.pins.all.clone();
    let mut asked = None;
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            for pin in &pins {
                ui.push_id(pin.id, |ui| {
                    ui.vertical(|ui| {
                        ui.set_width(WIDTH + 8.0);
                        asked = card(app, ui, pin).map(|what| (pin.id, what)).or(asked.take());
                    });
                });
            }
        });
    });
    let Some((id, what)) = asked else { return };
    match what {
        Asked::Go => {
            if let Some(pin) = app.compare.pins.get(id).cloned() {
                app.go_to(&format!("Go to {}", pin.name), &pin.state);
            }
        }
        Asked::Compare => app.compare_with(Other::Pin(id)),
        Asked::Remove => app.compare.pins.remove(id),
        Asked::Rename(name) => {
            if let Some(pin) = app.compare.pins.all.iter_mut().find(|pin| pin.id == id) {
                pin.name = name;
            }
        }
    }
}

fn card(app: &mut App, ui: &mut egui::Ui, pin: &Pin) -> Option<Asked> {
    let mut asked = None;
    let is_here = pin.state.text == app.document.state().text;
    let size = vec2(WIDTH, WIDTH / 1.6);
    let image = picture(app, ui, pin.id).map(|id| egui::Image::new((id, size)).fit_to_exact_size(size));
    let button = match image {
        Some(image) => Button::image(image),
        None => Button::new("…").min_size(size),
    };
    let response = ui.add(button.selected(is_here));
    let name = format!("Go to {}", pin.name);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_here, &name));
    if response.on_hover_text(&name).clicked() {
        asked = Some(Asked::Go);
    }
    let mut text = pin.name.clone();
    let field = ui.add(TextEdit::singleline(&mut text).desired_width(WIDTH));
    field.widget_info(|| {
        let mut info = egui::WidgetInfo::text_edit(true, &pin.name, &text, "");
        info.label = Some(format!("Name of pin {}", pin.id));
        info
    });
    if field.changed() {
        asked = Some(Asked::Rename(text));
    }
    ui.horizontal(|ui| {
        let is_other = app.compare.other == Other::Pin(pin.id);
        let compare = ui.selectable_label(is_other, "Compare");
        let name = format!("Compare with {}", pin.name);
        compare.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_other, &name));
        if compare.on_hover_text(&name).clicked() {
            asked = Some(Asked::Compare);
        }
        let remove = ui.small_button("✖");
        let name = format!("Remove pin {}", pin.name);
        remove.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &name));
        if remove.on_hover_text(&name).clicked() {
            asked = Some(Asked::Remove);
        }
    });
    asked
}

/// The pin's small picture, if it is there.
fn picture(app: &mut App, ui: &egui::Ui, id: u64) -> Option<egui::TextureId> {
    let place = app.compare.pins.pictures.get_mut(&id)?;
    if let Thumbnail::Drawn(image) = place {
        let image = std::mem::take(image);
        *place = Thumbnail::Shown(ui.ctx().load_texture("pin", image, TextureOptions::LINEAR));
    }
    match place {
        Thumbnail::Shown(texture) => Some(texture.id()),
        _ => None,
    }
}
