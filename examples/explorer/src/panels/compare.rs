//! What is compared with what: the bar above the picture, and what lies over the picture.

mod legend;
mod probe;

use eframe::egui::{self, Align2, Color32, ComboBox, DragValue, EventFilter, FontId, Key, Rect, Sense, Stroke, TextureOptions, pos2, vec2};

use crate::App;
use crate::compare::{Mode, Other};

/// How far a key moves the line, as a share of the width.
const STEP: f32 = 0.02;
/// Width of the line's handle, points.
const HANDLE: f32 = 10.0;

/// The bar above the picture.
pub(super) fn bar(app: &mut App, ui: &mut egui::Ui) {
    ui.spacing_mut().item_spacing.y = 0.0;
    egui::Frame::new().inner_margin(4.0).fill(ui.visuals().panel_fill).show(ui, |ui| {
        ui.take_available_width();
        ui.spacing_mut().item_spacing.y = 3.0;
        ui.horizontal_wrapped(|ui| {
            for mode in Mode::ALL {
                let button = ui.selectable_label(app.compare.mode == mode, mode.name());
                let name = format!("Show {}", mode.name().to_lowercase());
                let is_on = app.compare.mode == mode;
                button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, &name));
                if button.on_hover_text(mode.summary()).clicked() {
                    app.compare(mode);
                }
            }
            if matches!(app.compare.mode, Mode::Split | Mode::Difference) {
                other(app, ui);
            }
            if matches!(app.compare.mode, Mode::Difference | Mode::Error) {
                range(app, ui);
            }
            if ui.button("Pin").on_hover_text("Keep the present permutation").clicked() {
                app.pin();
            }
            ui.checkbox(&mut app.compare.probe, "Probe").on_hover_text("Values under the mouse");
        });
        if app.compare.mode != Mode::Alone && !app.compare.problem.is_empty() {
            ui.colored_label(ui.visuals().error_fg_color, &app.compare.problem);
        }
    });
}

/// With what the present scene is compared.
fn other(app: &mut App, ui: &mut egui::Ui) {
    let mut all = vec![(Other::Reference, "reference".to_owned())];
    all.extend(app.compare.pins.all.iter().map(|pin| (Other::Pin(pin.id), pin.name.clone())));
    let name = app.compare.other_name();
    let shown = ComboBox::from_id_salt("other").selected_text(&name).width(90.0).truncate();
    let combo = shown.show_ui(ui, |ui| {
        for (other, name) in all {
            if ui.selectable_label(app.compare.other == other, name).clicked() {
                app.compare_with(other);
            }
        }
    });
    combo
        .response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::ComboBox, true, format!("Compare with: {name}")));
}

/// The error that has the full colour.
fn range(app: &mut App, ui: &mut egui::Ui) {
    let mut percent = app.compare.full * 100.0;
    let speed = percent * 0.01;
    let drag = DragValue::new(&mut percent)
        .range(0.1..=1000.0)
        .speed(speed)
        .max_decimals(2)
        .prefix("± ")
        .suffix(" %");
    let response = ui.add(drag);
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::drag_value(true, percent);
        info.label = Some("Range of the heat map".to_owned());
        info
    });
    if response.on_hover_text("The error that has the full colour").changed() {
        app.compare.full = (percent / 100.0).max(1e-3);
    }
}

/// What lies over the picture.
pub(super) fn overlay(app: &mut App, ui: &mut egui::Ui, rect: Rect) {
    if app.viewport.painted.is_none() {
        return;
    }
    match app.compare.mode {
        Mode::Alone => {}
        Mode::Split => split(app, ui, rect),
        Mode::Difference | Mode::Error => heat(app, ui, rect),
    }
    if app.compare.probe {
        probe::show(app, ui, rect);
    }
}

/// The whole of a picture.
fn whole() -> Rect {
    Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0))
}

fn split(app: &mut App, ui: &mut egui::Ui, rect: Rect) {
    let line = rect.left() + app.compare.split * rect.width();
    let right = Rect::from_min_max(pos2(line, rect.top()), rect.max);
    let (screen, is_there) = match app.compare.other {
        Other::Reference => (&app.compare.truth_screen, app.compare.refined.is_some()),
        Other::Pin(id) => {
            let shown = app.compare.beside.as_ref().and_then(|beside| beside.second.as_ref());
            (&app.compare.pin_screen, shown.is_some_and(|(drawn, _)| drawn.pin == id))
        }
    };
    let painter = ui.painter().with_clip_rect(right.intersect(ui.clip_rect()));
    let mut name = app.compare.other_name();
    match screen.id().filter(|_| is_there) {
        Some(id) => {
            painter.image(id, rect, whole(), Color32::WHITE);
        }
        None => {
            painter.rect_filled(rect, 0.0, Color32::from_gray(24));
            name += ": being drawn";
        }
    }
    if app.compare.other == Other::Reference {
        name += &coarse(app);
    }
    ui.painter().vline(line, rect.y_range(), Stroke::new(1.0, Color32::WHITE));
    legend::note(ui, pos2(line - 6.0, rect.top() + 6.0), Align2::RIGHT_TOP, "present");
    legend::note(ui, pos2(line + 6.0, rect.top() + 6.0), Align2::LEFT_TOP, &name);
    divider(app, ui, rect, line);
}

/// The line's handle: dragged, or moved by arrow keys.
fn divider(app: &mut App, ui: &mut egui::Ui, rect: Rect, line: f32) {
    let handle = Rect::from_center_size(pos2(line, rect.center().y), vec2(HANDLE, rect.height()));
    let id = ui.scope_id().with("divider");
    let response = ui.interact(handle, id, Sense::click_and_drag());
    let percent = f64::from(app.compare.split * 100.0).round();
    response.widget_info(|| egui::WidgetInfo::slider(true, percent, "Line between the pictures"));
    if response.dragged()
        && let Some(at) = response.interact_pointer_pos()
    {
        app.compare.split = (at.x - rect.left()) / rect.width().max(1.0);
    }
    if response.clicked() {
        response.request_focus();
    }
    let grip = Rect::from_center_size(handle.center(), vec2(HANDLE, 28.0));
    let colour = if response.has_focus() {
        ui.visuals().selection.bg_fill
    } else if response.hovered() || response.dragged() {
        Color32::WHITE
    } else {
        Color32::from_gray(200)
    };
    ui.painter()
        .rect(grip, 3.0, colour, Stroke::new(1.0, Color32::BLACK), egui::StrokeKind::Inside);
    if response.has_focus() {
        let arrows = EventFilter {
            horizontal_arrows: true,
            ..EventFilter::default()
        };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(id, arrows));
        for (key, by) in [(Key::ArrowLeft, -STEP), (Key::ArrowRight, STEP)] {
            let times = ui.input(|input| input.num_presses(key)) as f32;
            app.compare.split += by * times;
        }
    }
    app.compare.split = app.compare.split.clamp(0.0, 1.0);
    response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
}

fn heat(app: &mut App, ui: &mut egui::Ui, rect: Rect) {
    if let Some(image) = app.compare.new_heat.take() {
        let options = TextureOptions::NEAREST;
        match &mut app.compare.heat {
            Some(texture) => texture.set(image, options),
            None => app.compare.heat = Some(ui.ctx().load_texture("heat map", image, options)),
        }
    }
    let (Some(errors), Some(texture)) = (app.compare.errors(), &app.compare.heat) else {
        ui.painter().rect_filled(rect, 0.0, Color32::from_gray(24));
        let text = format!("Drawing the {}", app.compare.other_name());
        let font = FontId::proportional(16.0);
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, Color32::GRAY);
        return;
    };
    ui.painter().image(texture.id(), rect, whole(), Color32::WHITE);
    let is_truth = app.compare.mode == Mode::Error || app.compare.other == Other::Reference;
    let coarse = if is_truth { coarse(app) } else { String::new() };
    let text = format!("against {}{coarse}: {}", app.compare.other_name(), errors.summary);
    legend::words(ui, rect, &text);
    legend::scale(ui, rect, app.compare.full);
}

/// How coarse the truth's picture is, where it is.
fn coarse(app: &App) -> String {
    match &app.compare.refined {
        Some(refined) if refined.divisor > 1 => format!(" (1/{} of the size)", refined.divisor),
        _ => String::new(),
    }
}
