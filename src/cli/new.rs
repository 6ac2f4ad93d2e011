//! `new`: the skeleton of a module's folder, which passes `check` as it is.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;
use shadewright::compiler::Category;

use super::failure::Failure;
use super::output::{say, say_json};
use super::text::nearest;
use super::{Context, Format};

/// Options of `new`.
#[derive(Args)]
pub struct Options {
    /// What the module decides: a category's name, as `list` shows them
    category: String,
    /// Its name: lower-case letters, digits and hyphens
    name: String,
    /// Folder of modules in which CATEGORY/NAME is made
    #[arg(long, value_name = "DIR", default_value = ".")]
    dir: PathBuf,
}

/// Longest name.
const MAX_NAME: usize = 64;

/// # Errors
/// There is no such category, the name cannot be one or is taken, or the folder cannot be written.
pub fn run(modules: &[PathBuf], format: Format, options: &Options) -> Result<(), Failure> {
    let context = Context::new(modules, format)?;
    let (category, name) = (&options.category, &options.name);
    let Some(known) = context.catalog.categories().find(|known| known.name == *category) else {
        let near = nearest(category, context.catalog.categories().map(|known| known.name.as_str()));
        return Err(Failure::message(format!("there is no category `{category}`{near}")));
    };
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if name.len() > MAX_NAME || !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(plain) || name.ends_with('-') {
        return Err(Failure::message(format!(
            "`{name}` cannot be a module's name: at most {MAX_NAME} lower-case letters, digits and hyphens, a letter first"
        )));
    }
    if context
        .catalog
        .modules()
        .any(|module| module.category == *category && module.name == *name)
    {
        return Err(Failure::message(format!("there is a module `{category}/{name}` already")));
    }
    let folder = options.dir.join(category).join(name);
    if folder.exists() {
        return Err(Failure::message(format!("{}: is there already", folder.display())));
    }
    let files = [
        ("module.ron".to_owned(), declaration(known, name)),
        (format!("{name}.wgsl"), code(&context, category)?),
        ("README.md".to_owned(), readme(category, name)),
        ("cases.ron".to_owned(), CASES.to_owned()),
    ];
    make(&options.dir, &folder, &files).map_err(|error| Failure::message(format!("{}: cannot be written: {error}", folder.display())))?;
    let names: Vec<String> = files.iter().map(|(file, _)| folder.join(file).display().to_string()).collect();
    match format {
        Format::Text => say(&names.join("\n")),
        Format::Json => say_json(&json!({"files": names})),
    }
}

/// Writes the folder under a temporary name outside its category, where it is no module yet, then renames it:
/// there is all of it or nothing.
fn make(root: &Path, folder: &Path, files: &[(String, String)]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder.parent().unwrap_or(root))?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".shadewright-");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    let half = builder.tempdir_in(root)?;
    for (file, text) in files {
        std::fs::write(half.path().join(file), text)?;
    }
    std::fs::rename(half.path(), folder)?;
    // The folder has its name now; there is nothing left to delete.
    let _ = half.keep();
    Ok(())
}

fn declaration(category: &Category, name: &str) -> String {
    let summary = category.manifest.summary.replace('"', "'");
    format!(
        r#"// The module `{name}`. What may stand here is in spec/modules.md; a field that is not known is an error.
(
    // One line: what it computes.
    summary: "Neutral: {summary}",
    // Where the formula comes from: author, year, equation.
    source: [],
    // Numbers that a scene or a recipe sets; the WGSL reads `params.width`.
    params: {{
        // "width": (type: F32, unit: "1", default: 0.5, range: Some((0.0, 1.0)), doc: "Width of the highlight"),
    }},
    // Holes that other modules fill; the WGSL calls the functions of the interface by their names.
    slots: {{
        // "ndf": (interface: "ndf", default: "ggx", doc: "Distribution of microfacet normals"),
    }},
    // Module-scope textures, samplers and buffers of the WGSL, written there without @group and @binding.
    resources: {{
        // "ramp": (kind: Texture(srgb: false), doc: "Reflectance by angle"),
    }},
    // What it claims to be, for the tests to check: "reciprocal", "energy_conserving", "isotropic".
    properties: [],
)
"#
    )
}

/// The interface's own functions with their neutral bodies, to be edited.
fn code(context: &Context, category: &str) -> Result<String, Failure> {
    let functions = context.catalog.functions(category)?;
    if functions.is_empty() {
        return Ok(ROOT.to_owned());
    }
    // What may be left out is: the interface's own body is as good.
    let manifest = context.catalog.category(category).map(|category| &category.manifest);
    let needed = |name: &str| manifest.is_none_or(|manifest| manifest.optional_with(name).is_none());
    let texts: Vec<String> = functions
        .into_iter()
        .filter(|(name, _)| needed(name))
        .map(|(_, text)| text)
        .collect();
    Ok(format!("{}\n", texts.join("\n\n")))
}

/// Code of a root: a triangle over the whole target.
const ROOT: &str = "\
struct Corner {
    @builtin(position) position: vec4f,
}

/// Three corners of a triangle that covers the target.
@vertex
fn corner(@builtin(vertex_index) index: u32) -> Corner {
    let x = f32(index & 1u) * 4.0 - 1.0;
    let y = f32(index >> 1u) * 4.0 - 1.0;
    return Corner(vec4f(x, y, 0.0, 1.0));
}

struct Pixel {
    @location(0) color: vec4f,
}

@fragment
fn pixel() -> Pixel {
    return Pixel(vec4f(0.0, 0.0, 0.0, 1.0));
}
";

fn readme(category: &str, name: &str) -> String {
    format!(
        "# {name}\n\n\
         A module of the category `{category}`. As made, it computes the category's neutral value.\n\n\
         ## Formula\n\nThe formula, with the names that the code has, and where it comes from.\n\n\
         ## Domain and limits\n\nFor which inputs it holds, and what it does at their edges.\n"
    )
}

const CASES: &str = "\
// Inputs of the module's functions with the values that they must give, computed by hand or from the paper:
// [(function: \"distribution\", inputs: {\"s\": {\"alpha\": 0.5}}, expect: 1.273239545, relative: 1e-5, source: \"by hand\")]
[]
";
