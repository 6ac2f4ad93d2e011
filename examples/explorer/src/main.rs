//! The explorer, in a window.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;

use clap::{Parser, Subcommand};
use eframe::egui;
use explorer::compare::Pin;
use explorer::document::Document;
use explorer::files::{Kept, library_with, state_file};
use explorer::{App, Start, scenes};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::image::write_atomically;
use shadewright_runtime::scene::SceneFile;

/// An interactive explorer of shading permutations
#[derive(Parser)]
#[command(args_conflicts_with_subcommands = true)]
struct Options {
    #[command(subcommand)]
    command: Option<Command>,
    /// Scene (*.scene.ron), or the name of an example; else what was edited last
    scene: Option<PathBuf>,
    /// Folder of modules that come before those of the standard library, watched for changes
    #[arg(long, value_name = "FOLDER")]
    modules: Option<PathBuf>,
    /// Begin afresh, and keep nothing for the next start
    #[arg(long)]
    fresh: bool,
}

#[derive(Subcommand)]
enum Command {
    /// Build the explorer as a web page and serve it to the browsers of this machine
    Serve {
        /// Port on localhost; 0 takes one that is free
        #[arg(long, default_value_t = 8080)]
        port: u16,
    },
}

fn main() -> ExitCode {
    env_logger::init();
    let options = Options::parse();
    let result = match options.command {
        Some(Command::Serve { port }) => explorer::serve::run(port).map_err(Failure::from),
        None => run(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { status, message }) => {
            // With stderr closed there is nobody to tell.
            let _ = writeln!(std::io::stderr(), "{}", message.trim_end());
            ExitCode::from(status)
        }
    }
}

/// Why it ends, and with which status: those of the command, see spec/command.md.
struct Failure {
    status: u8,
    message: String,
}

impl From<String> for Failure {
    fn from(message: String) -> Self {
        Self { status: 1, message }
    }
}

fn example(example: &scenes::Example) -> Result<SceneFile, String> {
    example.scene().map_err(|report| report.render())
}

/// An example or a file.
fn named(asked: &Path, kept: &mut Kept) -> Result<Document, String> {
    if let Some(found) = scenes::find(&asked.to_string_lossy()) {
        return Ok(Document::new(example(found)?));
    }
    let path = std::path::absolute(asked).map_err(|error| error.to_string())?;
    let scene = SceneFile::read(&path).map_err(|report| report.render())?;
    kept.remember(&path);
    Ok(Document::new(scene.with_files(scenes::files())))
}

/// With what to begin: what is asked for, else what was edited last, else the first example.
fn start(options: &Options) -> Result<Start, String> {
    let state_file = if options.fresh { None } else { state_file() };
    let mut kept = state_file.as_deref().map(Kept::read).unwrap_or_default();
    let kept_on = match &options.scene {
        Some(_) => None,
        None => last(&mut kept, state_file.as_deref()),
    };
    let (document, pins) = match (kept_on, &options.scene) {
        (Some(last), _) => last,
        (None, asked) => {
            kept.put_aside();
            let document = match asked {
                Some(asked) => named(asked, &mut kept)?,
                None => Document::new(example(&scenes::ALL[0])?),
            };
            (document, Vec::new())
        }
    };
    if let Some(folder) = &options.modules {
        if !folder.is_dir() {
            return Err(format!("{} is no folder", folder.display()));
        }
        kept.modules = Some(folder.clone());
    }
    let own = kept.modules.clone().filter(|folder| folder.is_dir());
    if own.is_none()
        && let Some(folder) = kept.modules.take()
    {
        log::warn!("{} is no folder", folder.display());
    }
    Ok(Start {
        document,
        pins,
        library: own.as_deref().map_or_else(shadewright_modules::library, library_with),
        kept,
        state_file,
    })
}

/// What was edited last. Where it may have ended the program, or cannot be read any more, it is put aside.
fn last(kept: &mut Kept, state_file: Option<&Path>) -> Option<(Document, Vec<Pin>)> {
    let work = kept.work.as_ref()?;
    if !kept.starting {
        match Document::restored(work.state.clone(), Arc::clone(&work.saved), &scenes::files()) {
            Ok(document) => return Some((document, work.pins.clone())),
            Err(report) => log::warn!("{}", report.render()),
        }
    }
    let aside = state_file?.with_file_name("aside.scene.ron");
    match write_atomically(&aside, work.state.text.as_bytes()) {
        Ok(()) => kept.remember(&aside),
        Err(error) => log::error!("{error}"),
    }
    None
}

fn run(options: &Options) -> Result<(), Failure> {
    let start = start(options)?;
    // eframe panics where there is no adapter; this says what to install.
    drop(Gpu::headless().map_err(|error| Failure {
        status: 3,
        message: error.to_string(),
    })?);
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
    .map_err(|error| Failure::from(format!("no window can be opened: {error}")))
}
