//! Values that are made once and kept.

use std::hash::Hash;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

use super::device::lock;
use super::{GpuError, Recent};

/// A value that is made once.
#[derive(Debug)]
struct Cell<V> {
    made: OnceLock<Arc<V>>,
    /// Held by the thread that makes it. Where that one panics, the next tries.
    making: Mutex<()>,
}

/// A map whose values are made at most once each; threads that want the same one wait for the first.
#[derive(Debug)]
pub(crate) struct Kept<K, V> {
    cells: Mutex<Recent<K, Arc<Cell<V>>>>,
    hits: AtomicUsize,
    misses: AtomicUsize,
}

impl<K: Eq + Hash + Clone, V> Kept<K, V> {
    pub fn new() -> Self {
        Self {
            cells: Mutex::default(),
            hits: AtomicUsize::new(0),
            misses: AtomicUsize::new(0),
        }
    }

    /// The value; `make` runs if there is none. What fails is not kept.
    pub fn get(&self, key: K, make: impl FnOnce() -> Result<V, GpuError>) -> Result<Arc<V>, GpuError> {
        let new = || {
            Arc::new(Cell {
                made: OnceLock::new(),
                making: Mutex::default(),
            })
        };
        let cell = Arc::clone(lock(&self.cells).get_or_insert(key, new));
        let _making = lock(&cell.making);
        if let Some(value) = cell.made.get() {
            self.hits.fetch_add(1, Ordering::Relaxed);
            return Ok(Arc::clone(value));
        }
        self.misses.fetch_add(1, Ordering::Relaxed);
        let value = Arc::new(make()?);
        Ok(Arc::clone(cell.made.get_or_init(|| value)))
    }

    /// Whether the value is there; never waits for a thread that is making it.
    pub fn has(&self, key: &K) -> bool {
        lock(&self.cells).peek(key).is_some_and(|cell| cell.made.get().is_some())
    }

    /// A frame begins: what it asks for is not forgotten at its end.
    pub fn begin(&self) {
        lock(&self.cells).begin();
    }

    /// Forgets what was asked for longest ago, until so many are left or only those of the present frame.
    pub fn trim(&self, most: usize) {
        lock(&self.cells).trim(most);
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::{AssertUnwindSafe, catch_unwind};

    /// Catches a value that counts as missing for ever because a first try panicked: a frame that waits for it would wait for ever.
    #[test]
    fn a_panic_leaves_no_mark() {
        let kept = Kept::<u32, u32>::new();
        let panics = catch_unwind(AssertUnwindSafe(|| kept.get(1, || panic!("planted"))));
        assert!(panics.is_err() && !kept.has(&1));
        assert_eq!(
            kept.get(1, || Err(GpuError::Lost("planted".into()))),
            Err(GpuError::Lost("planted".into()))
        );
        assert_eq!(kept.get(1, || Ok(7)).as_deref(), Ok(&7));
        assert!(kept.has(&1));
        assert_eq!(kept.get(1, || Ok(8)).as_deref(), Ok(&7));
        assert_eq!(kept.counts(), Counts { hits: 1, misses: 3 });
    }

    /// Catches a value that is made twice, and one that is not seen while another thread takes it: a frame would show a fallback again.
    #[test]
    fn what_is_there_is_always_there() {
        let kept = Kept::<u32, u32>::new();
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..20_000).for_each(|i| assert_eq!(kept.get(i % 8, || Ok(i % 8)).as_deref(), Ok(&(i % 8)))));
            }
            for key in 0..8 {
                while !kept.has(&key) {
                    std::thread::yield_now();
                }
            }
            (0..20_000).for_each(|i| assert!(kept.has(&(i % 8))));
        });
        assert_eq!(kept.counts().misses, 8);
    }
}
