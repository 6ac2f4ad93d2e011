//! A module's parsed text, once for each set of constants that recipes have frozen.

use std::hash::BuildHasherDefault;
use std::sync::{Arc, Mutex};

use indexmap::IndexMap;
use rustc_hash::FxHasher;

use super::lock;
use crate::limits;
use crate::manifest::{Typed, Value};
use crate::parse::Unit;

/// Constants with their values, as text.
pub type Constants = Vec<(String, String)>;

/// Parsed units by constants. The oldest go when there are too many.
#[derive(Debug, Default)]
pub struct Variants(Mutex<IndexMap<Constants, Arc<Unit>, BuildHasherDefault<FxHasher>>>);

impl From<Unit> for Variants {
    /// Of a text without constants.
    fn from(unit: Unit) -> Self {
        let variants = Self::default();
        variants.insert(Vec::new(), Arc::new(unit));
        variants
    }
}

impl Variants {
    /// What tells a set of constants from others.
    pub fn key(constants: &IndexMap<String, (Value, Typed)>) -> Constants {
        constants.iter().map(|(name, (_, value))| (name.clone(), value.wgsl())).collect()
    }

    /// The unit that was parsed with these constants.
    pub fn get(&self, key: &Constants) -> Option<Arc<Unit>> {
        lock(&self.0).get(key).cloned()
    }

    /// All that are kept.
    pub fn all(&self) -> Vec<Arc<Unit>> {
        lock(&self.0).values().cloned().collect()
    }

    /// Keeps a unit, unless another thread was faster: whoever asks gets the one that was there first, since linking goes by
    /// identity.
    pub fn insert(&self, key: Constants, unit: Arc<Unit>) -> Arc<Unit> {
        let mut kept = lock(&self.0);
        if kept.len() >= limits::VARIANTS && !kept.contains_key(&key) {
            kept.shift_remove_index(0);
        }
        Arc::clone(kept.entry(key).or_insert(unit))
    }
}
