//! `sheet`: one scene drawn with every choice of a space, as one picture.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use clap::Args;
use indexmap::IndexMap;
use shadewright::compiler::manifest::{Locator, Step};
use shadewright::compiler::space::{Permutation, Space};
use shadewright::report::write::{Tile, difference, sheet, sheet_size};
use shadewright::runtime::frame::{Frame, Renderer};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::scene::SceneFile;

use super::failure::Failure;
use super::output::{Outputs, say};
use super::watch::Watch;
use super::{Context, input, render};

/// Most pictures of a sheet: more cannot be told apart, and a space may have millions.
const MOST_TILES: usize = 1024;
/// Most pixels of a sheet.
const MOST_PIXELS: u64 = 64 << 20;

/// Place of a space's root.
const ROOT: &str = "main";

/// Options of `sheet`.
#[derive(Args)]
pub struct Options {
    /// Scene (*.scene.ron), or - for standard input
    scene: PathBuf,
    /// Where in the scene, and what to put there: a space (*.space.ron, or inline), or a list of values. Given twice: all of one with all of the other
    #[arg(long, value_name = "PATH=CHOICES", required = true)]
    each: Vec<String>,
    /// Picture (*.png)
    #[arg(short, value_name = "FILE")]
    output: PathBuf,
    /// Width and height of each picture in pixels, instead of the scene's own
    #[arg(long, value_name = "WxH", value_parser = render::size)]
    size: Option<[u32; 2]>,
    /// Pictures in a row
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    columns: Option<u16>,
    /// What stands in the place of `--each` in the true picture: every choice becomes a row of its picture, the true one, and its error
    #[arg(long, value_name = "VALUE", conflicts_with = "columns")]
    against: Option<String>,
    /// Change a value of the scene first, such as `lights[0].fields.intensity=900 lm`
    #[arg(long, value_name = "PATH=VALUE")]
    set: Vec<String>,
}

/// What can stand in one place of the scene.
struct Axis {
    path: String,
    /// Names, and the RON that is put there.
    choices: Vec<(String, String)>,
}

/// # Errors
/// The scene or a space is wrong, there is too much to show, there is no GPU, or the file cannot be written.
pub fn run(context: Context, options: &Options) -> Result<(), Failure> {
    if options.output.extension().and_then(|e| e.to_str()) != Some("png") {
        return Err(Failure::Usage(format!("{}: a sheet's name ends in .png", options.output.display())));
    }
    let scene = render::read(&options.scene, &options.set)?;
    let axes: Vec<Axis> = options.each.iter().map(|typed| axis(&context, typed)).collect::<Result<_, _>>()?;
    let number = axes.iter().fold(1_usize, |n, axis| n.saturating_mul(axis.choices.len()));
    if number > MOST_TILES {
        return Err(Failure::message(format!(
            "{number} pictures are more than a sheet holds, {MOST_TILES}"
        )));
    }
    let mut variants: Vec<(String, SceneFile)> = (0..number).map(|index| variant(&scene, &axes, index)).collect::<Result<_, _>>()?;
    let truth = match (&options.against, axes.as_slice()) {
        (None, _) => None,
        (Some(value), [axis]) => Some((format!("true: {}", bare(module(value))), scene.set(&axis.path, value)?)),
        (Some(_), _) => {
            return Err(Failure::Usage(
                "--against: there is more than one --each to put it in the place of".to_owned(),
            ));
        }
    };
    let is_compared = truth.is_some();
    variants.splice(0..0, truth);
    // Rows of the last axis where there are several.
    let across = match axes.as_slice() {
        _ if is_compared => 3,
        [.., _, last] => last.choices.len(),
        _ => (number as f64).sqrt().ceil() as usize,
    };
    let columns = options.columns.map_or(across, usize::from).max(1);
    let tiles = if is_compared { 3 * number } else { number };
    let mut frames = Vec::new();
    for (name, scene) in variants {
        let frame = scene.frame(&context.catalog, options.size)?;
        let [width, height] = sheet_size(tiles, frame.size, columns);
        if width * height > MOST_PIXELS {
            return Err(Failure::message(format!(
                "a sheet of {width} x {height} pixels is larger than {} million: `--size` makes its pictures smaller",
                MOST_PIXELS >> 20
            )));
        }
        frames.push((name, frame));
    }
    let size = match frames.first() {
        Some((_, frame)) if number > 0 => frame.size,
        _ => return Err(Failure::message("there is nothing to choose from")),
    };
    let drawn = draw(context, frames, is_compared)?;
    let (tiles, said) = if is_compared {
        compared(drawn)
    } else {
        (drawn.into_iter().map(|drawn| drawn.tile).collect(), format!("{number} pictures"))
    };
    let picture = sheet(&tiles, size, columns).map_err(|error| Failure::message(error.to_string()))?;
    let mut outputs = Outputs::default();
    outputs.stage(&options.output, &picture)?;
    outputs.commit()?;
    say(&said)
}

/// A picture as it is shown and, where pictures are compared, before it was.
struct Drawn {
    tile: Tile,
    hdr: Vec<[f32; 4]>,
}

/// Draws all frames.
fn draw(context: Context, frames: Vec<(String, Frame)>, is_compared: bool) -> Result<Vec<Drawn>, Failure> {
    let gpu = Gpu::headless()?;
    let mut renderer = Renderer::new(&gpu, context.catalog);
    let number = frames.len();
    let watch = Watch::new(number as u128, "pictures");
    let mut drawn = Vec::new();
    for (name, frame) in frames {
        if watch.cancel().load(Ordering::Relaxed) {
            return Err(Failure::Interrupted(format!("{} of {number} pictures were drawn", drawn.len())));
        }
        let targets = renderer.render(&frame)?;
        let Some(pixels) = targets.read_display(&gpu)? else {
            return Err(Failure::message("the scene has no `display` pass, so there is nothing to show"));
        };
        let hdr = if is_compared { targets.read_hdr(&gpu)? } else { Vec::new() };
        drawn.push(Drawn {
            tile: Tile { name, pixels },
            hdr,
        });
        watch.step();
    }
    watch.finish();
    Ok(drawn)
}

/// A row for each picture after the first, which is the true one; and their errors in words.
fn compared(drawn: Vec<Drawn>) -> (Vec<Tile>, String) {
    let mut rows = drawn.into_iter();
    let Some(truth) = rows.next() else {
        return (Vec::new(), String::new());
    };
    let (mut tiles, mut said) = (Vec::new(), Vec::new());
    for Drawn { tile, hdr } in rows {
        let error = difference(&hdr, &truth.hdr);
        let summary = error.summary();
        said.push(format!("{}: {summary}", tile.name));
        tiles.extend([
            tile,
            truth.tile.clone(),
            Tile {
                name: format!("error: {summary}"),
                pixels: error.pixels,
            },
        ]);
    }
    (tiles, said.join("\n"))
}

/// One place and its choices, as typed.
fn axis(context: &Context, typed: &str) -> Result<Axis, Failure> {
    let Some((path, choices)) = typed.split_once('=') else {
        return Err(Failure::Usage(format!("--each {typed}: should be PATH=CHOICES")));
    };
    let (path, choices) = (path.trim().to_owned(), choices.trim());
    let choices = if choices.starts_with('[') {
        values(typed, choices)?
    } else {
        permutations(context, choices)?
    };
    Ok(Axis { path, choices })
}

/// The elements of a RON list, each as it is written.
fn values(typed: &str, list: &str) -> Result<Vec<(String, String)>, Failure> {
    if let Err(error) = shadewright::compiler::manifest::ron_options().from_str::<Vec<ron::Value>>(list) {
        return Err(Failure::Usage(format!("--each {typed}: the list cannot be read: {error}")));
    }
    let places = Locator::new(list);
    let elements = (0..).map_while(|index| places.find(&[Step::Index(index)]));
    let texts = elements.filter_map(|at| list.get(at)).map(|text| text.trim().to_owned());
    Ok(texts.map(|text| (text.trim_matches('"').to_owned(), text)).collect())
}

/// The permutations of a space, each by what was chosen and as a recipe.
fn permutations(context: &Context, typed: &str) -> Result<Vec<(String, String)>, Failure> {
    let (name, text) = input::tree(typed, "space")?;
    let space = Space::parse(&context.catalog, &name, &text)?;
    space.not_empty()?;
    let count = space.count()?;
    if count > MOST_TILES as u128 {
        return Err(Failure::message(format!(
            "{name}: {count} permutations are more than a sheet holds, {MOST_TILES}"
        )));
    }
    Ok(space
        .iter()?
        .map(|found| (name_of(&found), found.recipe.source.text.clone()))
        .collect())
}

/// The root, and what was chosen below it. Of choices within a choice the innermost tells the most.
fn name_of(permutation: &Permutation) -> String {
    let mut chosen: IndexMap<&str, &str> = IndexMap::new();
    for choice in &permutation.choices {
        chosen.insert(&choice.place, &choice.chosen);
    }
    chosen.shift_remove(ROOT);
    let root = permutation.recipe.root.module.as_str();
    let all = std::iter::once(root).chain(chosen.into_values());
    // The place in the scene says the category.
    all.map(bare).collect::<Vec<_>>().join(", ")
}

/// The module of a recipe as typed, or all of it.
fn module(typed: &str) -> &str {
    let module = Locator::new(typed).find(&[Step::Key("module")]);
    module.and_then(|at| typed.get(at)).unwrap_or(typed).trim().trim_matches('"')
}

/// A module's name without its category.
fn bare(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// The scene with one choice of each axis, the last axis changing fastest, and what they are called.
fn variant(scene: &SceneFile, axes: &[Axis], index: usize) -> Result<(String, SceneFile), Failure> {
    let mut scene = scene.clone();
    let mut names = Vec::new();
    let mut rest = index;
    for axis in axes.iter().rev() {
        // Every axis has a choice, or there would be no index.
        let (name, text) = &axis.choices[rest % axis.choices.len()];
        rest /= axis.choices.len();
        scene = scene.set(&axis.path, text)?;
        names.insert(0, name.as_str());
    }
    Ok((names.join(", "), scene))
}
