//! Error against cost of all that could stand in the selected slot: a plot, and the same as a table.

mod plot;
mod table;

use std::sync::Arc;

use eframe::egui;

use crate::App;
use crate::compare::{SweepView, short};
use crate::work::{Alternative, Change};

/// What a plot's cost is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// Time on the GPU, over the present choice's.
    #[default]
    Time,
    /// Operations.
    Operations,
}

impl Cost {
    fn of(self, alternative: &Alternative) -> Option<f64> {
        let measured = alternative.outcome.as_ref().ok()?;
        match self {
            Self::Time => measured.ratio,
            Self::Operations => Some(measured.operations),
        }
    }
}

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let Some(sweep) = heading(app, ui) else { return };
    let mut chosen = None;
    // Some devices do not say what a pass takes, and no page does.
    let is_timed = sweep.alternatives.iter().any(|alternative| Cost::Time.of(alternative).is_some());
    let height = ui.available_height();
    let width = ui.available_width();
    ui.horizontal_top(|ui| {
        ui.vertical(|ui| {
            ui.set_width(width * 0.5);
            ui.horizontal(|ui| {
                ui.label("cost:");
                let wanted = &mut app.tabs.cost;
                ui.add_enabled_ui(is_timed, |ui| {
                    ui.radio_value(wanted, Cost::Time, "time")
                        .on_hover_text("Scene pass on the GPU, over the present choice's")
                        .on_disabled_hover_text("This device does not say what a pass takes");
                });
                ui.radio_value(wanted, Cost::Operations, "operations")
                    .on_hover_text("Weighted operations of all programs for a pixel, loops' bodies once");
            });
            let cost = if is_timed { app.tabs.cost } else { Cost::Operations };
            chosen = plot::show(ui, &sweep, cost, height - 30.0);
        });
        ui.vertical(|ui| {
            chosen = table::show(ui, &sweep).or(chosen.take());
        });
    });
    if let Some(alternative) = chosen {
        choose(app, &sweep, &alternative);
    }
}

/// Says what is compared; gives the alternatives of the selected slot as far as they are known.
pub(super) fn heading(app: &App, ui: &mut egui::Ui) -> Option<SweepView> {
    let Some(row) = app.selected_row().filter(|row| row.is_choice()) else {
        ui.label("Select a slot in the tree: this shows all that could stand there.");
        return None;
    };
    if !app.compare.problem.is_empty() {
        ui.colored_label(ui.visuals().error_fg_color, &app.compare.problem);
    }
    let sweep = app.compare.sweep.as_ref().filter(|sweep| sweep.path == row.path);
    let Some(sweep) = sweep else {
        ui.label(format!("Drawing what could stand in {}", row.path));
        return None;
    };
    let cut = if sweep.cut > 0 {
        format!(". {} more are not drawn", sweep.cut)
    } else {
        String::new()
    };
    let done = sweep.alternatives.len();
    let progress = if done < sweep.of {
        format!(" ({done} of {})", sweep.of)
    } else {
        String::new()
    };
    ui.add(egui::Label::new(format!("{}{progress}: error against {}{cut}", sweep.path, sweep.against)).truncate());
    Some(sweep.clone())
}

/// Puts an alternative into its slot.
pub(super) fn choose(app: &mut App, sweep: &SweepView, alternative: &Alternative) {
    let Some(row) = app.rows.iter().find(|row| row.path == sweep.path).cloned() else {
        return;
    };
    let catalog = Arc::clone(&app.catalog);
    let change: &Change = &alternative.change;
    app.edit(&format!("Choose {} for {}", alternative.name, sweep.path), |draft| {
        change.put(draft, &catalog, &row)
    });
}

/// All that is known of an alternative.
pub(super) fn describe(alternative: &Alternative) -> String {
    let mut lines = vec![alternative.name.clone()];
    match &alternative.outcome {
        Ok(measured) => {
            lines.push(measured.summary.clone());
            if let Some(ratio) = measured.ratio {
                lines.push(format!("time {} of the present choice's", short(ratio)));
            }
            lines.push(format!("{} operations", short(measured.operations)));
        }
        Err(reason) => lines.push(reason.clone()),
    }
    for (experiment, error) in &alternative.stored {
        lines.push(format!("report, {experiment}: model error {}", short(*error)));
    }
    lines.join("\n")
}
