//! How the drawing is seen: moved and zoomed.

use eframe::egui::{self, Pos2, Rect, Response, Vec2, vec2};

/// Text in the boxes, points, as large as it is drawn.
pub const LETTERS: f32 = 13.0;
/// Around all boxes.
const MARGIN: f32 = 10.0;
/// Smallest and largest scale.
const SCALES: (f32, f32) = (0.2, 3.0);

/// From the drawing to the screen. Text is drawn in its size and not scaled: thin strokes would get lost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// Where the drawing's corner is on the screen.
    pub corner: Pos2,
    /// Points of the screen for one of the drawing.
    pub scale: f32,
}

impl View {
    /// All of it, in the middle, not larger than it is.
    pub fn fit(size: [f32; 2], rect: Rect) -> Self {
        let room = (rect.size() - Vec2::splat(2.0 * MARGIN)).max(Vec2::splat(1.0));
        let scale = (room.x / size[0].max(1.0)).min(room.y / size[1].max(1.0)).clamp(SCALES.0, 1.0);
        Self {
            corner: rect.center() - 0.5 * scale * vec2(size[0], size[1]),
            scale,
        }
    }

    /// The same, elsewhere.
    pub fn shifted(self, by: Vec2) -> Self {
        Self {
            corner: self.corner + by,
            ..self
        }
    }

    /// Where a point of the drawing is.
    pub fn at(&self, point: Pos2) -> Pos2 {
        self.corner + self.scale * point.to_vec2()
    }

    /// Size of the text, in steps: each size is a set of letters of its own.
    pub fn letters(&self) -> f32 {
        (2.0 * LETTERS * self.scale).round().max(6.0) / 2.0
    }

    /// After what the mouse does.
    pub fn moved(self, ui: &egui::Ui, response: &Response) -> Self {
        let moved = Self {
            corner: self.corner + response.drag_delta(),
            ..self
        };
        let Some(pointer) = response.ctx.pointer_hover_pos().filter(|at| response.interact_rect.contains(*at)) else {
            return moved;
        };
        if !ui.rect_contains_pointer(response.rect) {
            return moved;
        }
        let (wheel, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        moved.zoomed((wheel / 300.0).exp() * pinch, pointer)
    }

    /// Zoomed around a point of the screen.
    fn zoomed(self, factor: f32, around: Pos2) -> Self {
        let scale = (self.scale * factor).clamp(SCALES.0, SCALES.1);
        Self {
            corner: around + scale / self.scale * (self.corner - around),
            scale,
        }
    }
}

#[cfg(test)]
mod tests {
    use eframe::egui::pos2;

    use super::*;

    /// Catches a drawing that is cut off, a zoom that carries away what is under the mouse, and one without end.
    #[test]
    fn all_is_seen_and_the_mouse_keeps_its_place() {
        let rect = Rect::from_min_size(pos2(100.0, 50.0), vec2(400.0, 100.0));
        for size in [[1000.0, 90.0], [50.0, 300.0], [10.0, 10.0]] {
            let view = View::fit(size, rect);
            assert!(
                rect.contains(view.at(pos2(0.0, 0.0))) && rect.contains(view.at(pos2(size[0], size[1]))),
                "{view:?}"
            );
        }
        let view = View::fit([1000.0, 90.0], rect);
        let zoomed = view.zoomed(2.0, view.at(pos2(30.0, 40.0)));
        assert!(zoomed.at(pos2(30.0, 40.0)).distance(view.at(pos2(30.0, 40.0))) < 1e-3);
        assert_eq!(zoomed.zoomed(1e9, rect.min).scale, SCALES.1);
        assert_eq!(zoomed.zoomed(0.0, rect.min).scale, SCALES.0);
    }
}
