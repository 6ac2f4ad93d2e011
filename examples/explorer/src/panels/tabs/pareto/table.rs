//! The same numbers as a table, the cheapest first.

use std::sync::Arc;

use eframe::egui::{self, Button, RichText, ScrollArea};

use super::{Cost, describe};
use crate::compare::{SweepView, short};
use crate::work::Alternative;

/// Shows it; gives what is clicked.
pub(super) fn show(ui: &mut egui::Ui, sweep: &SweepView) -> Option<Arc<Alternative>> {
    let mut all: Vec<&Arc<Alternative>> = sweep.alternatives.iter().collect();
    let cost = |alternative: &Alternative| {
        let cost = Cost::Time.of(alternative).or(Cost::Operations.of(alternative));
        cost.unwrap_or(f64::INFINITY)
    };
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    let mut clicked = None;
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        egui::Grid::new("alternatives").striped(true).num_columns(5).show(ui, |ui| {
            for heading in ["", "error RMS", "time", "operations", "report"] {
                ui.weak(heading);
            }
            ui.end_row();
            for alternative in all {
                if line(ui, sweep, alternative) {
                    clicked = Some(Arc::clone(alternative));
                }
                ui.end_row();
            }
        });
    });
    clicked
}

/// An alternative's line; whether it is clicked.
fn line(ui: &mut egui::Ui, sweep: &SweepView, alternative: &Alternative) -> bool {
    let is_legal = alternative.outcome.is_ok();
    let button = ui.add_enabled(is_legal, Button::selectable(alternative.is_present, &alternative.name));
    let name = format!("Choose {} for {}", alternative.name, sweep.path);
    button.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, is_legal, alternative.is_present, &name));
    let about = describe(alternative);
    let is_clicked = button.on_hover_text(&about).on_disabled_hover_text(&about).clicked();
    match &alternative.outcome {
        Ok(measured) => {
            ui.label(format!("{} %", short(100.0 * measured.rms)));
            ui.label(measured.ratio.map_or("–".to_owned(), |ratio| format!("{ratio:.2}×")));
            ui.label(format!("{}", measured.operations));
        }
        Err(reason) => {
            ui.label(RichText::new("not legal").weak()).on_hover_text(reason);
            ui.label("");
            ui.label("");
        }
    }
    let stored = alternative.stored.first();
    ui.label(stored.map_or("–".to_owned(), |(experiment, error)| format!("{} ({experiment})", short(*error))));
    is_clicked
}
