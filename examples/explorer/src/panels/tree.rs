//! The scene as a tree of choices, with a menu for each.

mod menu;
mod row;

use eframe::egui::{self, ScrollArea, TextEdit};

use crate::App;
use crate::tree::Row;
use crate::work::Legal;

/// What the tree remembers.
#[derive(Default)]
pub struct TreeState {
    /// What is searched for.
    pub search: String,
    /// Paths of the rows whose children are hidden.
    pub folded: std::collections::BTreeSet<String>,
    /// The choices of the menu that is open, as soon as they are known.
    pub legal: Option<Legal>,
    /// The place and version that they were asked for.
    pub asked: Option<(String, u64)>,
    /// The search takes the keyboard with the next frame.
    pub focus_search: bool,
    /// The menu of the selected row is opened with the next frame.
    pub open_menu: bool,
    /// The selection is scrolled to with the next frame.
    pub scroll_to: bool,
}

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let search = ui.add(
        TextEdit::singleline(&mut app.tree.search)
            .hint_text("Search slots and modules")
            .desired_width(f32::INFINITY),
    );
    if std::mem::take(&mut app.tree.focus_search) {
        search.request_focus();
    }
    ui.separator();
    let shown = shown(app);
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        for row in &shown {
            row::show(app, ui, row);
        }
    });
}

/// The rows that are shown: those that are found, with all that is above them; else those that nothing hides.
pub(super) fn shown(app: &App) -> Vec<Row> {
    let wanted = app.tree.search.trim().to_lowercase();
    let mut shown: Vec<Row> = Vec::new();
    if wanted.is_empty() {
        let mut hidden_below = None;
        for row in &app.rows {
            if hidden_below.is_some_and(|depth| row.depth > depth) {
                continue;
            }
            hidden_below = app.tree.folded.contains(&row.path).then_some(row.depth);
            shown.push(row.clone());
        }
        return shown;
    }
    let found = |row: &Row| {
        let module = row.module.as_ref();
        let texts = [Some(&row.label), module.map(|m| &m.name), module.map(|m| &m.manifest.summary)];
        texts.into_iter().flatten().any(|text| text.to_lowercase().contains(&wanted))
            || row.interface().is_some_and(|i| i.contains(&wanted))
    };
    let mut above: Vec<&Row> = Vec::new();
    for row in &app.rows {
        above.truncate(above.iter().take_while(|other| other.depth < row.depth).count());
        above.push(row);
        if found(row) {
            for row in &above {
                if !shown.iter().any(|other| other.path == row.path) {
                    shown.push((*row).clone());
                }
            }
        }
    }
    shown
}

/// Selects the row before or after the one that is selected.
pub(super) fn step(app: &mut App, down: bool) {
    let shown = shown(app);
    let at = shown.iter().position(|row| row.path == app.selected);
    let next = match at {
        None => 0,
        Some(at) if down => (at + 1).min(shown.len().saturating_sub(1)),
        Some(at) => at.saturating_sub(1),
    };
    if let Some(row) = shown.get(next) {
        app.selected.clone_from(&row.path);
        app.tree.scroll_to = true;
    }
}

/// Selects a row from elsewhere: nothing hides it any more, and it is scrolled to.
pub(super) fn select(app: &mut App, path: &str) {
    let Some(index) = app.rows.iter().position(|row| row.path == path) else {
        return;
    };
    let mut depth = app.rows[index].depth;
    for row in app.rows[..index].iter().rev() {
        if row.depth < depth {
            depth = row.depth;
            app.tree.folded.remove(&row.path);
        }
    }
    path.clone_into(&mut app.selected);
    app.tree.scroll_to = true;
    if !shown(app).iter().any(|row| row.path == path) {
        app.tree.search.clear();
    }
}

/// Shows or hides what is below the selected row.
pub(super) fn fold(app: &mut App, fold: bool) {
    let path = app.selected.clone();
    if fold {
        app.tree.folded.insert(path);
    } else {
        app.tree.folded.remove(&path);
    }
}
