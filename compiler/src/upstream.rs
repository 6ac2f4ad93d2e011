//! Calls into naga, and into what else reads shaders for us, that no input may turn into a crash.

use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::diagnostics::Diagnostic;

/// Stack of the thread on which naga works: its parser and writers recurse as deep as [`crate::limits`] lets expressions nest.
const STACK: usize = 256 << 20;

/// Name of that thread. Rust's default panic hook prints what panics there; a program that wants only the diagnostic installs a hook
/// that passes over threads of this name.
pub const THREAD: &str = "shadewright-naga";

/// Runs work of naga's on a large stack and turns a panic in it into a diagnostic with this code.
///
/// # Errors
/// It panicked; `what` says what it was doing.
pub fn guarded<T: Send>(code: &'static str, what: &str, work: impl FnOnce() -> T + Send) -> Result<T, Diagnostic> {
    guarded_in("naga", code, what, work)
}

/// As [`guarded`], for work of another crate, called by its name.
///
/// # Errors
/// It panicked; `what` says what it was doing.
pub fn guarded_in<T: Send>(upstream: &str, code: &'static str, what: &str, work: impl FnOnce() -> T + Send) -> Result<T, Diagnostic> {
    let caught = || catch_unwind(AssertUnwindSafe(work));
    let result = if cfg!(target_family = "wasm") {
        // No threads there, and a panic ends the program.
        caught()
    } else {
        std::thread::scope(|scope| {
            let thread = std::thread::Builder::new()
                .name(THREAD.to_owned())
                .stack_size(STACK)
                .spawn_scoped(scope, caught);
            match thread.map(std::thread::ScopedJoinHandle::join) {
                Ok(Ok(result)) => result,
                Ok(Err(panic)) => Err(panic),
                Err(error) => Err(Box::new(format!("no thread to work on: {error}")) as Box<dyn std::any::Any + Send>),
            }
        })
    };
    result.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason given");
        Diagnostic::new(code, format!("{upstream} gave up while {what}"))
            .note(text.lines().next().unwrap_or_default())
            .note(format!(
                "this is an error of {upstream}, which reads and writes shaders for us; a simpler formulation may avoid it"
            ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostics::{Report, codes};

    /// Catches a panic that comes through, or whose reason is lost.
    #[test]
    fn panics_become_diagnostics() {
        let found = guarded(codes::UPSTREAM_PANIC, "counting", || panic!("at {}", 3)).map(|(): ()| ());
        let expected = "\
error[SW0705]: naga gave up while counting
 = at 3
 = this is an error of naga, which reads and writes shaders for us; a simpler formulation may avoid it
";
        assert_eq!(found.map_err(|d| Report::from(d).render()), Err(expected.to_owned()));
    }

    /// Catches a stack or a limit that let the deepest accepted text overflow, and a text that is refused at once.
    #[test]
    fn the_deepest_accepted_text_is_parsed() {
        let deep = |n: usize| format!("fn f(a: f32) -> f32 {{ return {}a; }}", "a + ".repeat(n));
        let chain = |n: usize| format!("fn f(a: bool) {{ if a {{}} {} }}", "else if a {} ".repeat(n));
        let order = |n: usize| (0..n).map(|i| format!("const c{i}=c{};", i + 1)).collect::<String>() + &format!("const c{n}=1i;");
        for text in [deep(1000), chain(1000), order(4000)] {
            let file = crate::diagnostics::SourceFile::new("m.wgsl", text);
            crate::limits::check_wgsl(&file).unwrap();
            let module = guarded(codes::UPSTREAM_PANIC, "parsing", || naga::front::wgsl::parse_str(&file.text));
            let module = module.unwrap().unwrap_or_else(|error| panic!("{}", error.message()));
            let valid = guarded(codes::UPSTREAM_PANIC, "validating", || crate::validate::validate(module).is_ok());
            assert_eq!(valid, Ok(true));
        }
    }
}
