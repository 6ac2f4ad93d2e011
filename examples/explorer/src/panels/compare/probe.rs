//! Values under the mouse.

use eframe::egui::{self, Pos2, Rect, vec2};

use super::legend;
use crate::App;
use crate::compare::{Mode, Other, describe, short};

/// Height of a line, points.
const LINE: f32 = 20.0;

/// Shows them at the lower edge.
pub(super) fn show(app: &App, ui: &mut egui::Ui, rect: Rect) {
    let Some(at) = ui.input(|input| input.pointer.hover_pos()).filter(|at| rect.contains(*at)) else {
        return;
    };
    let lines = lines(app, share(rect, at), at.x > rect.left() + app.compare.split * rect.width());
    // Where the scale of colours is not.
    let lift = if matches!(app.compare.mode, Mode::Difference | Mode::Error) {
        46.0
    } else {
        0.0
    };
    let top = rect.bottom() - lift - LINE * lines.len() as f32;
    for (index, text) in lines.iter().enumerate() {
        let at = egui::pos2(rect.left(), top + LINE * index as f32);
        legend::line(ui, Rect::from_min_size(at, vec2(rect.width(), LINE)), text);
    }
}

fn share(rect: Rect, at: Pos2) -> [f32; 2] {
    let at = (at - rect.min) / rect.size();
    [at.x, at.y]
}

/// What is known of a place. In a split picture that of its side comes first.
fn lines(app: &App, at: [f32; 2], is_right: bool) -> Vec<String> {
    let compare = &app.compare;
    let beside = compare.beside.as_ref();
    let present = app.viewport.painted.as_ref().map(|painted| (painted.version, painted.frame.size));
    let first = beside
        .filter(|beside| Some(beside.first) == present)
        .and_then(|beside| beside.first_values.as_ref());
    let mut lines = vec![match first.and_then(|values| values.at(at)) {
        Some(texel) => format!("present: {}", describe(&texel)),
        None => "present: being read".to_owned(),
    }];
    let has_other = compare.mode != Mode::Alone || compare.refined.is_some();
    if has_other {
        let of_truth = compare.mode == Mode::Error || compare.mode == Mode::Alone || compare.other == Other::Reference;
        let (values, errors, name) = if of_truth {
            let refined = compare.refined.as_ref().filter(|refined| refined.version == app.version);
            (
                refined.map(|refined| &refined.values),
                refined.map(|refined| &refined.errors),
                "reference".to_owned(),
            )
        } else {
            let second = beside.and_then(|beside| beside.second_values.as_ref());
            (second, beside.and_then(|beside| beside.errors.as_ref()), compare.other_name())
        };
        if let Some(texel) = values.and_then(|values| values.at(at)) {
            let line = format!("{name}: {}", describe(&texel));
            let place = if compare.mode == Mode::Split && is_right { 0 } else { 1 };
            lines.insert(place, line);
        }
        if let Some(error) = errors.and_then(|errors| errors.at(at)) {
            lines.push(format!("error against {name}: {} %", short(100.0 * error)));
        }
    }
    lines
}
