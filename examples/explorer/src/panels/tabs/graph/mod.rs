//! The resolved tree of a recipe, drawn.

mod layout;
mod view;

use std::sync::Arc;

use eframe::egui::epaint::CubicBezierShape;
use eframe::egui::{self, Color32, FontId, Rect, Sense, Shape, Stroke, StrokeKind, WidgetInfo, pos2, vec2};

use super::inspect;
use crate::App;
use crate::tree::row_of;
use crate::work::{Inspected, Made};
use layout::{Drawing, HEIGHT, Node, layout};
use view::{LETTERS, View};

/// What the tab remembers.
#[derive(Default)]
pub struct GraphState {
    /// How it is seen; all of it where nobody has moved it.
    view: Option<View>,
    drawing: Drawing,
    /// Of what.
    of: Option<Arc<Inspected>>,
}

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let inspected = inspect::current(app);
    let Some(made) = inspect::made(ui, inspected.as_deref()) else {
        return;
    };
    let state = &mut app.tabs.graph;
    if !state
        .of
        .as_ref()
        .zip(inspected.as_ref())
        .is_some_and(|(of, now)| Arc::ptr_eq(of, now))
    {
        let font = FontId::proportional(LETTERS);
        let drawing = layout(&made.program, |text| {
            ui.fonts_mut(|fonts| text.chars().map(|letter| fonts.glyph_width(&font, letter)).sum())
        });
        if drawing.size != state.drawing.size {
            state.view = None;
        }
        state.drawing = drawing;
        state.of.clone_from(&inspected);
    }
    ui.horizontal_wrapped(|ui| {
        inspect::choices(app, ui, made, false);
        let fit = ui.button("Fit");
        fit.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Fit the graph"));
        if fit.on_hover_text("All of it. Drag to move, wheel to zoom").clicked() {
            app.tabs.graph.view = None;
        }
        ui.weak("dashed: by default, faint: nothing of it is in this pass");
    });
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, true, "Drawing of the graph"));
    let drawing = std::mem::take(&mut app.tabs.graph.drawing);
    // It is remembered from the corner of its place, which moves when the panel is made larger.
    let corner = rect.min.to_vec2();
    let before = app.tabs.graph.view.map(|view| view.shifted(corner));
    let before = before.unwrap_or_else(|| View::fit(drawing.size, rect));
    let view = before.moved(ui, &response);
    if view != before {
        app.tabs.graph.view = Some(view.shifted(-corner));
    }
    let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(rect));
    ui.set_clip_rect(rect.intersect(ui.clip_rect()));
    let clicked = boxes(app, ui, made, &drawing, view);
    app.tabs.graph.drawing = drawing;
    if let Some(place) = clicked {
        inspect::select(app, made, &place);
    }
}

/// Draws boxes and lines; the place whose box was clicked.
fn boxes(app: &App, ui: &mut egui::Ui, made: &Made, drawing: &Drawing, view: View) -> Option<String> {
    let colour = ui.visuals().widgets.noninteractive.fg_stroke.color.gamma_multiply(0.5);
    for node in &drawing.nodes {
        for &below in &node.below {
            ui.painter().add(edge(node, &drawing.nodes[below], view, Stroke::new(1.0, colour)));
        }
    }
    let mut clicked = None;
    for (index, node) in drawing.nodes.iter().enumerate() {
        let rect = Rect::from_min_size(pos2(node.x - node.width / 2.0, node.y), vec2(node.width, HEIGHT));
        let rect = Rect::from_min_max(view.at(rect.min), view.at(rect.max));
        let row = node
            .places
            .first()
            .and_then(|place| row_of(&app.rows, made.subject(), made.place(place)));
        let is_default = row.is_some_and(|row| !row.is_stated);
        let is_selected = row.is_some_and(|row| row.path == app.selected);
        let response = ui.interact(rect, ui.scope_id().with(("module", index)), Sense::click());
        let place = node.places.join(", ");
        response.widget_info(|| {
            let name = format!("Graph {place}: {}", node.module);
            WidgetInfo::selected(egui::Role::Button, true, is_selected, name)
        });
        paint(ui, node, rect, view, (is_default, is_selected, response.hovered()));
        let shared = if node.places.len() > 1 { "\nshared: linked once" } else { "" };
        let reached = if node.is_reached { "" } else { "\nnothing of it is in this pass" };
        let hover = format!("{}/{}\n{}{shared}{reached}", node.category, node.module, node.places.join("\n"));
        if response.on_hover_text(hover).clicked() {
            clicked = node.places.first().cloned();
        }
    }
    clicked
}

/// From a box to one below it.
fn edge(from: &Node, to: &Node, view: View, stroke: Stroke) -> Shape {
    let bottom = from.y + HEIGHT;
    if to.is_stacked {
        let (left, middle) = (to.x - to.width / 2.0, to.y + HEIGHT / 2.0);
        let rail = left - 6.0;
        let turn = bottom + 14.0;
        let points = [(from.x, bottom), (from.x, turn), (rail, turn), (rail, middle), (left, middle)];
        return Shape::line(points.map(|(x, y)| view.at(pos2(x, y))).to_vec(), stroke);
    }
    let bend = 0.5 * (to.y - bottom);
    let points = [(from.x, bottom), (from.x, bottom + bend), (to.x, to.y - bend), (to.x, to.y)];
    let points = points.map(|(x, y)| view.at(pos2(x, y)));
    CubicBezierShape::from_points_stroke(points, false, Color32::TRANSPARENT, stroke).into()
}

fn paint(ui: &egui::Ui, node: &Node, rect: Rect, view: View, (is_default, is_selected, is_hovered): (bool, bool, bool)) {
    let visuals = ui.visuals();
    let style = if is_hovered {
        &visuals.widgets.hovered
    } else {
        &visuals.widgets.inactive
    };
    let strength = if node.is_reached { 1.0 } else { 0.5 };
    let fill = if is_selected {
        visuals.selection.bg_fill
    } else {
        style.weak_bg_fill
    };
    let painter = ui.painter();
    painter.rect_filled(rect, 5.0, fill.gamma_multiply(strength));
    let stroke = Stroke::new(1.0, style.fg_stroke.color.gamma_multiply(0.6 * strength));
    if is_default {
        let corners = [
            rect.left_top(),
            rect.right_top(),
            rect.right_bottom(),
            rect.left_bottom(),
            rect.left_top(),
        ];
        painter.extend(Shape::dashed_line(&corners, stroke, 4.0, 3.0));
    } else {
        painter.rect_stroke(rect, 5.0, stroke, StrokeKind::Inside);
    }
    if node.places.len() > 1 {
        painter.rect_stroke(rect.expand(3.0), 7.0, stroke, StrokeKind::Inside);
    }
    let font = FontId::proportional(view.letters());
    let (weak, strong) = if is_selected {
        (visuals.selection.stroke.color, visuals.selection.stroke.color)
    } else {
        (visuals.weak_text_color(), visuals.strong_text_color())
    };
    let at = pos2(rect.min.x + 10.0 * view.scale, rect.center().y);
    let slot = node.slot();
    let mut after = at.x;
    if !slot.is_empty() {
        after = painter
            .text(
                at,
                egui::Align2::LEFT_CENTER,
                format!("{slot} "),
                font.clone(),
                weak.gamma_multiply(strength),
            )
            .max
            .x;
    }
    let name = painter.text(
        pos2(after, at.y),
        egui::Align2::LEFT_CENTER,
        &node.module,
        font.clone(),
        strong.gamma_multiply(strength),
    );
    if node.places.len() > 1 {
        let count = format!("  x{}", node.places.len());
        painter.text(pos2(name.max.x, at.y), egui::Align2::LEFT_CENTER, count, font, weak);
    }
}
