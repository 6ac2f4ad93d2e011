//! The linked code of a recipe: searched, copied, saved, and asked where its lines come from.

mod lexer;
mod lines;
mod origin;

use std::ops::Range;
use std::sync::Arc;

use eframe::egui::{self, Button, Key, KeyboardShortcut, Modifiers, TextEdit, WidgetInfo};

use super::inspect;
use crate::App;
use crate::files::Purpose;
use crate::work::{Inspected, Listing, Made};

const FIND: KeyboardShortcut = KeyboardShortcut::new(Modifiers::COMMAND, Key::G);
const NEXT: KeyboardShortcut = KeyboardShortcut::new(Modifiers::NONE, Key::F3);
const BEFORE: KeyboardShortcut = KeyboardShortcut::new(Modifiers::SHIFT, Key::F3);

/// What the tab remembers.
#[derive(Default)]
pub struct CodeState {
    /// What is searched for.
    pub search: String,
    /// Where it stands: line, and bytes of it.
    pub found: Vec<(usize, Range<usize>)>,
    /// Which of these was gone to last.
    pub current: usize,
    /// The line that is asked about.
    pub line: Option<usize>,
    /// Is scrolled to with the next frame.
    pub scroll_to: Option<usize>,
    /// What was searched, and for what.
    searched: Option<(Arc<Inspected>, String)>,
}

impl CodeState {
    /// What was found in a line, and whether it is the present one.
    fn found_in(&self, line: usize) -> Vec<(Range<usize>, bool)> {
        let first = self.found.partition_point(|(at, _)| *at < line);
        let here = self.found.iter().enumerate().skip(first).take_while(|(_, (at, _))| *at == line);
        here.map(|(index, (_, range))| (range.clone(), index == self.current)).collect()
    }

    /// Searches again where the text or what is searched for is another.
    fn search(&mut self, inspected: &Arc<Inspected>, listing: &Listing) {
        let is_known = self
            .searched
            .as_ref()
            .is_some_and(|(text, search)| Arc::ptr_eq(text, inspected) && *search == self.search);
        if is_known {
            return;
        }
        let typed = self.searched.as_ref().is_some_and(|(_, search)| *search != self.search);
        self.found = listing.find(&self.search);
        self.searched = Some((Arc::clone(inspected), self.search.clone()));
        self.current = self.current.min(self.found.len().saturating_sub(1));
        if typed {
            self.current = 0;
            self.scroll_to = self.found.first().map(|(line, _)| *line);
        }
        self.line = self.line.filter(|line| *line < listing.lines.len());
    }

    /// Goes to the next or the one before, from the last on to the first.
    fn go(&mut self, back: bool) {
        let count = self.found.len();
        if count == 0 {
            return;
        }
        self.current = (self.current + if back { count - 1 } else { 1 }) % count;
        self.scroll_to = Some(self.found[self.current].0);
    }
}

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let inspected = inspect::current(app);
    let Some(made) = inspect::made(ui, inspected.as_deref()) else {
        return;
    };
    let Some(inspected) = inspected.as_ref() else { return };
    ui.horizontal_wrapped(|ui| {
        inspect::choices(app, ui, made, true);
        if let Ok(listing) = &made.listing {
            app.tabs.code.search(inspected, listing);
            find(&mut app.tabs.code, ui);
            keep(app, ui, made, listing);
        }
    });
    match &made.listing {
        Err(report) => super::problems::report(ui, report),
        Ok(listing) => {
            if app.tabs.code.line.is_some() && !listing.origins.is_empty() {
                egui::Panel::right("origin")
                    .resizable(true)
                    .default_size(300.0)
                    .show(ui, |ui| origin::show(app, ui, made, listing));
            }
            if let Some(line) = lines::show(ui, &mut app.tabs.code, listing) {
                app.tabs.code.line = Some(line);
                origin::select(app, made, listing, line);
            }
        }
    }
}

/// The search.
fn find(state: &mut CodeState, ui: &mut egui::Ui) {
    let hit = |ui: &egui::Ui, shortcut: &KeyboardShortcut| ui.input_mut(|input| input.consume_shortcut(shortcut));
    let focus = hit(ui, &FIND);
    let (before, next) = (hit(ui, &BEFORE), hit(ui, &NEXT));
    let field = ui.add(
        TextEdit::singleline(&mut state.search)
            .hint_text("Find in the code")
            .desired_width(130.0),
    );
    field.widget_info(|| WidgetInfo::labeled(egui::Role::TextInput, true, "Find in the code"));
    let field = field.on_hover_text("Ctrl+G; F3 and Shift+F3 go on");
    if focus {
        field.request_focus();
    }
    let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    if entered {
        field.request_focus();
    }
    let back = entered && ui.input(|input| input.modifiers.shift);
    let any = !state.found.is_empty();
    let is_before = arrow(ui, "⏶", "Previous match", any);
    let is_next = arrow(ui, "⏷", "Next match", any);
    if is_before || before || back {
        state.go(true);
    } else if is_next || next || entered {
        state.go(false);
    }
    if !state.search.is_empty() {
        let number = if any { state.current + 1 } else { 0 };
        ui.label(format!("{number} of {}", state.found.len()));
    }
}

fn arrow(ui: &mut egui::Ui, sign: &str, name: &str, enabled: bool) -> bool {
    let response = ui.add_enabled(enabled, Button::new(sign).small());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, enabled, name));
    response.on_hover_text(name).clicked()
}

/// Copying and saving.
fn keep(app: &mut App, ui: &mut egui::Ui, made: &Made, listing: &Listing) {
    let copy = ui.button("Copy");
    copy.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Copy the code"));
    if copy.on_hover_text("Copies all of it").clicked() {
        ui.ctx().copy_text(listing.text.clone());
        app.message = format!("copied {} lines", listing.lines.len());
    }
    let save = ui.button("Save...");
    save.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Save the code"));
    if save.clicked() {
        let view = &made.view;
        let entry = if view.language.takes_entry() {
            format!(".{}", view.entry)
        } else {
            String::new()
        };
        let name = format!("{}.{}{entry}.{}", made.subject().name, view.pass, view.language.ending());
        app.ask_path_named(Purpose::Code, &name);
    }
}

/// Writes the code that is shown to a file.
pub(crate) fn save(app: &mut App, path: &str) {
    let shown = app.tabs.inspect.shown.clone();
    let made = shown.as_ref().and_then(|inspected| inspected.made.as_ref().ok());
    let Some(Ok(listing)) = made.map(|made| &made.listing) else {
        "there is no code".clone_into(&mut app.message);
        return;
    };
    let bytes = listing.bytes.as_deref().unwrap_or(listing.text.as_bytes());
    app.message = match crate::files::save(path, bytes) {
        Ok(place) => format!("saved {place}"),
        Err(why) => format!("the code is not saved: {why}"),
    };
}
