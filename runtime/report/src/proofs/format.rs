//! `CATEGORY/CATEGORY.proofs.ron`: what a category's functions are, which says what they must be.

use serde::Deserialize;
use shadewright_compiler::diagnostics::{Diagnostic, codes};
use shadewright_compiler::manifest::{Parsed, Step, parse};
use shadewright_compiler::{Catalog, Library, Report};

/// The file as written.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Declared {
    /// A function of `s`, `v`, `l` that is a reflectance, 1/sr per channel.
    pub reflectance: Option<String>,
    /// A function of `s`, `v`, `l`, `h` that is G / (4 n.l n.v).
    pub masking: Option<String>,
    /// A function of `s`, `h` that is a density of facets, whose integral times n.h is 1.
    pub distribution: Option<String>,
    /// A function of `s` and a cosine that is a share of the light, in [0, 1].
    pub share: Option<String>,
    /// A function that draws directions, and what says with which density.
    pub draws: Option<Draws>,
    /// Distributions and the masking that Smith's integral gives them.
    pub areas: Vec<Area>,
    /// Modules whose slots are filled in every way.
    pub combinations: Vec<String>,
}

/// Functions that belong together.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Draws {
    /// Of `s`, `v`, `u`: a direction.
    pub sample: String,
    /// Of `s`, `v` and that direction: its density over solid angle.
    pub density: String,
    /// The direction's name among the density's arguments.
    pub drawn: String,
}

/// A distribution and a masking term that are said to conserve projected area (Heitz 2014, eq. 16).
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// `category/name`.
    pub distribution: String,
    /// `category/name`.
    pub masking: String,
    /// How far the facets' area may be from the surface's, relative.
    pub within: f64,
    /// Whether the distribution draws the facets that are seen, which bounds the weight of a sample by 1.
    #[serde(default)]
    pub seen: bool,
}

/// A category's file.
#[derive(Clone, Debug)]
pub struct Roles {
    /// The category.
    pub category: String,
    /// What is said of it.
    pub declared: Declared,
}

/// The files of all categories that have one, in the order of the categories.
///
/// # Errors
/// A file cannot be read, has another form, or names a function or a module that is not there.
pub fn load(library: &dyn Library, catalog: &Catalog) -> Result<Vec<Roles>, Report> {
    let mut found = Vec::new();
    for category in catalog.categories() {
        let path = format!("{0}/{0}.proofs.ron", category.name);
        if let Some(file) = library.file(&path)? {
            found.push(read(catalog, &category.name, &path, &file.text)?);
        }
    }
    Ok(found)
}

/// Reads a category's file.
///
/// # Errors
/// As for [`load`].
pub fn read(catalog: &Catalog, category: &str, path: &str, text: &str) -> Result<Roles, Report> {
    let parsed = parse::<Declared>(path, text)?;
    let declared = &parsed.value;
    let known = catalog.functions(category)?;
    let mut errors = Vec::new();
    let single = [
        ("reflectance", &declared.reflectance),
        ("masking", &declared.masking),
        ("distribution", &declared.distribution),
        ("share", &declared.share),
    ];
    let mut named: Vec<(Vec<Step>, &str)> = single
        .into_iter()
        .filter_map(|(field, name)| Some((vec![Step::Key(field)], name.as_deref()?)))
        .collect();
    if let Some(draws) = &declared.draws {
        named.push((vec![Step::Key("draws"), Step::Key("sample")], &draws.sample));
        named.push((vec![Step::Key("draws"), Step::Key("density")], &draws.density));
    }
    for (steps, name) in named {
        if !known.contains_key(name) {
            let message = format!("`{category}` has no function `{name}`");
            let names = known.keys().map(String::as_str);
            errors.push(at(&parsed, &steps, message).suggest(name, "functions", names));
        }
    }
    for (index, area) in declared.areas.iter().enumerate() {
        for (field, name) in [("distribution", &area.distribution), ("masking", &area.masking)] {
            if catalog.module(name).is_err() {
                let steps = [Step::Key("areas"), Step::Index(index), Step::Key(field)];
                errors.push(at(&parsed, &steps, format!("there is no module `{name}`")));
            }
        }
    }
    for (index, name) in declared.combinations.iter().enumerate() {
        if catalog.module(&format!("{category}/{name}")).is_err() {
            let steps = [Step::Key("combinations"), Step::Index(index)];
            errors.push(at(&parsed, &steps, format!("`{category}` has no module `{name}`")));
        }
    }
    Report::unless_empty(errors)?;
    Ok(Roles {
        category: category.to_owned(),
        declared: parsed.value,
    })
}

fn at(parsed: &Parsed<Declared>, steps: &[Step], message: String) -> Diagnostic {
    parsed.error_at(steps, codes::EXPERIMENT_INVALID, message, "named here")
}
