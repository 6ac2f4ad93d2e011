//! A map that can forget what has not been asked for lately.

use std::collections::HashMap;
use std::hash::Hash;

/// A map whose values know when they were last asked for.
#[derive(Debug)]
pub(crate) struct Recent<K, V> {
    values: HashMap<K, (V, u64)>,
    /// Counts what is asked.
    clock: u64,
    /// Its state when the present frame began.
    begun: u64,
}

impl<K, V> Default for Recent<K, V> {
    fn default() -> Self {
        Self {
            values: HashMap::new(),
            clock: 0,
            begun: 0,
        }
    }
}

impl<K: Eq + Hash + Clone, V> Recent<K, V> {
    /// A frame begins: what it asks for is not forgotten at its end.
    pub fn begin(&mut self) {
        self.begun = self.clock;
    }

    /// The value.
    pub fn get(&mut self, key: &K) -> Option<&V> {
        self.clock += 1;
        let (value, used) = self.values.get_mut(key)?;
        *used = self.clock;
        Some(value)
    }

    /// The value; `new` where there is none.
    pub fn get_or_insert(&mut self, key: K, new: impl FnOnce() -> V) -> &V {
        self.clock += 1;
        let (value, used) = self.values.entry(key).or_insert_with(|| (new(), 0));
        *used = self.clock;
        value
    }

    /// The value, which is not asked for by this.
    pub fn peek(&self, key: &K) -> Option<&V> {
        self.values.get(key).map(|(value, _)| value)
    }

    /// Forgets what was asked for longest ago until at most so many are left, or only what was asked for since the frame began.
    pub fn trim(&mut self, most: usize) {
        let over = self.values.len().saturating_sub(most);
        if over == 0 {
            return;
        }
        let begun = self.begun;
        let mut old: Vec<(u64, K)> = self
            .values
            .iter()
            .filter(|(_, (_, used))| *used <= begun)
            .map(|(key, (_, used))| (*used, key.clone()))
            .collect();
        old.sort_unstable_by_key(|(used, _)| *used);
        for (_, key) in old.into_iter().take(over) {
            self.values.remove(&key);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a value that goes while it is in use, one that stays for ever, and a wrong order.
    #[test]
    fn the_oldest_go_first() {
        let mut recent = Recent::default();
        for key in 0..6 {
            recent.get_or_insert(key, || key * 10);
        }
        recent.begin();
        assert_eq!(recent.get(&0), Some(&0));
        assert_eq!(*recent.get_or_insert(7, || 70), 70);
        assert_eq!(recent.peek(&1), Some(&10));
        recent.trim(4);
        let left: Vec<u32> = (0..8).filter(|key| recent.peek(key).is_some()).collect();
        assert_eq!(left, [0, 4, 5, 7]);
        recent.trim(1);
        let left: Vec<u32> = (0..8).filter(|key| recent.peek(key).is_some()).collect();
        assert_eq!(left, [0, 7], "what this frame has asked for stays");
    }
}
