//! The explorer, in a window.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use eframe::egui;
use explorer::document::Document;
use explorer::{App, Start, scenes};
use shadewright_runtime::scene::SceneFile;

/// An interactive explorer of shading permutations
#[derive(Parser)]
struct Options {
    /// Scene (*.scene.ron), or the name of an example
    scene: Option<PathBuf>,
}

fn main() -> ExitCode {
    env_logger::init();
    match run(&Options::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            log::error!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    let example = options.scene.as_ref().and_then(|scene| scenes::find(&scene.to_string_lossy()));
    let scene = match (&options.scene, example) {
        (Some(path), None) => SceneFile::read(path).map_err(|report| report.render())?,
        (_, example) => {
            let example = example.unwrap_or(&scenes::ALL[0]);
            SceneFile::parse(example.name, example.text, std::path::Path::new("examples/scenes")).map_err(|report| report.render())?
        }
    };
    let start = Start {
        document: Document::new(scene),
        library: shadewright_modules::library(),
    };
    let mut native = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_inner_size([1440.0, 900.0])
            .with_title("Shadewright explorer"),
        ..Default::default()
    };
    native.wgpu_options.wgpu_setup = explorer::setup();
    eframe::run_native(
        "shadewright-explorer",
        native,
        Box::new(|context| {
            let render_state = context.wgpu_render_state.clone().ok_or("the window has no GPU")?;
            let app = App::new(&context.egui_ctx, render_state, start).map_err(|report| report.render())?;
            Ok(Box::new(app))
        }),
    )
    .map_err(|error| error.to_string())
}
