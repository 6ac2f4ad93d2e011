//! Names of items with the name of an instance before them.

use std::sync::{Arc, Mutex};

use indexmap::IndexMap;

use super::filter::word_hash;
use super::unit::Unit;
use crate::catalog::lock;
use crate::limits;

/// Names of a unit's items with an instance's name before them, and their hashes.
pub type Joined = Vec<(String, u64)>;

/// The same by the instance's name: most permutations call their instances alike.
#[derive(Debug, Default)]
pub struct JoinedNames(Mutex<IndexMap<String, Arc<Joined>>>);

impl JoinedNames {
    /// The names for an instance.
    pub fn get(&self, unit: &Unit, prefix: &str) -> Arc<Joined> {
        let mut kept = lock(&self.0);
        if let Some(joined) = kept.get(prefix) {
            return Arc::clone(joined);
        }
        let names = unit.scan.items.iter().map(|item| joined(prefix, &item.name));
        let names: Arc<Joined> = Arc::new(
            names
                .map(|name| {
                    let hash = word_hash(&name);
                    (name, hash)
                })
                .collect(),
        );
        if kept.len() >= limits::VARIANTS {
            kept.shift_remove_index(0);
        }
        kept.insert(prefix.to_owned(), Arc::clone(&names));
        names
    }
}

/// Instance and item in the item's own style: `point_light`, `PointInstance`, `POINT_LIMIT`.
pub fn joined(prefix: &str, name: &str) -> String {
    if prefix.is_empty() {
        return name.to_owned();
    }
    let upper = name.bytes().any(|c| c.is_ascii_uppercase());
    let lower = name.bytes().any(|c| c.is_ascii_lowercase());
    let mut joined = String::with_capacity(prefix.len() + 1 + name.len());
    if upper && !lower {
        joined.push_str(prefix);
        joined.make_ascii_uppercase();
        joined.push('_');
    } else if name.starts_with(|c: char| c.is_ascii_uppercase()) {
        for part in prefix.split('_').filter(|p| !p.is_empty()) {
            let (head, tail) = part.split_at(1);
            joined.extend(head.chars().map(|c| c.to_ascii_uppercase()));
            joined.push_str(tail);
        }
    } else {
        joined.push_str(prefix);
        joined.push('_');
    }
    joined + name
}
