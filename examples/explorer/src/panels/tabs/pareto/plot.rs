//! The plot: both axes logarithmic, what nothing else beats joined.

use std::sync::Arc;

use eframe::egui::{self, Align2, Color32, RichText, Vec2b};
use egui_plot::{GridMark, Line, MarkerShape, Plot, PlotPoint, Points, Text};

use super::{Cost, describe};
use crate::compare::{SweepView, frontier, short};
use crate::work::Alternative;

/// As near to a point as the mouse must be, points.
const NEAR: f32 = 14.0;

/// A point of the plot.
struct Dot<'s> {
    alternative: &'s Arc<Alternative>,
    /// Cost and error.
    value: [f64; 2],
    /// Logarithms of both.
    place: [f64; 2],
}

/// Shows it; gives what is clicked.
pub(super) fn show(ui: &mut egui::Ui, sweep: &SweepView, cost: Cost, height: f32) -> Option<Arc<Alternative>> {
    let dots = dots(sweep, cost);
    if dots.is_empty() {
        return None;
    }
    let values: Vec<[f64; 2]> = dots.iter().map(|dot| dot.value).collect();
    let best = frontier(&values);
    let lowest = dots.iter().map(|dot| dot.place[1]).fold(f64::INFINITY, f64::min);
    let has_zero = values.iter().any(|value| value[1] == 0.0);
    let unit = match cost {
        Cost::Time => "time, over the present choice's",
        Cost::Operations => "operations",
    };
    let (strong, weak) = (ui.visuals().strong_text_color(), ui.visuals().weak_text_color());
    let accent = ui.visuals().hyperlink_color;
    // Names stand beside their points: there is room for them.
    let (low, high) = range(dots.iter().map(|dot| dot.place[0]));
    let (bottom, top) = range(dots.iter().map(|dot| dot.place[1]));
    let margin = ((high - low) * 0.25).max(0.1);
    let plot = Plot::new("pareto")
        .height(height.max(80.0))
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .auto_bounds(Vec2b::TRUE)
        .include_x(low - margin * 0.3)
        .include_x(high + margin)
        .include_y(bottom - 0.05)
        .include_y(top + 0.05)
        .show_crosshair(false)
        .x_axis_label(unit)
        .y_axis_label("error, RMS %")
        .x_axis_formatter(move |mark, _| tick(mark))
        .y_axis_formatter(move |mark, _| {
            if has_zero && mark.value <= lowest + 0.5 {
                "0".to_owned()
            } else {
                tick(mark)
            }
        })
        .label_formatter(|_| None);
    let shown = plot.show(ui, |plot| {
        let line: Vec<[f64; 2]> = best.iter().map(|index| dots[*index].place).collect();
        plot.line(Line::new("worth their cost", line).color(accent).width(1.5));
        for (index, dot) in dots.iter().enumerate() {
            let colour = if best.contains(&index) { strong } else { weak };
            let is_present = dot.alternative.is_present;
            let shape = if is_present { MarkerShape::Diamond } else { MarkerShape::Circle };
            let points = Points::new(dot.alternative.name.clone(), vec![dot.place]);
            let fill = if is_present { accent } else { colour };
            plot.points(points.shape(shape).radius(if is_present { 6.0 } else { 4.0 }).color(fill));
            let name = RichText::new(format!("  {}", dot.alternative.name)).size(11.0).color(colour);
            let at = PlotPoint::from(dot.place);
            plot.text(
                Text::new(dot.alternative.name.clone(), at, name)
                    .anchor(Align2::LEFT_CENTER)
                    .color(colour),
            );
        }
        let mouse = plot.response().hover_pos()?;
        let distance = |dot: &Dot| plot.screen_from_plot(PlotPoint::from(dot.place)).distance(mouse);
        let near = dots.iter().filter(|dot| distance(dot) < NEAR);
        near.min_by(|a, b| distance(a).total_cmp(&distance(b)))
            .map(|dot| Arc::clone(dot.alternative))
    });
    let response = shown.response;
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Plot of error against cost"));
    let near = shown.inner?;
    let is_clicked = response.clicked();
    response
        .on_hover_cursor(egui::CursorIcon::PointingHand)
        .show_tooltip_text(RichText::new(describe(&near)).color(Color32::PLACEHOLDER));
    is_clicked.then_some(near)
}

/// The number at a mark, with as many digits as tell it from the next one.
fn tick(mark: GridMark) -> String {
    let value = 10f64.powf(mark.value);
    let step = value * (10f64.powf(mark.step_size.abs()) - 1.0);
    let digits = -step.log10().floor();
    if step < 0.01 * value && value < 1e6 && (0.0..=9.0).contains(&digits) {
        format!("{value:.0$}", digits as usize)
    } else {
        short(value)
    }
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// The alternatives that have an error and a cost. What is 0 has no logarithm: it stands a decade below the others.
fn dots(sweep: &SweepView, cost: Cost) -> Vec<Dot<'_>> {
    let known = sweep.alternatives.iter().filter_map(|alternative| {
        let measured = alternative.outcome.as_ref().ok()?;
        let value = [cost.of(alternative)?, 100.0 * measured.rms];
        value.iter().all(|x| x.is_finite()).then_some((alternative, value))
    });
    let known: Vec<_> = known.collect();
    let floor = |axis: usize| {
        let above = known.iter().map(|(_, value)| value[axis]).filter(|x| *x > 0.0);
        let least = above.fold(f64::INFINITY, f64::min);
        if least.is_finite() { least / 10.0 } else { 0.1 }
    };
    let floors = [floor(0), floor(1)];
    let dot = |(alternative, value)| Dot {
        alternative,
        value,
        place: [0, 1].map(|axis| value[axis].max(floors[axis]).log10()),
    };
    known.iter().copied().map(dot).collect()
}
