//! Names of imported declarations in the text that they are brought into.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use wesl::{EscapeMangler, Mangler, ModulePath};

use super::files::Files;
use super::tokens::tokens;

/// How many ways of naming are tried.
pub(super) const ATTEMPTS: usize = 8;

/// Names `noise.wesl`'s `hash` `noise_hash`, in the style of the declaration: `NoiseKind`, `NOISE_LIMIT`.
pub(super) struct Names {
    attempt: usize,
    given: RefCell<BTreeMap<(Vec<String>, String), String>>,
}

impl Names {
    pub fn new(attempt: usize) -> Self {
        Self {
            attempt,
            given: RefCell::default(),
        }
    }

    /// Path of the module, in which the declaration of this name stands.
    pub fn home(&self, name: &str) -> Option<Vec<String>> {
        self.given
            .borrow()
            .iter()
            .find(|(_, given)| *given == name)
            .map(|((path, _), _)| path.clone())
    }

    /// Whether a name was given twice or is a word of one of the files, in which it might mean something else.
    pub fn clash(&self, files: &Files) -> bool {
        let seen = files.seen();
        let taken: BTreeSet<&str> = seen
            .iter()
            .flat_map(|(_, file)| tokens(&file.text))
            .map(|token| token.text)
            .collect();
        let given = self.given.borrow();
        let different: BTreeSet<&String> = given.values().collect();
        different.len() < given.len() || different.iter().any(|name| taken.contains(name.as_str()))
    }
}

impl Mangler for Names {
    fn mangle(&self, path: &ModulePath, item: &str) -> String {
        let stem = match self.attempt {
            0 => path.components.last().cloned().unwrap_or_default(),
            1 => path.components.join("_"),
            _ => String::new(),
        };
        let name = if stem.is_empty() {
            EscapeMangler.mangle(path, item) + &"_".repeat(self.attempt.saturating_sub(2))
        } else {
            joined(&stem.replace('-', "_"), item)
        };
        let key = (path.components.clone(), item.to_owned());
        self.given.borrow_mut().insert(key, name.clone());
        name
    }
}

/// The two as one name in the second's style.
fn joined(stem: &str, item: &str) -> String {
    let lower = item.contains(char::is_lowercase);
    match (item.starts_with(char::is_uppercase), lower) {
        (true, true) => {
            let camel = stem.split('_').map(|word| {
                let mut letters = word.chars();
                letters
                    .next()
                    .map(|first| first.to_uppercase().chain(letters).collect::<String>())
                    .unwrap_or_default()
            });
            camel.collect::<String>() + item
        }
        (true, false) => format!("{}_{item}", stem.to_uppercase()),
        _ => format!("{stem}_{item}"),
    }
}
