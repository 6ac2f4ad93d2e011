//! The lines of a listing: only those that are seen are laid out.

use eframe::egui::text::LayoutJob;
use eframe::egui::{self, Color32, FontId, Rect, Role, ScrollArea, Sense, TextFormat, TextStyle, WidgetInfo, pos2, vec2};

use super::CodeState;
use super::lexer::{Token, pieces};
use crate::work::Listing;

/// Width of the column that says which module a line is from, characters.
const FROM: usize = 26;

/// Shows them; the line that was clicked.
pub(super) fn show(ui: &mut egui::Ui, state: &mut CodeState, listing: &Listing) -> Option<usize> {
    let font = TextStyle::Monospace.resolve(ui.style());
    let (height, letter) = (ui.text_style_height(&TextStyle::Monospace).ceil(), letter(ui, &font));
    let digits = listing.lines.len().max(1).ilog10() as usize + 1;
    let from = if listing.origins.is_empty() { 0 } else { FROM + 1 };
    let margin = (digits + 2 + from) as f32 * letter;
    ui.spacing_mut().item_spacing.y = 0.0;
    let mut area = ScrollArea::both().auto_shrink(false).id_salt("code");
    if let Some(line) = state.scroll_to.take() {
        // In the middle, with the beginning of the line.
        let middle = (ui.available_height() / 2.0 - height).max(0.0);
        area = area.scroll_offset(vec2(0.0, (line as f32 * height - middle).max(0.0)));
    }
    let mut clicked = None;
    area.show_rows(ui, height, listing.lines.len(), |ui, seen| {
        let width = (margin + (listing.width + 2) as f32 * letter).max(ui.available_width());
        let top = seen.start;
        for index in seen {
            let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::click());
            let text = listing.line(index);
            response
                .widget_info(|| WidgetInfo::selected(Role::Button, true, state.line == Some(index), format!("Line {}: {text}", index + 1)));
            if response.clicked() {
                clicked = Some(index);
            }
            let painter = ui.painter_at(rect);
            let visuals = ui.visuals();
            if state.line == Some(index) {
                painter.rect_filled(rect, 0.0, visuals.selection.bg_fill.gamma_multiply(0.5));
            } else if response.hovered() {
                painter.rect_filled(rect, 0.0, visuals.faint_bg_color);
            }
            let weak = visuals.weak_text_color();
            let number = format!("{:>digits$}", index + 1);
            let at = |columns: usize| rect.min + vec2(columns as f32 * letter, 0.0);
            painter.text(at(0), egui::Align2::LEFT_TOP, number, font.clone(), weak);
            if let Some(Some(origin)) = listing.origins.get(index) {
                let is_first = index == top || listing.origins[index - 1].as_ref().is_none_or(|before| before.item != origin.item);
                let module = if is_first { origin.item.module.as_str() } else { "" };
                let line = if origin.line > 0 { origin.line.to_string() } else { String::new() };
                let room = FROM - 5;
                let shown: String = module.chars().take(room).collect();
                painter.text(
                    at(digits + 1),
                    egui::Align2::LEFT_TOP,
                    format!("{shown:<room$}{line:>5}"),
                    font.clone(),
                    weak,
                );
            }
            let job = coloured(text, listing.lines[index].in_comment, &state.found_in(index), &font, visuals);
            let galley = painter.layout_job(job);
            painter.galley(pos2(rect.min.x + margin, rect.min.y), galley, visuals.text_color());
        }
        let seen = Rect::from_min_size(
            ui.min_rect().min + vec2(margin - 0.75 * letter, 0.0),
            vec2(0.0, ui.min_rect().height()),
        );
        ui.painter()
            .vline(seen.min.x, seen.y_range(), ui.visuals().widgets.noninteractive.bg_stroke);
    });
    clicked
}

fn letter(ui: &egui::Ui, font: &FontId) -> f32 {
    ui.fonts_mut(|fonts| fonts.glyph_width(font, '0'))
}

/// A line with the colours of its pieces, and of what was found in it.
fn coloured(text: &str, in_comment: bool, found: &[(std::ops::Range<usize>, bool)], font: &FontId, visuals: &egui::Visuals) -> LayoutJob {
    let mut job = LayoutJob::default();
    let mut append = |range: std::ops::Range<usize>, token: Token, ground: Color32| {
        let Some(piece) = text.get(range).filter(|piece| !piece.is_empty()) else {
            return;
        };
        let format = TextFormat {
            background: ground,
            ..TextFormat::simple(font.clone(), token.colour(visuals))
        };
        job.append(piece, 0.0, format);
    };
    let ground = |current: bool| {
        let warn = visuals.warn_fg_color;
        warn.gamma_multiply(if current { 0.55 } else { 0.25 })
    };
    for (range, token) in pieces(text, in_comment) {
        let mut at = range.start;
        for (hit, current) in found {
            let (start, end) = (hit.start.clamp(at, range.end), hit.end.clamp(at, range.end));
            if start < end {
                append(at..start, token, Color32::TRANSPARENT);
                append(start..end, token, ground(*current));
                at = end;
            }
        }
        append(at..range.end, token, Color32::TRANSPARENT);
    }
    job
}
