//! What is on the screen.

mod bar;
mod keys;
mod parameters;
mod tabs;
mod tree;
mod viewport;

use eframe::egui;

use crate::App;

pub(crate) use tabs::save_code;

pub use tabs::{Tab, Tabs};
pub use tree::TreeState;
pub use viewport::{Camera, Viewport};

/// Shows everything.
pub(crate) fn show(app: &mut App, ui: &mut egui::Ui) {
    keys::take(app, ui);
    egui::Panel::top("bar").show(ui, |ui| bar::menus(app, ui));
    egui::Panel::bottom("status").show(ui, |ui| bar::status(app, ui));
    egui::Panel::bottom("tabs")
        .resizable(true)
        .default_size(240.0)
        .min_size(60.0)
        .show(ui, |ui| tabs::show(app, ui));
    egui::Panel::left("tree")
        .resizable(true)
        .default_size(300.0)
        .min_size(180.0)
        .show(ui, |ui| tree::show(app, ui));
    egui::Panel::right("parameters")
        .resizable(true)
        .default_size(290.0)
        .min_size(180.0)
        .show(ui, |ui| parameters::show(app, ui));
    egui::CentralPanel::default()
        .frame(egui::Frame::NONE)
        .show(ui, |ui| viewport::show(app, ui));
}
