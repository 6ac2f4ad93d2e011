//! The menus and the status line.

use eframe::egui::{self, Button, RichText};

use crate::App;
use crate::files::Purpose;
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
            files(app, ui);
        });
        ui.menu_button("Edit", |ui| {
            let undo = app.can_undo().map(|what| format!("Undo {what}"));
            let shown = Button::new(undo.as_deref().unwrap_or("Undo")).shortcut_text("Ctrl+Z");
            if ui.add_enabled(undo.is_some(), shown).clicked() {
                app.undo();
            }
            let redo = app.can_redo().map(|what| format!("Redo {what}"));
            let shown = Button::new(redo.as_deref().unwrap_or("Redo")).shortcut_text("Ctrl+Shift+Z");
            if ui.add_enabled(redo.is_some(), shown).clicked() {
                app.redo();
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

/// What is done with files.
fn files(app: &mut App, ui: &mut egui::Ui) {
    let ask = |app: &mut App, ui: &mut egui::Ui, purpose: Purpose, keys: &str| {
        let mut button = Button::new(purpose.name());
        if !keys.is_empty() {
            button = button.shortcut_text(keys);
        }
        if ui.add(button).clicked() {
            app.ask_path(purpose);
        }
    };
    ask(app, ui, Purpose::Open, "Ctrl+O");
    if cfg!(target_arch = "wasm32") {
        return on_a_page(app, ui, ask);
    }
    ui.menu_button("Recent", |ui| {
        for path in app.kept.recent.clone() {
            if ui.button(path.display().to_string()).clicked() {
                app.open_file(path);
            }
        }
        if app.kept.recent.is_empty() {
            ui.weak("none yet");
        }
    });
    if ui.add(Button::new("Save").shortcut_text("Ctrl+S")).clicked() {
        app.save();
    }
    ask(app, ui, Purpose::SaveAs, "Ctrl+Shift+S");
    ui.separator();
    for purpose in [Purpose::Png, Purpose::Exr, Purpose::Wgsl, Purpose::Recipe] {
        ask(app, ui, purpose, "");
    }
    ui.separator();
    ask(app, ui, Purpose::Modules, "");
    let folder = app.modules.as_ref().map(|modules| modules.path.display().to_string());
    if let Some(folder) = folder
        && ui
            .button("Standard modules only")
            .on_hover_text(format!("now also those of {folder}"))
            .clicked()
    {
        app.use_modules(None);
    }
}

/// What is done with files where there is no disk.
fn on_a_page(app: &mut App, ui: &mut egui::Ui, ask: impl Fn(&mut App, &mut egui::Ui, Purpose, &str)) {
    ask(app, ui, Purpose::SaveAs, "Ctrl+S");
    ui.separator();
    for purpose in [Purpose::Png, Purpose::Exr, Purpose::Wgsl, Purpose::Recipe] {
        ask(app, ui, purpose, "");
    }
}

/// What happened last, what is being done, and what drawing costs.
pub(super) fn status(app: &mut App, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        let lanes = [("view", &app.lanes.view), ("desk", &app.lanes.desk), ("long", &app.lanes.long)];
        let mut cancelled = None;
        for (name, lane) in lanes {
            if let Some((kind, progress)) = lane.progress() {
                ui.spinner();
                // One step is over before anybody could cancel it.
                let progress = progress.filter(|progress| progress.of > 1);
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
