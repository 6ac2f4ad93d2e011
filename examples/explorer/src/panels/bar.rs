//! The menus and the status line.

use eframe::egui::{self, Button, RichText};

use crate::App;
use crate::scenes;

/// The menus.
pub(super) fn menus(app: &mut App, ui: &mut egui::Ui) {
    egui::MenuBar::new().ui(ui, |ui| {
        ui.menu_button("File", |ui| {
            ui.menu_button("Examples", |ui| {
                for example in scenes::ALL {
                    let button = ui.button(example.name).on_hover_text(example.summary);
                    if button.clicked() {
                        app.open_example(example);
                    }
                }
            });
        });
        ui.menu_button("Edit", |ui| {
            let undo = app.document.can_undo().map(|what| format!("Undo {what}"));
            let shown = Button::new(undo.as_deref().unwrap_or("Undo")).shortcut_text("Ctrl+Z");
            if ui.add_enabled(undo.is_some(), shown).clicked() {
                app.document.undo();
            }
            let redo = app.document.can_redo().map(|what| format!("Redo {what}"));
            let shown = Button::new(redo.as_deref().unwrap_or("Redo")).shortcut_text("Ctrl+Shift+Z");
            if ui.add_enabled(redo.is_some(), shown).clicked() {
                app.document.redo();
            }
        });
        ui.menu_button("View", |ui| {
            for theme in [egui::Theme::Light, egui::Theme::Dark] {
                if ui.button(format!("{theme:?}")).clicked() {
                    ui.ctx().set_theme(theme);
                }
            }
        });
        ui.separator();
        let changed = if app.document.is_changed() { " *" } else { "" };
        ui.label(format!("{}{changed}", app.document.state().name));
    });
}

/// What happened last, what is being done, and what drawing costs.
pub(super) fn status(app: &mut App, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        let lanes = [("view", &app.lanes.view), ("desk", &app.lanes.desk), ("long", &app.lanes.long)];
        let mut cancelled = None;
        for (name, lane) in lanes {
            if let Some((kind, progress)) = lane.progress() {
                ui.spinner();
                if let Some(progress) = &progress {
                    ui.label(format!("{}: {} of {}", progress.what, progress.done, progress.of));
                } else {
                    ui.label(kind);
                }
                if progress.is_some() && ui.small_button("Cancel").on_hover_text(format!("Cancel: {kind}")).clicked() {
                    cancelled = Some((name, kind));
                }
            }
        }
        match cancelled {
            Some(("view", kind)) => app.lanes.view.cancel(kind),
            Some(("desk", kind)) => app.lanes.desk.cancel(kind),
            Some((_, kind)) => app.lanes.long.cancel(kind),
            None => {}
        }
        let colour = if app.problems.is_empty() {
            ui.visuals().text_color()
        } else {
            ui.visuals().error_fg_color
        };
        ui.add(egui::Label::new(RichText::new(&app.message).color(colour)).truncate());
    });
}
