//! The functions of a category's interface, as its author wrote them.

use shadewright::compiler::naga;
use shadewright::compiler::{Catalog, Library};

use super::failure::Failure;

/// A function that modules of the category define.
pub struct Function {
    /// Its name.
    pub name: String,
    /// Doc comment, signature and neutral body.
    pub text: String,
}

/// The functions that a category's modules must define, in the order of its text; empty for roots with entry points of their own.
///
/// # Errors
/// There is no such category, or its text is no WGSL.
pub fn functions(library: &dyn Library, catalog: &Catalog, category: &str) -> Result<Vec<Function>, Failure> {
    let own = text_of(library, category)?;
    let mut whole = own.clone();
    let mut used = vec![category.to_owned()];
    let mut next = 0;
    while let Some(name) = used.get(next).cloned() {
        next += 1;
        let Some(manifest) = catalog.categories().find(|known| known.name == name).map(|known| &known.manifest) else {
            return Err(Failure::message(format!("there is no category `{name}`")));
        };
        for name in &manifest.uses {
            if !used.contains(name) {
                used.push(name.clone());
                whole.push('\n');
                whole.push_str(&text_of(library, name)?);
            }
        }
    }
    let module = naga::front::wgsl::parse_str(&whole)
        .map_err(|error| Failure::message(error.emit_to_string_with_path(&whole, &format!("{category}/interface.wgsl"))))?;
    let offers = catalog
        .categories()
        .find(|known| known.name == category)
        .map(|known| &known.manifest.offers);
    let mut found = Vec::new();
    for (handle, function) in module.functions.iter() {
        let span = module.functions.get_span(handle).to_range().unwrap_or_default();
        let name = function.name.clone().unwrap_or_default();
        if span.end > own.len() || offers.is_some_and(|offers| offers.contains(&name)) {
            continue;
        }
        let start = with_comment(&own, span.start);
        found.push((
            span.start,
            Function {
                name,
                text: own[start..span.end].to_owned(),
            },
        ));
    }
    found.sort_by_key(|(start, _)| *start);
    Ok(found.into_iter().map(|(_, function)| function).collect())
}

fn text_of(library: &dyn Library, category: &str) -> Result<String, Failure> {
    let path = format!("{category}/interface.wgsl");
    let text = library.read(&path).map_err(|why| Failure::message(format!("{path}: {why}")))?;
    text.ok_or_else(|| Failure::message(format!("{path}: there is no such file")))
}

/// Start of the comment that ends where the item at `start` begins.
fn with_comment(text: &str, start: usize) -> usize {
    let mut first = start;
    for line in text[..start].split_inclusive('\n').rev() {
        if !line.trim_start().starts_with("//") {
            break;
        }
        first -= line.len();
    }
    first
}
