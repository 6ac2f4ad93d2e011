//! Which code the tabs look at: chosen by hand, or by what is selected in the tree.

use std::sync::Arc;

use eframe::egui::{self, ComboBox, WidgetInfo};

use crate::App;
use crate::panels::tree;
use crate::tree::{Kind, row_of};
use crate::work::{Inspect, Inspected, Language, Made, View};

/// What of it is remembered.
#[derive(Default)]
pub struct InspectState {
    /// What is to be looked at.
    pub view: View,
    /// What was asked for last.
    asked: Option<(u64, View)>,
    /// What is there.
    pub shown: Option<Arc<Inspected>>,
    /// The selection that the choice has followed.
    followed: String,
}

impl InspectState {
    /// Takes what was asked for.
    pub fn take(&mut self, inspected: Inspected) {
        self.shown = Some(Arc::new(inspected));
    }
}

/// Follows the selection, asks for what is not there yet, and gives what is.
pub(super) fn current(app: &mut App) -> Option<Arc<Inspected>> {
    if app.tabs.inspect.followed != app.selected {
        app.tabs.inspect.followed.clone_from(&app.selected);
        if let Some(root) = root_of(app) {
            // A second recipe of the same material is as good.
            let is_of = app.tabs.inspect.view.subject.split('#').next() == Some(root.as_str());
            if !is_of {
                app.tabs.inspect.view.subject = root;
                app.tabs.inspect.view.pass.clear();
            }
        }
    }
    let state = &mut app.tabs.inspect;
    let wanted = (app.version, state.view.clone());
    if state.asked.as_ref() != Some(&wanted) {
        state.asked = Some(wanted);
        let painted = app.viewport.painted.as_ref();
        let frame = painted.filter(|painted| painted.version == app.version);
        let job = Inspect {
            frame: frame.map(|painted| Arc::clone(&painted.frame)),
            view: state.view.clone(),
            shot: app.shot(),
        };
        app.lanes.desk.ask(job);
    }
    app.tabs.inspect.shown.clone()
}

/// The row that the recipe of the selected row is made from.
fn root_of(app: &App) -> Option<String> {
    let index = app.rows.iter().position(|row| row.path == app.selected)?;
    let mut depth = usize::MAX;
    // From the row upwards, by what holds it.
    for row in app.rows[..=index].iter().rev() {
        if row.depth >= depth {
            continue;
        }
        depth = row.depth;
        let is_display = row.path == "display";
        if is_display || matches!(row.kind, Kind::Material | Kind::Gltf { .. }) {
            return Some(row.path.clone());
        }
    }
    None
}

/// The choices of recipe and pass; `language`: of the language too.
pub(super) fn choices(app: &mut App, ui: &mut egui::Ui, made: &Made, language: bool) {
    let view = &mut app.tabs.inspect.view;
    // What is shown and not what was asked for: that may not exist.
    let mut key = made.view.subject.clone();
    combo(ui, "Recipe", &made.subject().name, |ui| {
        for subject in &made.subjects {
            option(ui, "Recipe", &mut key, subject.key.clone(), &subject.name);
        }
    });
    if key != made.view.subject {
        view.subject = key;
        view.pass.clear();
    }
    let mut pass = made.view.pass.clone();
    combo(ui, "Pass", &made.view.pass, |ui| {
        for name in &made.passes {
            option(ui, "Pass", &mut pass, name.clone(), name);
        }
    });
    if pass != made.view.pass {
        view.pass = pass;
    }
    if !language {
        return;
    }
    combo(ui, "Language", made.view.language.name(), |ui| {
        for language in Language::ALL {
            option(ui, "Language", &mut view.language, language, language.name());
        }
    });
    if made.view.language.takes_entry() {
        let mut entry = made.view.entry.clone();
        combo(ui, "Entry point", &made.view.entry, |ui| {
            for declared in &made.program.reflection().entry_points {
                option(ui, "Entry point", &mut entry, declared.name.clone(), &declared.name);
            }
        });
        if entry != made.view.entry {
            view.entry = entry;
        }
    }
}

fn combo(ui: &mut egui::Ui, name: &str, shown: &str, options: impl FnOnce(&mut egui::Ui)) {
    let combo = ComboBox::from_id_salt(name).selected_text(shown).width(60.0);
    let response = combo.show_ui(ui, options).response;
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(egui::Role::ComboBox, true, name);
        info.current_text_value = Some(shown.to_owned());
        info
    });
    response.on_hover_text(name);
}

fn option<T: PartialEq>(ui: &mut egui::Ui, combo: &str, chosen: &mut T, value: T, name: &str) {
    let is_chosen = *chosen == value;
    let response = ui.selectable_value(chosen, value, name);
    response.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_chosen, format!("{combo}: {name}")));
}

/// Selects the row that a slot path of the shown program stands in.
pub(super) fn select(app: &mut App, made: &Made, place: &str) {
    let row = row_of(&app.rows, made.subject(), made.place(place));
    if let Some(path) = row.map(|row| row.path.clone()) {
        tree::select(app, &path);
    }
}

/// Says what is in the way where there is nothing to show.
pub(super) fn made<'i>(ui: &mut egui::Ui, inspected: Option<&'i Inspected>) -> Option<&'i Made> {
    match inspected.map(|inspected| &inspected.made) {
        None => {
            ui.weak("Linking");
            None
        }
        Some(Err(report)) => {
            egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
                ui.label("It does not link:");
                super::problems::report(ui, report);
            });
            None
        }
        Some(Ok(made)) => Some(made),
    }
}
