//! What the keyboard does anywhere in the window.

use eframe::egui::{self, Key, KeyboardShortcut, Modifiers};

use super::{Tab, tree};
use crate::App;
use crate::files::Purpose;
use crate::tree::Kind;

const UNDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Z);
const REDO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::Z);
const REDO_TOO: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::Y);
const SEARCH: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::F);
const OPEN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::O);
const SAVE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::S);
const SAVE_AS: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::S);
const UP: KeyboardShortcut = KeyboardShortcut::new(Modifiers::ALT, Key::ArrowUp);
const DOWN: KeyboardShortcut = KeyboardShortcut::new(Modifiers::ALT, Key::ArrowDown);

const NUMBERS: [Key; 9] = [
    Key::Num1,
    Key::Num2,
    Key::Num3,
    Key::Num4,
    Key::Num5,
    Key::Num6,
    Key::Num7,
    Key::Num8,
    Key::Num9,
];

/// Takes the shortcuts out of the input and does what they say.
pub(super) fn take(app: &mut App, ui: &mut egui::Ui) {
    let hit = |ui: &egui::Ui, shortcut: &KeyboardShortcut| ui.input_mut(|input| input.consume_shortcut(shortcut));
    if hit(ui, &SEARCH) {
        app.tree.focus_search = true;
    }
    if hit(ui, &OPEN) {
        app.ask_path(Purpose::Open);
    }
    if hit(ui, &SAVE_AS) {
        app.ask_path(Purpose::SaveAs);
    }
    if hit(ui, &SAVE) {
        app.save();
    }
    // A text field undoes its own typing and moves its own cursor.
    if ui.ctx().text_edit_focused() {
        return;
    }
    if hit(ui, &REDO) || hit(ui, &REDO_TOO) {
        app.redo();
    }
    if hit(ui, &UNDO) {
        app.undo();
    }
    for (tab, key) in Tab::ALL.into_iter().zip(NUMBERS) {
        if hit(ui, &KeyboardShortcut::new(Modifiers::COMMAND, key)) {
            app.tabs.shown = tab;
        }
    }
    element(app, ui, hit);
    // What has the focus, such as a slider or a menu, has its own use for the arrows.
    if ui.ctx().memory(|memory| memory.focused().is_some()) || egui::Popup::is_any_open(ui.ctx()) {
        return;
    }
    let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    if pressed(Key::ArrowDown) {
        tree::step(app, true);
    }
    if pressed(Key::ArrowUp) {
        tree::step(app, false);
    }
    if pressed(Key::ArrowLeft) {
        tree::fold(app, true);
    }
    if pressed(Key::ArrowRight) {
        tree::fold(app, false);
    }
    if pressed(Key::Enter) {
        app.tree.open_menu = true;
    }
}

/// Moves and removes the element of a list that is selected.
fn element(app: &mut App, ui: &egui::Ui, hit: impl Fn(&egui::Ui, &KeyboardShortcut) -> bool) {
    let Some(row) = app.selected_row().cloned() else { return };
    let Kind::Element { list, index, of, .. } = &row.kind else { return };
    for (shortcut, up) in [(UP, true), (DOWN, false)] {
        let can = if up { *index > 0 } else { index + 1 < *of };
        if hit(ui, &shortcut) && can {
            app.edit("Move", |draft| draft.shift(&row.above, list, *index, up));
            let to = if up { index - 1 } else { index + 1 };
            app.selected = format!("{list}[{to}]");
        }
    }
    let is_focused = ui.ctx().memory(|memory| memory.focused().is_some());
    if !is_focused && ui.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Delete)) {
        app.edit(&format!("Remove {}", row.label), |draft| {
            draft.remove(&row.above, list, *index, false)
        });
    }
}
