//! Words and the scale of colours over a picture.

use eframe::egui::{self, Align2, Color32, FontId, Label, Mesh, Pos2, Rect, RichText, Shape, Stroke, pos2, vec2};
use shadewright_report::write::colour;

use crate::compare::short;

/// Behind words, so that they can be read over any picture.
pub(super) const BEHIND: Color32 = Color32::from_black_alpha(180);
/// Bands of the scale: each is shaded evenly.
const BANDS: usize = 32;

/// A word at a place.
pub(super) fn note(ui: &egui::Ui, at: Pos2, align: Align2, text: &str) {
    let font = FontId::proportional(12.0);
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, Color32::WHITE);
    let rect = align.anchor_size(at, galley.size());
    ui.painter().rect_filled(rect.expand(3.0), 2.0, BEHIND);
    ui.painter().galley(rect.min, galley, Color32::WHITE);
}

/// A line at the upper edge, for readers of the screen, too.
pub(super) fn words(ui: &mut egui::Ui, rect: Rect, text: &str) {
    line(ui, Rect::from_min_size(rect.min, vec2(rect.width(), 22.0)), text);
}

/// A line of words in a place.
pub(super) fn line(ui: &mut egui::Ui, rect: Rect, text: &str) {
    ui.painter().rect_filled(rect, 0.0, BEHIND);
    let label = Label::new(RichText::new(text).color(Color32::WHITE).size(12.0)).truncate();
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect.shrink2(vec2(6.0, 3.0))));
    inside.add(label);
}

/// Colours and the errors that they mean.
pub(super) fn scale(ui: &egui::Ui, rect: Rect, full: f64) {
    let width = (rect.width() - 40.0).clamp(40.0, 220.0);
    let bar = Rect::from_min_size(pos2(rect.left() + 20.0, rect.bottom() - 34.0), vec2(width, 10.0));
    ui.painter()
        .rect_filled(bar.expand2(vec2(20.0, 6.0)).with_max_y(bar.bottom() + 24.0), 3.0, BEHIND);
    let mut mesh = Mesh::default();
    for band in 0..BANDS {
        let share = |edge: usize| edge as f32 / BANDS as f32;
        let corners = [
            pos2(bar.left() + share(band) * bar.width(), bar.top()),
            pos2(bar.left() + share(band + 1) * bar.width(), bar.bottom()),
        ];
        let error = (f64::from(share(band) + share(band + 1)) - 1.0) * full;
        let [r, g, b, _] = colour(error, full);
        mesh.add_colored_rect(Rect::from_two_pos(corners[0], corners[1]), Color32::from_rgb(r, g, b));
    }
    ui.painter().add(Shape::mesh(mesh));
    for at in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let x = bar.center().x + at as f32 * bar.width() / 2.0;
        ui.painter()
            .vline(x, bar.bottom()..=bar.bottom() + 3.0, Stroke::new(1.0, Color32::WHITE));
        let sign = if at > 0.0 { "+" } else { "" };
        let text = format!("{sign}{} %", short(100.0 * at * full));
        let font = FontId::proportional(10.0);
        // Half of them where there is no room.
        if width > 150.0 || at.abs() != 0.5 {
            ui.painter()
                .text(pos2(x, bar.bottom() + 4.0), Align2::CENTER_TOP, text, font, Color32::WHITE);
        }
    }
}
