//! What pictures take: the passes on the GPU, and the way from a choice to its picture.

mod history;

use eframe::egui::{self, RichText, ScrollArea, WidgetInfo};
use egui_plot::{Corner, Legend, Line, Plot, PlotPoints};

use crate::App;
use crate::work::Measure;
use history::History;

pub use history::TimingState;

/// How often the present picture is drawn to measure it.
const TIMES: usize = 16;
/// Width of the table, points.
const TABLE: f32 = 490.0;

/// Shows them.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    ui.horizontal_wrapped(|ui| {
        let measuring = app.lanes.view.is_busy("measurement");
        let size = app.viewport.painted.as_ref().map(|painted| painted.frame.size);
        let again = ui.add_enabled(size.is_some() && !measuring, egui::Button::new(format!("Draw {TIMES} times")));
        again.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Measure the picture"));
        if again.on_hover_text("Draws the present picture again and again").clicked()
            && let Some(size) = size
        {
            let shot = app.shot();
            app.lanes.view.ask(Measure::new(shot, size, TIMES));
            app.tabs.timing.measured = Some(app.version);
        }
        let clear = ui.button("Clear");
        clear.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Clear the times"));
        if clear.clicked() {
            app.tabs.timing.clear();
        }
        let kind = if app.gpu.is_software() { ", software on the CPU" } else { "" };
        ui.label(format!("{}{kind}", app.gpu.name()));
        if let Some([width, height]) = size {
            ui.weak(format!("{width} x {height}"));
        }
    });
    let history = app.tabs.timing.history();
    if history.is_empty() {
        ui.weak("No picture yet.");
        return;
    }
    let width = TABLE.min(0.56 * ui.available_width());
    egui::Panel::left("times")
        .resizable(true)
        .default_size(width)
        .show(ui, |ui| table(ui, history, app.tabs.timing.has_passes()));
    plot(ui, history);
}

/// Last, median and spread of each part.
fn table(ui: &mut egui::Ui, history: &History, has_passes: bool) {
    ScrollArea::both().auto_shrink(false).id_salt("times").show(ui, |ui| {
        egui::Grid::new("times").num_columns(4).striped(true).show(ui, |ui| {
            for head in ["ms", "last", "median", "middle half"] {
                ui.strong(head);
            }
            ui.end_row();
            for (name, series) in history {
                ui.label(name);
                let Some(spread) = series.spread() else {
                    ui.end_row();
                    continue;
                };
                let cell = |ui: &mut egui::Ui, text: String| ui.label(RichText::new(text).monospace());
                cell(ui, format!("{:>8.2}", spread.last));
                cell(ui, format!("{:>8.2}", spread.median));
                cell(ui, format!("{:.2} to {:.2}", spread.quarter, spread.three_quarters));
                ui.end_row();
            }
        });
        if !has_passes {
            ui.weak("This device does not tell what its passes take.");
        }
    });
}

/// The passes over the last pictures.
fn plot(ui: &mut egui::Ui, history: &History) {
    let plot = Plot::new("passes over pictures")
        .legend(Legend::default().position(Corner::LeftTop))
        .x_axis_label("picture")
        .y_axis_label("ms")
        .include_y(0.0)
        .allow_scroll(false);
    let response = plot.show(ui, |plot| {
        for (name, series) in history.iter().filter(|(_, series)| series.is_plotted) {
            let points: PlotPoints = series.values().map(|(picture, ms)| [picture as f64, ms]).collect();
            plot.line(Line::new(name.clone(), points));
        }
    });
    response
        .response
        .widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, "Times of the last pictures"));
}
