//! The picture: turned, moved, zoomed, and asked what is where.

mod camera;
mod pick;

use std::sync::Arc;

use eframe::egui::{self, Color32, PointerButton, Rect, Sense, TextureId, Vec2 as Size, pos2};
use eframe::egui_wgpu::RenderState;
use eframe::wgpu;
use glam::Vec2;
use shadewright_runtime::frame::Frame;

use crate::App;
use crate::document::ron_of;
use crate::work::Painted;

pub use camera::Camera;

/// While something moves, a picture takes at most about this long, ms: it is made smaller until it does.
const BRISK: f64 = 60.0;
/// Smallest side of a picture that is drawn, pixels.
const SMALLEST: u32 = 16;

/// The picture and what it was made of.
#[derive(Default)]
pub struct Viewport {
    /// The last one.
    pub painted: Option<Painted>,
    /// Where it is on the screen, points.
    pub rect: Option<Rect>,
    texture: Option<TextureId>,
    /// Pixels of the place on the screen.
    pixels: [u32; 2],
    /// What was asked for last.
    asked: Option<(u64, [u32; 2])>,
    /// Nanoseconds a pixel, of the last picture.
    pace: f64,
}

impl Viewport {
    /// The version and size that are to be asked for, where they are not those of the last asking. `moving`: soon there will be another.
    pub fn wants(&mut self, version: u64, moving: bool) -> Option<[u32; 2]> {
        let [width, height] = self.pixels;
        if width < SMALLEST || height < SMALLEST {
            return None;
        }
        let all = f64::from(width) * f64::from(height);
        let affordable = BRISK * 1e6 / self.pace.max(1e-3);
        let shrink = if moving {
            (all / affordable).sqrt().clamp(1.0, 4.0).round()
        } else {
            1.0
        };
        let size = [width, height].map(|side| ((f64::from(side) / shrink) as u32).max(SMALLEST));
        if self.asked == Some((version, size)) {
            return None;
        }
        self.asked = Some((version, size));
        Some(size)
    }

    /// Width and height of the place on the screen in pixels, where there is one that can be drawn into.
    pub fn full_size(&self) -> Option<[u32; 2]> {
        Some(self.pixels).filter(|pixels| pixels.iter().all(|side| *side >= SMALLEST))
    }

    /// Shows a picture.
    pub fn show(&mut self, render: &RenderState, painted: Painted) {
        let Some(display) = &painted.targets.display else {
            return;
        };
        let pixels = f64::from(display.width()) * f64::from(display.height());
        self.pace = painted.times.all.as_secs_f64() * 1e9 / pixels;
        let view = display.create_view(&wgpu::TextureViewDescriptor::default());
        let mut renderer = render.renderer.write();
        match self.texture {
            Some(id) => renderer.update_egui_texture_from_wgpu_texture(&render.device, &view, wgpu::FilterMode::Linear, id),
            None => self.texture = Some(renderer.register_native_texture(&render.device, &view, wgpu::FilterMode::Linear)),
        }
        self.painted = Some(painted);
    }

    /// What is shown belongs to another scene.
    pub fn forget(&mut self) {
        self.asked = None;
    }

    /// What the picture shows.
    pub fn frame(&self) -> Option<&Arc<Frame>> {
        self.painted.as_ref().map(|painted| &painted.frame)
    }
}

/// Shows it, and takes what the mouse does to it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let size = ui.available_size().max(Size::splat(1.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, "Viewport"));
    let scale = ui.ctx().pixels_per_point();
    app.viewport.pixels = [size.x, size.y].map(|points| (points * scale).round().clamp(0.0, 8192.0) as u32);
    app.viewport.rect = Some(rect);
    ui.painter().rect_filled(rect, 0.0, Color32::from_gray(24));
    if let (Some(id), Some(_)) = (app.viewport.texture, &app.viewport.painted) {
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        ui.painter().image(id, rect, uv, Color32::WHITE);
    } else {
        ui.painter().text(
            rect.center(),
            egui::Align2::CENTER_CENTER,
            "Drawing the first picture",
            egui::FontId::proportional(16.0),
            Color32::GRAY,
        );
    }
    steer(app, ui, &response, rect);
    super::compare::overlay(app, ui, rect);
}

/// The camera by mouse and wheel; a click selects what is there.
fn steer(app: &mut App, ui: &egui::Ui, response: &egui::Response, rect: Rect) {
    let Some(frame) = app.viewport.frame().map(Arc::clone) else {
        return;
    };
    if response.clicked()
        && let Some(at) = response.interact_pointer_pos()
    {
        let at = (at - rect.min) / rect.size();
        pick::select(app, &frame, Vec2::new(at.x, at.y));
        return;
    }
    let shift = ui.input(|input| input.modifiers.shift);
    let by = response.drag_delta() / rect.height();
    let by = Vec2::new(by.x, by.y);
    let wheel = if response.hovered() {
        ui.input(|input| input.smooth_scroll_delta().y)
    } else {
        0.0
    };
    if by == Vec2::ZERO && wheel == 0.0 {
        return;
    }
    let mut camera = Camera::of(app.document.scene().scene(), &frame);
    if response.dragged_by(PointerButton::Primary) && !shift {
        camera.orbit(by);
    } else if by != Vec2::ZERO {
        camera.pan(by);
    }
    camera.zoom(wheel / 400.0);
    move_to(app, &camera);
}

/// Puts the camera there.
pub(crate) fn move_to(app: &mut App, camera: &Camera) {
    let text = ron_of(&camera.decl);
    app.continued("Camera", |draft| draft.set(&[], "camera", &text));
}
