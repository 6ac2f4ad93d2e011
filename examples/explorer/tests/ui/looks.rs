//! How it looks: light and dark, at two scales, in a narrow window.

use eframe::egui::Theme;
use egui_kittest::SnapshotResults;

use crate::harness::{open_sized, settle};

/// Catches a part that is cut off, laid over another, or cannot be read on its ground.
#[test]
fn it_looks_right() {
    let mut results = SnapshotResults::new();
    for (name, size, scale, theme) in [
        ("dark", [1280.0, 800.0], 1.0, Theme::Dark),
        ("light", [1280.0, 800.0], 1.0, Theme::Light),
        ("twice", [1000.0, 640.0], 2.0, Theme::Dark),
        ("narrow", [820.0, 560.0], 1.0, Theme::Light),
    ] {
        let mut explorer = open_sized("sphere", size, scale);
        explorer.ctx.set_theme(theme);
        settle(&mut explorer);
        explorer.run_steps(4);
        results.add(explorer.try_snapshot(name));
    }
}
