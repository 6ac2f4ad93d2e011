//! What is wrong with the present scene, with the lines of the source.

use eframe::egui::{self, RichText, ScrollArea};

use crate::App;
use crate::app::Problem;

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        if app.problems.is_empty() {
            ui.label("Nothing is wrong.");
        }
        for problem in &app.problems {
            let text = match problem {
                Problem::Report(report) => report.render(),
                Problem::Other(what, message) => format!("{what}: {message}"),
            };
            ui.add(egui::Label::new(RichText::new(text).monospace()).extend().selectable(true));
        }
    });
}
