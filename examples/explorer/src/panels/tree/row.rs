//! One line of the tree.

use eframe::egui::{self, Align, Button, Layout, RichText};

use super::menu;
use crate::App;
use crate::tree::{Kind, Row};

/// Width of a level, points.
const INDENT: f32 = 14.0;

/// Shows a line and does what is clicked.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    let response = ui.push_id(&row.path, |ui| ui.horizontal(|ui| line(app, ui, row)).response).inner;
    if row.path == app.selected && std::mem::take(&mut app.tree.scroll_to) {
        response.scroll_to_me(None);
    }
}

fn line(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    ui.add_space(INDENT * row.depth as f32);
    fold(app, ui, row);
    let is_selected = row.path == app.selected;
    let mut label = RichText::new(&row.label);
    if matches!(row.kind, Kind::Heading(_)) {
        label = label.strong();
    }
    if matches!(row.kind, Kind::Parked { .. }) {
        label = label.weak().strikethrough();
    }
    let clicked = ui.selectable_label(is_selected, label).on_hover_text(hover(row)).clicked();
    if clicked {
        app.selected.clone_from(&row.path);
    }
    if row.is_choice() {
        menu::choices(app, ui, row);
    }
    match &row.kind {
        Kind::List { .. } | Kind::Heading(crate::tree::Part::Lights) => menu::add(app, ui, row),
        Kind::Element { list, index, of, .. } => {
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                element(app, ui, row, (list, *index, *of))
            });
        }
        Kind::Parked { which } => {
            let name = format!("Enable {}", row.label);
            if small(ui, "☐", &name) {
                app.edit(&name, |draft| draft.unpark(&row.above, *which));
            }
        }
        _ => {}
    }
}

/// The triangle before a line that has others below it.
fn fold(app: &mut App, ui: &mut egui::Ui, row: &Row) {
    let mut after = app.rows.iter().skip_while(|other| other.path != row.path).skip(1);
    if after.next().is_none_or(|next| next.depth <= row.depth) {
        ui.add_space(18.0);
        return;
    }
    let is_folded = app.tree.folded.contains(&row.path);
    let (sign, name) = if is_folded { ("⏵", "Unfold") } else { ("⏷", "Fold") };
    if small(ui, sign, &format!("{name} {}", row.path)) {
        if is_folded {
            app.tree.folded.remove(&row.path);
        } else {
            app.tree.folded.insert(row.path.clone());
        }
    }
}

/// What can be done with an element of a list.
fn element(app: &mut App, ui: &mut egui::Ui, row: &Row, (list, index, of): (&str, usize, usize)) {
    let what = format!("{} of {list}", row.label);
    if small(ui, "☑", &format!("Disable {what}")) {
        app.edit(&format!("Disable {what}"), |draft| draft.remove(&row.above, list, index, true));
    }
    if index > 0 && small(ui, "⬆", &format!("Move up {what}")) {
        app.edit(&format!("Move up {what}"), |draft| draft.shift(&row.above, list, index, true));
    }
    if index + 1 < of && small(ui, "⬇", &format!("Move down {what}")) {
        app.edit(&format!("Move down {what}"), |draft| draft.shift(&row.above, list, index, false));
    }
    if small(ui, "✖", &format!("Remove {what}")) {
        app.edit(&format!("Remove {what}"), |draft| draft.remove(&row.above, list, index, false));
    }
}

/// A small button without a frame, with a name for those who do not see its sign.
fn small(ui: &mut egui::Ui, sign: &str, name: &str) -> bool {
    let response = ui.add(Button::new(sign).frame(false).small());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    response.on_hover_text(name).clicked()
}

/// What a line is about.
fn hover(row: &Row) -> String {
    let mut lines = Vec::new();
    match &row.kind {
        Kind::Slot { interface, doc, .. } | Kind::List { interface, doc } => {
            lines.push(format!("{}: {interface}", row.path));
            if !doc.is_empty() {
                lines.push(doc.clone());
            }
        }
        _ => lines.push(row.path.clone()),
    }
    if let Some(module) = &row.module {
        lines.push(menu::about(module));
    }
    if !row.is_stated {
        lines.push("by default".to_owned());
    }
    lines.join("\n")
}
