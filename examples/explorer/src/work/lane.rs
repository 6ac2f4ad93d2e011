//! A lane: jobs of several kinds, one at a time.

use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indexmap::IndexMap;
use web_time::Instant;

use super::{Bench, News};

/// A lane without a thread takes no more of a frame of the window than this and its last step.
const BUDGET: Duration = Duration::from_millis(6);
/// Nor does it do more steps: one that waits for the GPU is over at once.
const MOST_STEPS: usize = 32;

/// How far a job is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Progress {
    /// What is being done.
    pub what: String,
    /// Steps done.
    pub done: usize,
    /// All steps.
    pub of: usize,
}

/// What a step leaves: more to do, or nothing.
pub type Step = ControlFlow<(), Progress>;

/// Something that takes a while.
pub trait Job: Send {
    /// Its kind: of a kind the newest is done.
    fn kind(&self) -> &'static str;
    /// Does a part of it. `cancel` is set where the rest is not wanted any more; a long step may look at it.
    fn step(&mut self, bench: &mut Bench, cancel: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step;
}

struct Running {
    kind: &'static str,
    cancel: Arc<AtomicBool>,
    progress: Option<Progress>,
}

#[derive(Default)]
struct State {
    waiting: IndexMap<&'static str, Box<dyn Job>>,
    running: Option<Running>,
    closing: bool,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    news: Mutex<Sender<News>>,
    /// Called when there is news.
    wake: Box<dyn Fn() + Send + Sync>,
}

/// A lane with its worker. Dropped, it ends the job that runs after its step.
pub struct Lane {
    shared: Arc<Shared>,
    news: Receiver<News>,
    /// Where no thread could be had.
    own: Option<(Bench, Option<Box<dyn Job>>)>,
    #[cfg(not(target_arch = "wasm32"))]
    thread: Option<std::thread::JoinHandle<()>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Lane {
    /// A lane on this bench. `wake` is called from the lane's thread when there is news.
    pub fn new(name: &str, bench: Bench, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (sender, news) = channel();
        let shared = Arc::new(Shared {
            state: Mutex::default(),
            changed: Condvar::new(),
            news: Mutex::new(sender),
            wake: Box::new(wake),
        });
        #[cfg(target_arch = "wasm32")]
        {
            let _ = name;
            Self {
                shared,
                news,
                own: Some((bench, None)),
            }
        }
        #[cfg(not(target_arch = "wasm32"))]
        {
            let of_thread = Arc::clone(&shared);
            let gpu = bench.gpu().clone();
            let spawned = std::thread::Builder::new()
                .name(name.to_owned())
                // Deep trees of defaults are walked recursively.
                .stack_size(8 << 20)
                .spawn(move || work(&of_thread, bench));
            let own = spawned.as_ref().err().map(|error| {
                log::warn!("no thread for {name}, its work is done by the window: {error}");
                (Bench::new(gpu), None)
            });
            Self {
                shared,
                news,
                own,
                thread: spawned.ok(),
            }
        }
    }

    /// Has a job done, instead of one of its kind that waits or runs.
    pub fn ask(&self, job: impl Job + 'static) {
        let mut state = lock(&self.shared.state);
        let kind = job.kind();
        if let Some(running) = state.running.as_ref().filter(|running| running.kind == kind) {
            running.cancel.store(true, Ordering::Relaxed);
        }
        state.waiting.insert(kind, Box::new(job));
        drop(state);
        self.shared.changed.notify_all();
    }

    /// Ends the jobs of a kind, the one that runs after its step.
    pub fn cancel(&self, kind: &str) {
        let mut state = lock(&self.shared.state);
        state.waiting.shift_remove(kind);
        if let Some(running) = state.running.as_ref().filter(|running| running.kind == kind) {
            running.cancel.store(true, Ordering::Relaxed);
        }
    }

    /// What the job that runs has told of itself, by its kind.
    pub fn progress(&self) -> Option<(&'static str, Option<Progress>)> {
        let state = lock(&self.shared.state);
        state.running.as_ref().map(|running| (running.kind, running.progress.clone()))
    }

    /// Whether anything of a kind waits or runs.
    pub fn is_busy(&self, kind: &str) -> bool {
        let state = lock(&self.shared.state);
        state.waiting.contains_key(kind) || state.running.as_ref().is_some_and(|running| running.kind == kind)
    }

    /// Whether anything waits or runs.
    pub fn is_idle(&self) -> bool {
        let state = lock(&self.shared.state);
        state.waiting.is_empty() && state.running.is_none()
    }

    /// What jobs have told since the last call. Where the lane has no thread, some steps are done first.
    pub fn news(&mut self) -> Vec<News> {
        if let Some((bench, job)) = &mut self.own {
            let start = Instant::now();
            for _ in 0..MOST_STEPS {
                if !step(&self.shared, bench, job) || start.elapsed() > BUDGET {
                    break;
                }
            }
        }
        self.news.try_iter().collect()
    }
}

impl Drop for Lane {
    fn drop(&mut self) {
        let mut state = lock(&self.shared.state);
        state.closing = true;
        state.waiting.clear();
        if let Some(running) = &state.running {
            running.cancel.store(true, Ordering::Relaxed);
        }
        drop(state);
        self.shared.changed.notify_all();
        #[cfg(not(target_arch = "wasm32"))]
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            log::error!("a lane's thread has panicked");
        }
    }
}

#[cfg(not(target_arch = "wasm32"))]
fn work(shared: &Shared, mut bench: Bench) {
    let mut job = None;
    loop {
        if !step(shared, &mut bench, &mut job) {
            let mut state = lock(&shared.state);
            while state.waiting.is_empty() && !state.closing {
                state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
            if state.closing {
                return;
            }
        }
    }
}

/// Does a step of the job, or of the next one; whether there was one.
fn step(shared: &Shared, bench: &mut Bench, job: &mut Option<Box<dyn Job>>) -> bool {
    let mut state = lock(&shared.state);
    if job.is_none() {
        *job = state.waiting.shift_remove_index(0).map(|(_, next)| next);
        state.running = job.as_ref().map(|job| Running {
            kind: job.kind(),
            cancel: Arc::default(),
            progress: None,
        });
    }
    let (Some(at_work), Some(running)) = (job.as_mut(), &state.running) else {
        return false;
    };
    let cancel = Arc::clone(&running.cancel);
    drop(state);
    let mut tell = |news| {
        // The receiver may be gone: then nobody wants to know.
        let _ = lock(&shared.news).send(news);
        (shared.wake)();
    };
    let result = if cancel.load(Ordering::Relaxed) {
        ControlFlow::Break(())
    } else {
        let kind = at_work.kind();
        catch_unwind(AssertUnwindSafe(|| at_work.step(bench, &cancel, &mut tell))).unwrap_or_else(|panic| {
            bench.reset();
            tell(News::Failed {
                what: kind,
                message: format!("this should not have happened: {}", said(panic.as_ref())),
            });
            ControlFlow::Break(())
        })
    };
    let mut state = lock(&shared.state);
    match result {
        ControlFlow::Continue(progress) => {
            if let Some(running) = &mut state.running {
                running.progress = Some(progress);
            }
        }
        ControlFlow::Break(()) => {
            state.running = None;
            *job = None;
        }
    }
    drop(state);
    (shared.wake)();
    true
}

/// What a panic said.
fn said(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("a panic")
}
