//! The explorer without a window.

use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::{Key, Modifiers, Role, Vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use egui_kittest::{Harness, Node};
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
    let scene = scenes::find(example).unwrap().scene().unwrap();
    start(Start::with(scene), size, scale)
}

/// A scene that is drawn in no time.
pub const SMALL: &str = r#"(
    camera: (eye: (0.0, 1.0, 5.0), target: (0.0, 0.0, 0.0), fov: 30.0),
    size: (64, 48), pass: "forward", display: "display",
    post: [(module: "tonemap", fill: {"exposure": (module: "manual", params: {"ev100": 9.0})})],
    meshes: {"ball": Sphere(radius: 1.0, segments: 24), "ground": Plane(size: (6.0, 6.0))},
    materials: {
        "shiny": {"material": (module: "metalness", params: {"base_color": (0.9, 0.2, 0.1), "roughness": 0.4}), "brdf": "microfacet"},
        "matt": {"material": "metalness", "brdf": "lambert"},
    },
    lights: [
        (name: "lamp", module: "point", fields: {"position": (2, 3, 2), "intensity": 1000.0, "color": "3000 K"}, visibility: "cube-map"),
        (name: "sky", module: "directional", fields: {"direction": (0, -1, 0), "illuminance": 300.0}),
    ],
    objects: [(name: "ball", mesh: "ball", material: "shiny"), (name: "ground", mesh: "ground", material: "matt", translate: (0, -1, 0))],
)"#;

/// The small scene.
pub fn small() -> SceneFile {
    SceneFile::parse("small", SMALL, Path::new("")).unwrap().with_files(scenes::files())
}

/// The explorer with the small scene.
pub fn open_small() -> Harness<'static, App> {
    start(Start::with(small()), [1280.0, 800.0], 1.0)
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
    button(harness, name).scroll_to_me();
    harness.run_steps(4);
    button(harness, name).click();
    harness.run_steps(3);
}

/// What has this name and can be clicked.
fn button<'h>(harness: &'h Harness<App>, name: &'h str) -> Node<'h> {
    let clickable = |node: &Node| CLICKABLE.contains(&node.accesskit_node().role());
    let mut found: Vec<_> = harness.query_all_by_label(name).filter(clickable).collect();
    match found.pop() {
        Some(node) if found.is_empty() => node,
        _ => panic!("not one {name:?} among {:#?}", names(harness)),
    }
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

/// What can be clicked.
pub const CLICKABLE: [Role; 5] = [Role::Button, Role::CheckBox, Role::ComboBox, Role::Link, Role::RadioButton];

/// The names of all that can be clicked.
pub fn names(harness: &Harness<App>) -> Vec<String> {
    let nodes = harness.get_all_by(|node| CLICKABLE.contains(&node.role()));
    nodes.filter_map(|node| node.accesskit_node().label()).collect()
}

/// The text that stands at a path of the scene.
pub fn said<'h>(harness: &'h Harness<App>, path: &str) -> Option<&'h str> {
    harness.state().document.scene().get(path)
}

/// Selects a row by its path.
pub fn select(harness: &mut Harness<App>, path: &str) {
    harness.state_mut().selected = path.to_owned();
    harness.run_steps(3);
}

/// Types a text into the field with this hint, in place of what is there.
pub fn fill(harness: &mut Harness<App>, hint: &str, text: &str) {
    field(harness, hint).focus();
    harness.run_steps(2);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(2);
    field(harness, hint).type_text(text);
    harness.run_steps(3);
}

/// The field with this hint.
pub fn field<'h>(harness: &'h Harness<App>, hint: &'h str) -> Node<'h> {
    harness.get_by(move |node| node.role() == Role::TextInput && node.data().placeholder() == Some(hint))
}
