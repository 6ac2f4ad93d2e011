//! Many permutations to programs, on several threads.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::catalog::Catalog;
use crate::diagnostics::{Report, codes};
use crate::program::{Program, Recipe};

use super::Permutation;

/// Which passes of each permutation are compiled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Passes {
    /// One, `main` or `INSTANCE.PASS`; permutations without it have no program.
    One(String),
    /// The root's own and those that modules of the tree declare.
    All,
}

/// How many permutations are compiled.
pub struct Work<'a> {
    /// Which passes.
    pub passes: Passes,
    /// Number of threads; 0 for one a core.
    pub threads: usize,
    /// Set from elsewhere to stop: what is being compiled is finished, the rest is left.
    pub cancel: &'a AtomicBool,
    /// Told after each permutation how many are done, from any thread and not always in ascending order.
    pub progress: &'a (dyn Fn(usize) + Sync),
}

/// The programs of one permutation, by pass, or why one could not be made.
pub type Compiled = Vec<(String, Result<Program, Report>)>;

/// Compiles permutations and makes something small of each, in their order whatever the threads do. A permutation that fails is
/// a result like others. `None` where the work was cancelled before.
/// Where no threads can be started it is done on this one.
pub fn compile_all<T: Send>(
    catalog: &Catalog,
    permutations: &[Permutation],
    work: &Work,
    finish: impl Fn(&Permutation, Compiled) -> T + Sync,
) -> Vec<Option<T>> {
    let done = AtomicUsize::new(0);
    let one = |permutation: &Permutation| {
        if work.cancel.load(Ordering::Relaxed) {
            return None;
        }
        let result = finish(permutation, compile(catalog, &permutation.recipe, &work.passes));
        (work.progress)(done.fetch_add(1, Ordering::Relaxed) + 1);
        Some(result)
    };
    match rayon::ThreadPoolBuilder::new().num_threads(work.threads).build() {
        Ok(pool) => pool.install(|| permutations.par_iter().map(one).collect()),
        Err(_) => permutations.iter().map(one).collect(),
    }
}

fn compile(catalog: &Catalog, recipe: &Recipe, passes: &Passes) -> Compiled {
    let main = "main".to_owned();
    match passes {
        Passes::One(pass) => match catalog.compile(recipe, pass) {
            Err(report) if report.diagnostics.iter().any(|d| d.code == codes::UNKNOWN_PASS_OF_RECIPE) => Vec::new(),
            result => vec![(pass.clone(), result)],
        },
        Passes::All => {
            let program = match catalog.compile(recipe, &main) {
                Ok(program) => program,
                Err(report) => return vec![(main, Err(report))],
            };
            let declared = program.reflection().passes.iter();
            let own: Vec<String> = declared.map(|pass| format!("{}.{}", pass.instance, pass.name)).collect();
            let mut compiled = vec![(main, Ok(program))];
            for pass in own {
                let result = catalog.compile(recipe, &pass);
                compiled.push((pass, result));
            }
            compiled
        }
    }
}
