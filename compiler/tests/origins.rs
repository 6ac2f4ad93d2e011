//! Where the lines of the source form come from.
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use std::sync::Arc;

use common::{recipes, standard};
use shadewright_compiler::{Catalog, Library, Program, Recipe};

/// All passes of a recipe.
fn programs(catalog: &Catalog, name: &str, text: &str) -> Vec<Program> {
    let recipe = Recipe::parse(name, text).unwrap();
    catalog.compile_all(&recipe).unwrap_or_else(|report| panic!("{report}"))
}

/// Catches a line that is told to stand one above or below, lines lost where something was cut out, a wrong file, and an item that `why` does not know.
#[test]
fn every_line_leads_to_the_authors() {
    let library = standard();
    let catalog = Catalog::load(Arc::new(library.clone())).unwrap();
    let (mut exact, mut all) = (0, 0);
    for (name, text) in recipes() {
        for program in programs(&catalog, &name, &text) {
            let origins = program.origins();
            let lines: Vec<&str> = program.wgsl().lines().collect();
            assert_eq!(origins.len(), lines.len(), "{name}");
            for (line, origin) in lines.iter().zip(&origins) {
                let Some(origin) = origin else {
                    let between = line.trim().is_empty() || ["struct", "}", "enable", "@group"].iter().any(|start| line.starts_with(start));
                    assert!(between, "{name}: {line}");
                    continue;
                };
                assert!(!program.why(&origin.item.name).is_empty(), "{name}: {} of {line}", origin.item.name);
                if origin.line == 0 {
                    continue;
                }
                let file = library.read(&origin.item.file).unwrap().unwrap();
                let author = file.lines().nth(origin.line - 1).unwrap().trim();
                let word = |text: &str| text.split(|c: char| !c.is_alphanumeric()).next().unwrap().to_owned();
                if ["return", "let", "var", "if", "for", "else"].contains(&word(line.trim()).as_str()) || line.trim().starts_with("///") {
                    all += 1;
                    assert_eq!(word(author), word(line.trim()), "{name}: {line:?} is not {author:?}");
                    exact += usize::from(author == line.trim());
                }
            }
            for function in &program.reflection().functions {
                let header = lines.iter().position(|line| line.contains(&format!("fn {}(", function.name)));
                let origin = header.and_then(|line| origins[line].as_ref());
                if let Some(origin) = origin.filter(|_| function.line > 0) {
                    assert_eq!((&origin.item.file, &origin.item.module), (&function.file, &function.module));
                    let file = library.read(&function.file).unwrap().unwrap();
                    let author = file.lines().nth(origin.line - 1).unwrap();
                    assert!(author.contains(&format!("fn {}(", function.source)), "{}: {author}", function.name);
                }
            }
        }
    }
    assert!(all > 500 && exact * 10 > all * 4, "{exact} of {all}");
}
