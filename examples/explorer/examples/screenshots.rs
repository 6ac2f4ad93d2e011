//! The pictures of the explorer that the README shows: `cargo run -p explorer --example screenshots -- docs`. Needs no display.

#![allow(clippy::unwrap_used, reason = "ends where something is wrong")]

use std::path::Path;
use std::time::Duration;

use eframe::egui::{Theme, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use explorer::panels::Tab;
use explorer::{App, Start, scenes};

fn open(example: &str) -> Harness<'static, App> {
    let scene = scenes::find(example).unwrap().scene().unwrap();
    let mut explorer = Harness::builder()
        .with_size(Vec2::new(1440.0, 900.0))
        .wgpu_setup(explorer::setup())
        .build_eframe(|context| {
            let render_state = context.wgpu_render_state.clone().unwrap();
            App::new(&context.egui_ctx, render_state, Start::with(scene))
                .map_err(|report| report.render())
                .unwrap()
        });
    explorer.ctx.set_theme(Theme::Dark);
    settle(&mut explorer);
    explorer
}

/// Lets all work be done, and shows it.
fn settle(explorer: &mut Harness<App>) {
    loop {
        explorer.run_steps(3);
        let lanes = &explorer.state().lanes;
        if lanes.view.is_idle() && lanes.desk.is_idle() && lanes.long.is_idle() {
            explorer.run_steps(6);
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn click(explorer: &mut Harness<App>, name: &str) {
    explorer.get_by_label(name).scroll_to_me();
    explorer.run_steps(4);
    explorer.get_by_label(name).click();
    settle(explorer);
}

fn write(explorer: &mut Harness<App>, folder: &Path, name: &str) {
    explorer.remove_cursor();
    explorer.run_steps(3);
    explorer.render().unwrap().save(folder.join(name)).unwrap();
}

fn main() {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs".to_owned());
    let folder = Path::new(&folder);
    // A choice being made, with what is illegal there.
    let mut explorer = open("first");
    explorer.state_mut().selected = "materials.copper.material".to_owned();
    settle(&mut explorer);
    click(&mut explorer, "materials.copper.brdf.fill.ndf: ggx");
    write(&mut explorer, folder, "explorer.png");
    // How far a choice is from the truth, in the picture and among what else could stand there.
    let mut explorer = open("sun");
    explorer.state_mut().tabs.shown = Tab::Pareto;
    explorer.state_mut().selected = "lights[0].fill.disc".to_owned();
    click(&mut explorer, "lights[0].fill.disc: convolved-lobe");
    click(&mut explorer, "lights[0].fill.disc = widened-lobe");
    click(&mut explorer, "Show error");
    write(&mut explorer, folder, "explorer-error.png");
}
