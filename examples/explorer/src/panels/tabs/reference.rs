//! The scene's truth: whether it is drawn, and what stands in it for what.

use eframe::egui::{self, RichText, ScrollArea};

use crate::App;
use crate::compare::Other;

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        let mut is_on = app.compare.is_refining;
        let switch = ui.checkbox(&mut is_on, "Draw the reference in the background");
        if switch
            .on_hover_text("The same scene with what is true in each place; better with every step")
            .changed()
        {
            app.compare.is_refining = is_on;
        }
        if ui.button("Compare with the reference").clicked() {
            app.compare_with(Other::Reference);
        }
        if let Some(refined) = app.compare.refined.as_ref().filter(|_| app.compare.is_refining) {
            ui.label(format!("at 1/{}: {}", refined.divisor, refined.errors.summary));
        }
        if !app.compare.problem.is_empty() {
            ui.colored_label(ui.visuals().error_fg_color, &app.compare.problem);
        }
    });
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let Some((_, replaced, left)) = &app.compare.made else {
            ui.label("What is true is what the library's experiments hold the others against.");
            return;
        };
        if replaced.is_empty() {
            ui.label("Nothing in this scene approximates something that a module here is the truth of.");
        }
        egui::Grid::new("replaced").striped(true).num_columns(4).show(ui, |ui| {
            for entry in replaced {
                ui.monospace(&entry.path);
                ui.label(format!("{} instead of {}", entry.to, entry.from));
                ui.weak(format!("true by {}", entry.experiment));
                ui.end_row();
            }
            for entry in left {
                ui.monospace(&entry.path);
                ui.label(format!("{} stays", entry.module));
                let reason = format!("{} is true, but: {}", entry.truth, entry.reason);
                ui.label(RichText::new(reason).color(ui.visuals().warn_fg_color));
                ui.end_row();
            }
        });
    });
}
