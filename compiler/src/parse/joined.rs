//! Names of items with the name of an instance before them.

use std::sync::{Arc, Mutex};

use indexmap::IndexMap;

use super::compose::constant_name;
use super::filter::word_hash;
use super::unit::Unit;
use crate::catalog::lock;
use crate::limits;

/// Names of a unit's items with an instance's name before them, and of what the linker adds to the unit.
#[derive(Debug, Default)]
pub struct Joined {
    /// Joined names and their hashes: of the items in their order, then of what is added.
    pub names: Vec<(String, u64)>,
    /// What the linker adds is called so in the unit: constants, overrides, `Instance`, `instances`.
    pub added: Vec<String>,
}

impl Joined {
    fn new(unit: &Unit, prefix: &str) -> Self {
        let needs = &unit.needs;
        let params = needs.constants.keys().chain(needs.overrides.keys());
        let instances = ["Instance", "instances"].iter().filter(|_| !needs.instances.is_empty());
        let items = unit.scan.items.iter().map(|item| joined(prefix, &item.name));
        let names = items
            .chain(params.clone().map(|name| joined(prefix, name)))
            .chain(instances.clone().map(|name| joined(prefix, name)));
        let hashed = |name: String| {
            let hash = word_hash(&name);
            (name, hash)
        };
        Self {
            names: names.map(hashed).collect(),
            added: params
                .map(|name| constant_name(name))
                .chain(instances.map(|&name| name.to_owned()))
                .collect(),
        }
    }
}

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
        if kept.len() >= limits::VARIANTS {
            kept.shift_remove_index(0);
        }
        let names = Arc::new(Joined::new(unit, prefix));
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
