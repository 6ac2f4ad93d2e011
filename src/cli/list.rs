//! `list`: what modules there are.

use clap::Args;
use serde_json::json;

use super::failure::Failure;
use super::output::{say, say_json};
use super::text::{columns, nearest};
use super::{Context, Format};

/// Options of `list`.
#[derive(Args)]
pub struct Options {
    /// Only modules of this category
    #[arg(long, value_name = "CATEGORY")]
    category: Option<String>,
}

/// # Errors
/// There is no such category.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let catalog = &context.catalog;
    if let Some(wanted) = &options.category
        && !catalog.categories().any(|category| category.name == *wanted)
    {
        let near = nearest(wanted, catalog.categories().map(|category| category.name.as_str()));
        return Err(Failure::message(format!("there is no category `{wanted}`{near}")));
    }
    let categories = catalog
        .categories()
        .filter(|category| options.category.as_ref().is_none_or(|wanted| category.name == *wanted));
    let mut text = String::new();
    let mut listed = Vec::new();
    for category in categories {
        let modules: Vec<_> = catalog.modules().filter(|module| module.category == category.name).collect();
        let lines: Vec<Vec<String>> = modules
            .iter()
            .map(|module| vec![module.name.clone(), module.manifest.summary.clone()])
            .collect();
        text.push_str(&format!(
            "{}: {}\n{}",
            category.name,
            category.manifest.summary,
            columns(&lines, "  ")
        ));
        let modules: Vec<_> = modules
            .iter()
            .map(|module| json!({"name": module.name, "summary": module.manifest.summary}))
            .collect();
        listed.push(json!({"name": category.name, "summary": category.manifest.summary, "modules": modules}));
    }
    match context.format {
        Format::Text => say(&text),
        Format::Json => say_json(&json!({"categories": listed})),
    }
}
