//! Values that are made once and kept.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use super::GpuError;
use super::device::lock;

/// A value that is made once.
type Cell<V> = Arc<Mutex<Option<Arc<V>>>>;

/// A map whose values are made at most once each; threads that want the same one wait for the first.
#[derive(Debug)]
pub(crate) struct Kept<K, V> {
    cells: Mutex<HashMap<K, Cell<V>>>,
    hits: AtomicUsize,
    misses: AtomicUsize,
}

impl<K: Eq + Hash, V> Kept<K, V> {
    pub fn new() -> Self {
        Self {
            cells: Mutex::default(),
            hits: AtomicUsize::new(0),
            misses: AtomicUsize::new(0),
        }
    }

    /// The value; `make` runs if there is none. What fails is not kept.
    pub fn get(&self, key: K, make: impl FnOnce() -> Result<V, GpuError>) -> Result<Arc<V>, GpuError> {
        let cell = Arc::clone(lock(&self.cells).entry(key).or_default());
        let mut cell = lock(&cell);
        if let Some(value) = &*cell {
            self.hits.fetch_add(1, Ordering::Relaxed);
            return Ok(Arc::clone(value));
        }
        self.misses.fetch_add(1, Ordering::Relaxed);
        let value = Arc::new(make()?);
        *cell = Some(Arc::clone(&value));
        Ok(value)
    }

    /// Whether the value is there; never waits for a thread that is making it.
    pub fn has(&self, key: &K) -> bool {
        let cell = lock(&self.cells).get(key).map(Arc::clone);
        cell.is_some_and(|cell| cell.try_lock().is_ok_and(|value| value.is_some()))
    }

    /// How often values were found and made so far.
    pub fn counts(&self) -> Counts {
        Counts {
            hits: self.hits.load(Ordering::Relaxed),
            misses: self.misses.load(Ordering::Relaxed),
        }
    }
}

/// How often something was found and made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Requests answered from the cache.
    pub hits: usize,
    /// Requests that made something.
    pub misses: usize,
}
