//! The menu of a place: what could stand there.

use std::sync::Arc;

use eframe::egui::{self, Button, RichText, ScrollArea};
use shadewright_compiler::Module;

use crate::App;
use crate::tree::{Kind, Row, choose, element, options};
use crate::work::{Try, Verdict};

/// The button of a place with its menu.
pub(super) fn choices(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    let name = row.module.as_ref().map_or("(empty)", |module| module.name.as_str());
    let mut text = RichText::new(name);
    if !row.is_stated {
        text = text.italics();
    }
    let button = ui.menu_button(text, |ui| menu(app, ui, row));
    if row.path == app.selected && std::mem::take(&mut app.tree.open_menu) {
        egui::Popup::open_id(ui.ctx(), egui::Popup::default_response_id(&button.response));
        ui.ctx().request_repaint();
    }
    let accessible = format!("{}: {name}", row.path);
    button
        .response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &accessible));
}

fn menu(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    let verdicts = verdicts(app, row);
    if let Kind::Slot { may_be_empty, .. } = &row.kind
        && row.is_stated
    {
        let name = if *may_be_empty { "(empty)" } else { "(default)" };
        // A module that has no default cannot go back to it.
        let is_legal = row.path != "pass";
        if ui.add_enabled(is_legal, Button::new(name)).clicked() {
            let catalog = Arc::clone(&app.catalog);
            app.edit(&format!("Reset {}", row.path), |draft| choose(draft, &catalog, row, None));
        }
    }
    list(ui, &row.path, &verdicts, row.module.as_ref(), |module| {
        let catalog = Arc::clone(&app.catalog);
        app.edit(&format!("Choose {} for {}", module.name, row.path), |draft| {
            choose(draft, &catalog, row, Some(module))
        });
    });
}

/// The menu that adds to a list.
pub(super) fn add(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    let Some(list_path) = row.list() else { return };
    let interface = row.interface().unwrap_or("light").to_owned();
    let button = ui.menu_button("+", |ui| {
        let all = options(&app.catalog, &interface).map(|module| Verdict {
            module: Arc::clone(module),
            reason: None,
        });
        let all: Vec<Verdict> = all.collect();
        list(ui, list_path, &all, None, |module| {
            let catalog = Arc::clone(&app.catalog);
            app.edit(&format!("Add {} to {list_path}", module.name), |draft| {
                draft.add(&row.through, list_path, &element(&catalog, list_path, module))
            });
        });
    });
    let accessible = format!("Add to {list_path}");
    button
        .response
        .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &accessible));
}

/// The modules that fit, with what is known of their legality; asks for it where it is not.
fn verdicts(app: &mut App, row: &Row) -> Vec<Verdict> {
    let known = app
        .tree
        .legal
        .as_ref()
        .filter(|legal| legal.version == app.version && legal.path == row.path);
    if let Some(legal) = known {
        return legal.verdicts.clone();
    }
    let asked = (row.path.clone(), app.version);
    if app.tree.asked.as_ref() != Some(&asked) {
        app.lanes.desk.ask(Try::new(app.shot(), row.clone()));
        app.tree.asked = Some(asked);
    }
    let unknown = |module: &Arc<Module>| Verdict {
        module: Arc::clone(module),
        reason: None,
    };
    options(&app.catalog, row.interface().unwrap_or_default()).map(unknown).collect()
}

fn list(ui: &mut egui::Ui, path: &str, verdicts: &[Verdict], chosen: Option<&Arc<Module>>, mut choose: impl FnMut(&Module)) {
    ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
        ui.set_min_width(340.0);
        for Verdict { module, reason } in verdicts {
            let is_chosen = chosen.is_some_and(|chosen| Arc::ptr_eq(chosen, module));
            let summary = RichText::new(&module.manifest.summary).weak().small();
            let button = Button::selectable(is_chosen, &module.name).right_text(summary);
            let response = ui.add_enabled(reason.is_none(), button);
            let accessible = format!("{path} = {}", module.name);
            response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, reason.is_none(), is_chosen, &accessible));
            let response = response.on_hover_text(about(module));
            if let Some(reason) = reason {
                response.on_disabled_hover_text(reason);
            } else if response.clicked() {
                choose(module);
                ui.close();
            }
        }
    });
}

/// What a module says of itself.
pub(super) fn about(module: &Module) -> String {
    let mut lines = vec![format!("{}/{}", module.category, module.name), module.manifest.summary.clone()];
    lines.extend(module.manifest.source.iter().cloned());
    if !module.manifest.properties.is_empty() {
        lines.push(format!("claims: {}", module.manifest.properties.join(", ")));
    }
    lines.join("\n")
}
