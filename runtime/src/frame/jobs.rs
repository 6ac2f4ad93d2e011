//! Work in the background: what the latest frame wants, done in order by threads of their own.

use std::collections::{HashMap, HashSet, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::thread::JoinHandle;

use super::needs::PipelineKey;
use crate::gpu::{GpuError, RuntimeError, lock};

/// What a job makes.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Task {
    /// The program of a recipe, as text, and a pass.
    Program(String, String),
    /// A pipeline.
    Pipeline(PipelineKey),
}

/// Makes it.
pub(crate) type Job = Box<dyn FnOnce() -> Result<(), RuntimeError> + Send>;

#[derive(Default)]
struct State {
    queue: VecDeque<(Task, Job)>,
    running: HashSet<Task>,
    failed: HashMap<Task, Arc<RuntimeError>>,
    closing: bool,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

/// Jobs and the threads that do them. Dropped, it waits for the jobs that are running and forgets the others.
#[derive(Default)]
pub(crate) struct Jobs {
    shared: Arc<Shared>,
    threads: Vec<JoinHandle<()>>,
}

impl Jobs {
    /// From now on these are wanted, in this order, and nothing else: jobs that nobody began and that are not among them are forgotten.
    /// What is running or has failed is not begun again.
    pub fn want(&mut self, wanted: Vec<(Task, Job)>) -> Result<(), GpuError> {
        let mut state = lock(&self.shared.state);
        let State { running, failed, .. } = &*state;
        let queue = wanted
            .into_iter()
            .filter(|(task, _)| !running.contains(task) && !failed.contains_key(task));
        state.queue = queue.collect();
        let is_idle = state.queue.is_empty();
        drop(state);
        self.shared.changed.notify_all();
        if is_idle { Ok(()) } else { self.start() }
    }

    /// One thread is left to the frame.
    fn start(&mut self) -> Result<(), GpuError> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        while self.threads.len() < cores.saturating_sub(1).clamp(1, 8) {
            let shared = Arc::clone(&self.shared);
            let thread = std::thread::Builder::new().name("shadewright".into()).spawn(move || work(&shared));
            match thread {
                Ok(thread) => self.threads.push(thread),
                Err(_) if !self.threads.is_empty() => break,
                Err(error) => {
                    return Err(GpuError::Driver {
                        what: "compiling in the background".into(),
                        message: error.to_string(),
                    });
                }
            }
        }
        Ok(())
    }

    /// Why a job failed, if it did.
    pub fn failure(&self, task: &Task) -> Option<Arc<RuntimeError>> {
        lock(&self.shared.state).failed.get(task).map(Arc::clone)
    }

    /// Waits until nothing is wanted or running.
    pub fn wait(&self) {
        let mut state = lock(&self.shared.state);
        while !(state.queue.is_empty() && state.running.is_empty()) {
            state = self.shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Forgets what nobody began, and all failures.
    pub fn cancel(&self) {
        let mut state = lock(&self.shared.state);
        state.queue.clear();
        state.failed.clear();
        drop(state);
        self.shared.changed.notify_all();
    }
}

impl Drop for Jobs {
    fn drop(&mut self) {
        let mut state = lock(&self.shared.state);
        state.closing = true;
        state.queue.clear();
        drop(state);
        self.shared.changed.notify_all();
        for thread in self.threads.drain(..) {
            if thread.join().is_err() {
                log::error!("a thread that compiles has panicked");
            }
        }
    }
}

/// What each thread does until the end.
fn work(shared: &Shared) {
    let mut state = lock(&shared.state);
    while !state.closing {
        let Some((task, job)) = state.queue.pop_front() else {
            state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        // Another thread may be at it: a frame wanted it again meanwhile.
        if !state.running.insert(task.clone()) {
            continue;
        }
        drop(state);
        let result = catch_unwind(AssertUnwindSafe(job)).unwrap_or_else(|_| {
            Err(RuntimeError::Gpu(GpuError::Driver {
                what: "compiling in the background".into(),
                message: "panicked".into(),
            }))
        });
        state = lock(&shared.state);
        state.running.remove(&task);
        if let Err(error) = result {
            log::warn!("compiling in the background: {error}");
            state.failed.insert(task, Arc::new(error));
        }
        shared.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    fn task(name: &str) -> Task {
        Task::Program(name.into(), "main".into())
    }

    /// A job that tells its name when it runs.
    fn tell(name: &str, to: &mpsc::Sender<String>) -> (Task, Job) {
        let (own, to) = (name.to_owned(), to.clone());
        let job = move || {
            let _ = to.send(own);
            Ok(())
        };
        (task(name), Box::new(job))
    }

    /// A job that tells that it began, and runs until it is let go.
    fn held(name: &str, to: &mpsc::Sender<String>) -> ((Task, Job), mpsc::Sender<()>) {
        let (own, to) = (name.to_owned(), to.clone());
        let (go, wait) = mpsc::channel();
        let job = move || {
            let _ = to.send(own);
            let _ = wait.recv();
            Ok(())
        };
        ((task(name), Box::new(job)), go)
    }

    /// As many jobs that are held as there can be threads, all of them begun.
    fn busy(jobs: &mut Jobs, more: Vec<(Task, Job)>) -> Vec<mpsc::Sender<()>> {
        let (to, begun) = mpsc::channel();
        let threads = std::thread::available_parallelism()
            .map_or(1, usize::from)
            .saturating_sub(1)
            .clamp(1, 8);
        let (mut wanted, go): (Vec<_>, Vec<_>) = (0..threads).map(|i| held(&format!("held {i}"), &to)).unzip();
        wanted.extend(more);
        jobs.want(wanted).unwrap();
        (0..threads).for_each(|_| assert!(begun.recv().is_ok()));
        go
    }

    /// Catches a cancelled job that runs, one that a later frame no longer wants, and a running job that is begun a second time.
    #[test]
    fn only_what_is_wanted_runs() {
        let mut jobs = Jobs::default();
        let (to, told) = mpsc::channel();
        let go = busy(&mut jobs, vec![tell("cancelled", &to)]);
        jobs.cancel();
        jobs.want(vec![tell("stale", &to)]).unwrap();
        jobs.want(vec![tell("held 0", &to), tell("wanted", &to)]).unwrap();
        drop(go);
        jobs.wait();
        drop(to);
        assert_eq!(told.iter().collect::<Vec<_>>(), ["wanted"]);
    }

    /// Catches a failure that is lost or tried again every frame, and a panic that takes the thread along.
    #[test]
    fn failures_are_kept_until_they_are_forgotten() {
        let mut jobs = Jobs::default();
        let fail = || -> (Task, Job) { (task("bad"), Box::new(|| Err(GpuError::Lost("planted".into()).into()))) };
        jobs.want(vec![fail(), (task("worse"), Box::new(|| panic!("planted")))]).unwrap();
        jobs.wait();
        assert_eq!(jobs.failure(&task("bad")).unwrap().to_string(), "the GPU was lost: planted");
        assert_eq!(
            jobs.failure(&task("worse")).unwrap().to_string(),
            "compiling in the background: the driver failed: panicked"
        );
        let (to, told) = mpsc::channel();
        jobs.want(vec![tell("bad", &to)]).unwrap();
        jobs.wait();
        jobs.cancel();
        assert!(jobs.failure(&task("bad")).is_none());
        jobs.want(vec![tell("bad", &to)]).unwrap();
        jobs.wait();
        drop(to);
        assert_eq!(told.iter().count(), 1, "only after it was forgotten");
    }

    /// Catches a drop that waits for ever, or for jobs that nobody began.
    #[test]
    fn dropping_waits_for_what_runs_only() {
        let mut jobs = Jobs::default();
        let (to, told) = mpsc::channel();
        let go = busy(&mut jobs, vec![tell("never", &to)]);
        let later = std::thread::spawn(move || {
            std::thread::sleep(std::time::Duration::from_millis(20));
            drop(go);
        });
        drop(jobs);
        later.join().unwrap();
        drop(to);
        assert_eq!(told.iter().count(), 0);
        drop(Jobs::default());
    }
}
