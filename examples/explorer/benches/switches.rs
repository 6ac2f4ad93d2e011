//! What a person waits for: from a choice to its picture, from the start to the first one, and what memory does over a thousand choices.
//!
//! `cargo bench -p explorer` prints a page; `-- --write FILE` (from the workspace's root) puts it there as well, `-- --scene NAME` takes other examples, by
//! commas. Needs a GPU or a software driver, and no display.

#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a benchmark ends where something is wrong, and prints"
)]

use std::fmt::Write;
use std::path::Path;
use std::time::{Duration, Instant};

use eframe::egui::Vec2;
use egui_kittest::Harness;
use explorer::tree::{choose, options};
use explorer::work::Times;
use explorer::{App, Start, scenes};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use shadewright_runtime::gpu::Gpu;

/// Switches that are timed.
const SWITCHES: usize = 200;
/// Switches from the example to a scene that is no longer like it.
const WALK: usize = 10;
/// Switches over which memory is watched.
const MANY: usize = 1000;
/// Size of the window at first.
const WINDOW: Vec2 = Vec2::new(1280.0, 800.0);
/// Longest that a picture takes.
const PATIENCE: Duration = Duration::from_secs(120);
/// Size of the pictures over which memory is watched.
const SMALL: [f32; 2] = [320.0, 240.0];
/// Size of the pictures that are timed.
const PICTURE: [f32; 2] = [640.0, 480.0];

/// What is said before the figures.
const HEAD: &str = "# What a choice takes

Made by `cargo bench -p explorer --bench switches -- --scene sphere,first --write spec/explorer-figures.md`.

The explorer runs without a window, on the device that it would have there. A switch puts a random module that fits into a random place of the scene
(geometry, materials, lights, display) and stays: the next one is made on top of it, and after ten of them it goes on from the example. One that the compiler
refuses is taken back and not counted. The time of a switch ends with the frame of the window that shows the picture; its parts are those of that picture. A software
driver compiles a pipeline's code when it first draws, so there the frame's time is mostly its compiler's. Between runs on a shared machine times change by a third.
";

/// One choice.
struct Switch {
    /// The place and what it was given.
    what: String,
    /// From the choice to the frame of the window that shows its picture.
    all: Duration,
    times: Times,
}

struct Explorer {
    harness: Harness<'static, App>,
    random: Pcg32,
    /// Of the window.
    size: Vec2,
}

impl Explorer {
    /// With one of the examples, drawn once, and the time from nothing to that.
    fn open(example: &str, picture: [f32; 2]) -> (Self, Duration) {
        let start = Instant::now();
        let scene = scenes::find(example).unwrap().scene().unwrap();
        let harness = Harness::builder()
            .with_size(WINDOW)
            .wgpu_setup(explorer::setup())
            .build_eframe(|context| {
                let render_state = context.wgpu_render_state.clone().unwrap();
                App::new(&context.egui_ctx, render_state, Start::with(scene))
                    .map_err(|report| report.render())
                    .unwrap()
            });
        let mut explorer = Self {
            harness,
            random: Pcg32::new(0x5eed, 11),
            size: WINDOW,
        };
        explorer.wait();
        let first = start.elapsed();
        // The window becomes as large as makes the picture as large as it should be; bars that wrap take of its height.
        for _ in 0..3 {
            let shown = explorer.harness.state().viewport.rect.unwrap().size();
            explorer.size += Vec2::from(picture) - shown;
            explorer.harness.set_size(explorer.size);
            explorer.harness.run_steps(4);
        }
        explorer.wait();
        assert_eq!(explorer.harness.state().viewport.rect.unwrap().size(), Vec2::from(picture));
        (explorer, first)
    }

    /// Steps until the present version is shown or has failed; whether it is shown.
    fn wait(&mut self) -> bool {
        let start = Instant::now();
        loop {
            assert!(start.elapsed() < PATIENCE, "no picture: {}", self.harness.state().message);
            self.harness.step();
            let app = self.harness.state();
            let is_shown = app.viewport.painted.as_ref().is_some_and(|painted| painted.version == app.version);
            if is_shown && app.lanes.view.is_idle() {
                return app.problems.is_empty();
            }
            if !app.problems.is_empty() && app.lanes.view.is_idle() {
                return false;
            }
            std::thread::sleep(Duration::from_micros(200));
        }
    }

    /// Goes back to the example where a walk is at its end. That is no switch.
    fn go_back(&mut self, done: usize) {
        if !done.is_multiple_of(WALK) {
            return;
        }
        while self.harness.state().document.can_undo().is_some() {
            self.harness.state_mut().undo();
        }
        self.wait();
    }

    /// Some other module in some place; `None` where that is not legal, and was taken back.
    fn switch(&mut self) -> Option<Switch> {
        let app = self.harness.state_mut();
        let places: Vec<_> = app
            .rows
            .iter()
            .filter(|row| row.is_choice() && row.path != "pass")
            .cloned()
            .collect();
        let row = &places[self.random.next_u32() as usize % places.len()];
        let catalog = app.catalog.clone();
        let fitting: Vec<_> = options(&catalog, row.interface()?).collect();
        let module = fitting[self.random.next_u32() as usize % fitting.len()];
        if row.module.as_ref().is_some_and(|chosen| chosen.name == module.name) {
            return None;
        }
        let what = format!("{} in {}", module.name, row.path);
        let start = Instant::now();
        app.edit("switch", |draft| choose(draft, &catalog, row, Some(module)));
        if !self.wait() {
            self.harness.state_mut().undo();
            self.wait();
            return None;
        }
        let painted = self.harness.state().viewport.painted.as_ref()?;
        Some(Switch {
            all: start.elapsed(),
            what,
            times: painted.times.clone(),
        })
    }
}

/// Median, 90th percentile and worst, ms.
fn row(table: &mut String, name: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize].as_secs_f64() * 1e3;
    let _ = writeln!(table, "| {name} | {:.1} | {:.1} | {:.1} |", at(0.5), at(0.9), at(1.0));
}

/// Resident memory, MiB; `None` where the system does not tell.
fn memory() -> Option<f64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    let resident: f64 = pages.split(' ').nth(1)?.parse().ok()?;
    Some(resident * 4096.0 / f64::from(1 << 20))
}

/// Times of switches in an example.
fn timed(page: &mut String, example: &str) {
    let (mut explorer, first) = Explorer::open(example, PICTURE);
    let mut switches = Vec::new();
    while switches.len() < SWITCHES {
        switches.extend(explorer.switch());
        explorer.go_back(switches.len());
    }
    let [width, height] = explorer.harness.state().viewport.painted.as_ref().unwrap().frame.size;
    let _ = writeln!(
        page,
        "## `{example}`, {width} x {height}\n\n| {SWITCHES} switches, ms | median | 90 % | worst |\n|-|-|-|-|"
    );
    let of = |part: fn(&Switch) -> Duration| switches.iter().map(part).collect::<Vec<_>>();
    row(page, "from the choice to its picture in the window", of(|s| s.all));
    row(page, "the scene's text to recipes and values", of(|s| s.times.derive));
    row(page, "link", of(|s| s.times.cpu.link));
    row(page, "pipelines", of(|s| s.times.cpu.pipelines));
    row(page, "recording", of(|s| s.times.cpu.record));
    row(page, "frame on the GPU, with what its driver compiles then", of(|s| s.times.gpu));
    switches.sort_by_key(|switch| std::cmp::Reverse(switch.all));
    let slowest: Vec<&str> = switches.iter().take(3).map(|switch| switch.what.as_str()).collect();
    let _ = writeln!(page, "\nThe slowest: {}.", slowest.join("; "));
    let _ = writeln!(
        page,
        "\nFrom nothing, no device yet, to the first picture: {:.0} ms.\n",
        first.as_secs_f64() * 1e3
    );
}

/// Memory over switches.
fn watched(page: &mut String) {
    // Small pictures: what is kept is the same.
    let (mut explorer, _) = Explorer::open("sphere", SMALL);
    let (mut resident, mut done) = (Vec::from_iter(memory()), 0);
    while done < MANY {
        done += usize::from(explorer.switch().is_some());
        explorer.go_back(done);
        if done % 100 == 0 && resident.len() <= done / 100 {
            resident.extend(memory());
        }
    }
    let said: Vec<String> = resident.iter().map(|mebibytes| format!("{mebibytes:.0}")).collect();
    let _ = writeln!(
        page,
        "## Memory\n\nResident after 0, 100, 200 ... {MANY} switches in `sphere`, after those above in the same process, MiB: {}. It grows until the lane keeps its 96 programs and\npipelines (a software driver has their code in this memory), and then no more.",
        said.join(", ")
    );
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let given = |name: &str| {
        let at = arguments.iter().position(|argument| argument == name)?;
        arguments.get(at + 1)
    };
    let examples = given("--scene").map_or("sphere", String::as_str);
    let gpu = Gpu::headless().unwrap().name();
    let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
    let mut page = format!("{HEAD}\nThis run: {gpu}, {profile} profile.\n\n");
    for example in examples.split(',') {
        timed(&mut page, example);
    }
    watched(&mut page);
    println!("{page}");
    if let Some(file) = given("--write") {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        std::fs::write(root.join(file), &page).unwrap();
    }
}
