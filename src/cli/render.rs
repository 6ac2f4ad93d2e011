//! `render`: a scene into a picture.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use shadewright::compiler::Recipe;
use shadewright::compiler::manifest::Node;
use shadewright::runtime::frame::{Frame, Renderer, Targets};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::image::{Hdr, encode_exr, encode_png};
use shadewright::runtime::scene::SceneFile;

use super::failure::Failure;
use super::output::Outputs;
use super::{Context, check, input, needs, timings};

/// Options of `render`.
#[derive(Args)]
pub struct Options {
    /// Scene (*.scene.ron), or - for standard input
    scene: PathBuf,
    /// Picture: *.png as displayed, *.exr the linear HDR frame in cd/m2
    #[arg(short, value_name = "FILE", required_unless_present_any = ["needs", "timings"])]
    output: Option<PathBuf>,
    /// Width and height in pixels, instead of the scene's own
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// Change a value of the scene, such as `lights[0].fields.intensity=900 lm`
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
    /// What is shown
    #[arg(long, value_enum, default_value_t = View::Beauty)]
    view: View,
    /// Draw nothing: list the programs and states that the scene needs before its first frame, in their order. No GPU is touched
    #[arg(long, conflicts_with = "output")]
    needs: bool,
    /// Say what each pass costs on the GPU, as the median of so many frames after a first one that warms up
    #[arg(long, value_name = "FRAMES", num_args = 0..=1, require_equals = true, default_missing_value = "8",
        value_parser = clap::value_parser!(u16).range(1..=1000), conflicts_with = "needs")]
    timings: Option<u16>,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum View {
    /// The scene, lit
    Beauty,
}

/// Kinds of files, by their names' ends.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Png,
    Exr,
}

/// Width and height as typed, 960x540.
///
/// # Errors
/// They are not two whole numbers.
pub fn size(typed: &str) -> Result<[u32; 2], String> {
    let sides = typed.split_once('x').and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.ok_or_else(|| "should be like 960x540".to_owned())
}

/// # Errors
/// The scene is wrong, there is no GPU, or the file cannot be written.
pub fn run(context: Context, options: &Options) -> Result<(), Failure> {
    let View::Beauty = options.view;
    let output = options.output.as_deref();
    let kind = match (output, output.and_then(Path::extension).and_then(|extension| extension.to_str())) {
        (None, _) => None,
        (_, Some("png")) => Some(Kind::Png),
        (_, Some("exr")) => Some(Kind::Exr),
        (Some(name), _) => {
            return Err(Failure::Usage(format!("{}: a picture's name ends in .png or .exr", name.display())));
        }
    };
    let scene = read(&options.scene, &options.set)?;
    let mut frame = scene.frame(&context.catalog, options.size)?;
    if options.needs {
        return needs::say(&context.catalog, &frame, context.format);
    }
    match kind {
        None => {}
        Some(Kind::Exr) => frame.display = None,
        Some(Kind::Png) if frame.display.is_none() => {
            return Err(Failure::message(
                "the scene has no `display` pass, so there is only an HDR frame: name an .exr file",
            ));
        }
        Some(Kind::Png) => {}
    }
    let gpu = Gpu::headless()?;
    let mut renderer = Renderer::new(&gpu, context.catalog);
    let (targets, times) = match options.timings {
        None => (renderer.render(&frame)?, None),
        Some(frames) => {
            let (targets, times) = timings::take(&mut renderer, &frame, frames)?;
            (targets, Some(times))
        }
    };
    if let Some(output) = output {
        write(&gpu, &frame, &targets, output)?;
    }
    match times {
        None => Ok(()),
        Some(times) => timings::say(&gpu, &frame, &times, context.format),
    }
}

/// Writes the picture.
fn write(gpu: &Gpu, frame: &Frame, targets: &Targets, output: &Path) -> Result<(), Failure> {
    let [width, height] = frame.size;
    let picture = match targets.read_display(gpu)? {
        Some(pixels) => encode_png(width, height, &pixels),
        None => encode_exr(&Hdr {
            width,
            height,
            texels: targets.read_hdr(gpu)?,
            comment: "linear Rec.709, cd/m2".to_owned(),
        }),
    };
    let picture = picture.map_err(|error| Failure::message(error.to_string()))?;
    let mut outputs = Outputs::default();
    outputs.stage(output, &picture)?;
    outputs.commit()
}

/// A scene with some of its values changed, each as `PATH=VALUE`.
///
/// # Errors
/// What is typed is no such pair, a path leads nowhere, or the file is no scene.
pub fn read(path: &Path, set: &[String]) -> Result<SceneFile, Failure> {
    let text = input::text(path)?;
    let name = if path == Path::new("-") {
        "standard input".into()
    } else {
        path.to_string_lossy()
    };
    let mut scene = SceneFile::parse(&name, &text, path.parent().unwrap_or(Path::new("")))?;
    for typed in set {
        let Some((path, value)) = typed.split_once('=') else {
            return Err(Failure::Usage(format!("--set {typed}: should be PATH=VALUE")));
        };
        scene = scene.set(path.trim(), value.trim())?;
    }
    Ok(scene)
}

/// Derives a scene's recipes and links them.
///
/// # Errors
/// What is wrong with the scene.
pub fn check(context: &Context, path: &Path) -> Result<(), Failure> {
    let frame = read(path, &[])?.frame(&context.catalog, None)?;
    let mut recipes: Vec<&Node> = Vec::new();
    for material in frame.materials.iter().chain(&frame.display) {
        let recipe = material.recipe.as_ref();
        if !recipes.contains(&recipe) {
            recipes.push(recipe);
            check::tree(context, &Recipe::from(recipe.clone()))?;
        }
    }
    Ok(())
}
