//! The explorer without a window.

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{Role, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use explorer::document::Document;
use explorer::{App, Start, scenes};
use shadewright_runtime::scene::SceneFile;

/// Longest that anything takes, the first picture on a busy machine included.
const PATIENCE: Duration = Duration::from_secs(120);

/// The explorer with one of its scenes, drawn once.
pub fn open(example: &str) -> Harness<'static, App> {
    open_sized(example, [1280.0, 800.0], 1.0)
}

/// The same in a window of another size, points, at so many pixels a point.
pub fn open_sized(example: &str, size: [f32; 2], scale: f32) -> Harness<'static, App> {
    let example = scenes::find(example).unwrap();
    let scene = SceneFile::parse(example.name, example.text, Path::new("../scenes")).unwrap();
    start(
        Start {
            document: Document::new(scene),
            library: shadewright_modules::library(),
        },
        size,
        scale,
    )
}

/// The explorer as it starts.
pub fn start(start: Start, size: [f32; 2], scale: f32) -> Harness<'static, App> {
    let mut harness = Harness::builder()
        .with_size(Vec2::from(size))
        .with_pixels_per_point(scale)
        .with_max_steps(200)
        .wgpu_setup(explorer::setup())
        .build_eframe(|context| {
            let render_state = context.wgpu_render_state.clone().unwrap();
            App::new(&context.egui_ctx, render_state, start)
                .map_err(|report| report.render())
                .unwrap()
        });
    settle(&mut harness);
    harness
}

/// Lets the lanes do all that there is to do, and shows it.
pub fn settle(harness: &mut Harness<App>) {
    let start = Instant::now();
    harness.run_steps(2);
    let mut was_idle = false;
    loop {
        let app = harness.state();
        let is_idle = app.lanes.view.is_idle() && app.lanes.desk.is_idle() && app.lanes.long.is_idle();
        harness.run_steps(2);
        // What was told last may have been answered by asking for more.
        if is_idle && was_idle {
            return;
        }
        was_idle = is_idle;
        assert!(start.elapsed() < PATIENCE, "it does not settle");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Clicks what has this name.
pub fn click(harness: &mut Harness<App>, name: &str) {
    let Some(node) = harness.query_by_label(name) else {
        panic!("there is no {name:?}, but {:#?}", names(harness));
    };
    node.click();
    harness.run_steps(3);
}

/// Mean of the picture's pixels, 0 to 1 for red, green and blue.
pub fn mean(harness: &Harness<App>) -> [f64; 3] {
    let app = harness.state();
    let painted = app.viewport.painted.as_ref().unwrap();
    let pixels = painted.targets.read_display(&app.gpu).unwrap().unwrap();
    let (texels, _) = pixels.as_chunks::<4>();
    let sum = |channel: usize| texels.iter().map(|t| f64::from(t[channel]) / 255.0).sum::<f64>();
    [0, 1, 2].map(|channel| sum(channel) / texels.len() as f64)
}

/// The names of all that can be clicked.
pub fn names(harness: &Harness<App>) -> Vec<String> {
    let nodes = harness.get_all_by(|node| {
        matches!(
            node.role(),
            Role::Button | Role::CheckBox | Role::Slider | Role::SpinButton | Role::TextInput
        )
    });
    nodes.filter_map(|node| node.accesskit_node().label()).collect()
}
