//! Things that are kept as long as frames ask for them.

use std::collections::HashMap;
use std::hash::Hash;
use std::path::PathBuf;

use super::Stamp;

/// Frames that something is kept for after the last one that asked: hosts draw two or three versions of a scene in turn.
const ROUNDS: u64 = 8;

/// Values by key, each with the files it was made from.
pub(super) struct Shelf<K, V>(HashMap<K, Entry<V>>);

struct Entry<V> {
    value: V,
    origins: Vec<(PathBuf, Stamp)>,
    used: u64,
}

impl<K, V> Default for Shelf<K, V> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Eq + Hash, V: Clone> Shelf<K, V> {
    /// What is there, with what it was made from.
    pub fn get(&mut self, key: &K, round: u64) -> Option<(V, Vec<(PathBuf, Stamp)>)> {
        let entry = self.0.get_mut(key)?;
        entry.used = round;
        Some((entry.value.clone(), entry.origins.clone()))
    }

    /// Keeps a value. Where another thread has made it from the same files meanwhile, that thread's is what both have.
    pub fn put(&mut self, key: K, value: V, origins: Vec<(PathBuf, Stamp)>, round: u64) -> V {
        if let Some(entry) = self.0.get(&key)
            && entry.origins == origins
        {
            return entry.value.clone();
        }
        let kept = value.clone();
        let used = round;
        self.0.insert(key, Entry { value, origins, used });
        kept
    }

    /// Drops what nobody asked for in the latest rounds.
    pub fn sweep(&mut self, round: u64) {
        self.0.retain(|_, entry| entry.used + ROUNDS >= round);
    }
}
