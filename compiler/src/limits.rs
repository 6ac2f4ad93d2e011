//! Limits of what is read. Each is declared here, has a code of its own, and is far above what real input needs:
//! they exist so that no input can exhaust the stack, the memory or a person's patience.

use std::ops::Range;
use std::sync::Arc;

use crate::diagnostics::{Diagnostic, SourceFile, codes};
use crate::manifest::Locator;

/// Largest file, in bytes ([`codes::FILE_TOO_LARGE`]).
pub const FILE_SIZE: usize = 1 << 20;
/// Deepest nesting of brackets in RON ([`codes::NESTING_TOO_DEEP`]).
pub const RON_NESTING: usize = 64;
/// Deepest nesting of brackets in WGSL ([`codes::NESTING_TOO_DEEP`]). WGSL guarantees 127 for braces.
pub const WGSL_NESTING: usize = 127;
/// Deepest expression in WGSL: operators, members and indices that apply to one another, enclosing brackets included
/// ([`codes::NESTING_TOO_DEEP`]). naga lowers expressions recursively.
pub const WGSL_EXPRESSION: usize = 1024;
/// Most declarations in one WGSL file ([`codes::LIST_TOO_LONG`]). naga sorts declarations recursively by their dependencies.
pub const WGSL_DECLARATIONS: usize = 4096;
/// Most elements of one list, map or struct in RON ([`codes::LIST_TOO_LONG`]).
pub const LIST_LENGTH: usize = 1024;
/// Deepest module tree of a recipe, defaults included ([`codes::TREE_TOO_DEEP`]).
pub const TREE_DEPTH: usize = 32;
/// Most module instances of a recipe, defaults included ([`codes::TOO_MANY_INSTANCES`]).
pub const INSTANCES: usize = 1024;
/// Most permutations of a space that are drawn at once ([`codes::SPACE_UNCOUNTABLE`]): their numbers are all held.
pub const DRAWN: usize = 1 << 24;
/// Most sets of constants for which a module's parsed text is kept; the oldest goes then, and is parsed again when it is needed.
pub const VARIANTS: usize = 64;
/// Most forms of a function, with this or that of it dead, that are kept for the next permutation; the oldest goes then.
pub const TEMPLATES: usize = 8;

/// Checks a file's size.
///
/// # Errors
/// It is larger than [`FILE_SIZE`].
pub fn check_size(file: &Arc<SourceFile>) -> Result<(), Diagnostic> {
    if file.text.len() <= FILE_SIZE {
        return Ok(());
    }
    // The place is left out: it would render a line of a file that is mostly not meant to be read.
    Err(Diagnostic::new(
        codes::FILE_TOO_LARGE,
        format!("`{}` is too large: {} bytes", file.name, file.text.len()),
    )
    .note(format!("at most {FILE_SIZE} bytes are read")))
}

/// Checks size, nesting and list lengths of a RON text, valid or not.
///
/// # Errors
/// It exceeds [`FILE_SIZE`], [`RON_NESTING`] or [`LIST_LENGTH`].
pub fn check_ron(file: &Arc<SourceFile>, locator: &Locator) -> Result<(), Diagnostic> {
    check_size(file)?;
    if let Some(span) = locator.deeper_than(RON_NESTING) {
        return Err(too_deep(file, span, RON_NESTING));
    }
    if let Some(span) = locator.longer_than(LIST_LENGTH) {
        return Err(Diagnostic::new(codes::LIST_TOO_LONG, "a list is too long")
            .at(file, span.start..span.start + 1, "begins here")
            .note(format!("at most {LIST_LENGTH} elements are taken")));
    }
    Ok(())
}

fn too_deep(file: &Arc<SourceFile>, span: Range<usize>, limit: usize) -> Diagnostic {
    Diagnostic::new(codes::NESTING_TOO_DEEP, "brackets are nested too deep")
        .at(file, span, format!("level {}", limit + 1))
        .note(format!("at most {limit} levels are taken"))
}

/// Checks what could exhaust the stack when WGSL is parsed: size, nesting, long expressions, chains of `else`, number of
/// declarations. To be called before the text is given to naga. It knows comments, but nothing else of the grammar.
///
/// # Errors
/// The text exceeds [`FILE_SIZE`], [`WGSL_NESTING`], [`WGSL_EXPRESSION`] or [`WGSL_DECLARATIONS`].
pub fn check_wgsl(file: &Arc<SourceFile>) -> Result<(), Diagnostic> {
    check_size(file)?;
    let text = file.text.as_bytes();
    // Operators so far in the current expression, and `else`s of the current chain, of each open bracket and of the file.
    let mut levels = vec![(0usize, 0usize)];
    let mut total = 0; // the sum over all levels
    let mut declarations = 0;
    let mut after_block = false;
    let mut at = 0;
    while at < text.len() {
        let rest = &text[at..];
        let width = if rest.starts_with(b"//") {
            rest.iter().position(|&b| b == b'\n').unwrap_or(rest.len())
        } else if rest.starts_with(b"/*") {
            block_comment(rest)
        } else {
            word(rest).max(1)
        };
        let token = &rest[..width];
        let span = at..at + width;
        at += width;
        if token.starts_with(b"//") || token.starts_with(b"/*") || token[0].is_ascii_whitespace() {
            continue;
        }
        // The file's own level is never popped, so there is always a last one.
        let Some(top) = levels.last_mut() else { break };
        if std::mem::take(&mut after_block) && token != b"else" {
            total -= std::mem::take(&mut top.1);
        }
        match token[0] {
            b'(' | b'[' | b'{' => {
                if levels.len() > WGSL_NESTING {
                    return Err(too_deep(file, span, WGSL_NESTING));
                }
                levels.push((0, 0));
            }
            b')' | b']' | b'}' => {
                if levels.len() > 1 {
                    let closed = levels.pop().unwrap_or_default();
                    total -= closed.0 + closed.1;
                }
                let outer = levels.len() == 1;
                if let Some(top) = levels.last_mut() {
                    match token[0] {
                        b']' => {
                            top.0 += 1;
                            total += 1;
                        }
                        b'}' => {
                            total -= std::mem::take(&mut top.0);
                            declarations += usize::from(outer);
                            after_block = true;
                        }
                        _ => {}
                    }
                }
            }
            b';' | b',' => {
                total -= std::mem::take(&mut top.0);
                declarations += usize::from(levels.len() == 1);
            }
            b'+' | b'-' | b'*' | b'/' | b'%' | b'&' | b'|' | b'^' | b'~' | b'!' | b'<' | b'>' | b'=' | b'.' => {
                top.0 += 1;
                total += 1;
            }
            _ if token == b"else" => {
                top.1 += 1;
                total += 1;
            }
            _ => {}
        }
        if total > WGSL_EXPRESSION {
            return Err(
                Diagnostic::new(codes::NESTING_TOO_DEEP, "an expression or a chain of `else` is too long")
                    .at(file, span, format!("operator {}", WGSL_EXPRESSION + 1))
                    .note(format!(
                        "at most {WGSL_EXPRESSION} operators, members and indices may apply to one another: name parts of it with `let`"
                    )),
            );
        }
        if declarations > WGSL_DECLARATIONS {
            return Err(Diagnostic::new(codes::LIST_TOO_LONG, "too many declarations in one file")
                .at(file, span, "one too many")
                .note(format!("at most {WGSL_DECLARATIONS} are taken")));
        }
    }
    Ok(())
}

/// Length of the word, or of the number with its point and exponent's letter, that the text begins with.
fn word(text: &[u8]) -> usize {
    let digits = text[0].is_ascii_digit();
    text.iter()
        .position(|&b| !(b.is_ascii_alphanumeric() || b == b'_' || b >= 0x80 || digits && b == b'.'))
        .unwrap_or(text.len())
}

/// Length of the block comment, which may hold others, that the text begins with.
fn block_comment(text: &[u8]) -> usize {
    let (mut level, mut at) = (0usize, 0);
    while at < text.len() {
        if text[at..].starts_with(b"/*") {
            level += 1;
            at += 2;
        } else if text[at..].starts_with(b"*/") {
            level -= 1;
            at += 2;
            if level == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::diagnostics::Report;

    fn rendered(result: Result<(), Diagnostic>) -> String {
        result.map_or_else(|d| Report::from(d).render(), |()| String::new())
    }

    fn wgsl(text: impl Into<String>) -> String {
        rendered(check_wgsl(&SourceFile::new("m.wgsl", text)))
    }

    /// Catches a size limit that is not applied or is off by one.
    #[test]
    fn size() {
        assert_eq!(wgsl(" ".repeat(FILE_SIZE)), "");
        assert_eq!(
            wgsl(" ".repeat(FILE_SIZE + 1)),
            "error[SW0701]: `m.wgsl` is too large: 1048577 bytes\n = at most 1048576 bytes are read\n"
        );
    }

    /// Catches a nesting limit that is off by one, that counts comments, or that does not come down again.
    #[test]
    fn nesting() {
        let nested = |n: usize| format!("const a = {}1{};", "(".repeat(n), ")".repeat(n));
        assert_eq!(wgsl(nested(WGSL_NESTING)), "");
        assert_eq!(wgsl(nested(WGSL_NESTING).repeat(9)), "");
        assert_eq!(wgsl(format!("/* {0} /* {0} */ */ // {0}\n", "(".repeat(999))), "");
        let deep = wgsl(format!("const a =\n{}1{};", "(".repeat(128), ")".repeat(128)));
        let expected = format!(
            "error[SW0702]: brackets are nested too deep
  --> m.wgsl:2:128
  |
2 | {}1{};
  | {}^ level 128
  |
  = at most 127 levels are taken
",
            "(".repeat(128),
            ")".repeat(128),
            " ".repeat(127)
        );
        assert_eq!(deep, expected);
    }

    /// Catches flat text that becomes deep syntax: sums, prefix operators, members, indices, templates, `else if`.
    #[test]
    fn long_expressions() {
        for (unit, tail) in [("1+", "1"), ("-", "1"), ("a.b", ""), ("array<", ""), ("[0]", "")] {
            let text = format!("const a = {}{tail};", unit.repeat(WGSL_EXPRESSION + 1));
            assert!(wgsl(text).starts_with("error[SW0702]: an expression"), "{unit}");
            let text = format!("const a = {}{tail};", unit.repeat(WGSL_EXPRESSION - 1));
            assert_eq!(wgsl(text), "", "{unit}");
        }
        let chain = |n: usize| format!("fn f() {{ if a {{}} {} }}", "else if a {} ".repeat(n));
        assert!(wgsl(chain(WGSL_EXPRESSION + 1)).starts_with("error[SW0702]: an expression"));
        assert_eq!(wgsl(chain(WGSL_EXPRESSION)), "");
        assert_eq!(wgsl(format!("fn f() {{ {} }}", "if a {} else {} ".repeat(2000))), "");
        assert_eq!(wgsl("const a = f(1+1, b[1+1]);".repeat(WGSL_EXPRESSION)), "");
        assert_eq!(wgsl(format!("const t = array({});", "-1.5, ".repeat(5000))), "");
    }

    /// Catches a file whose declarations could form a chain too long for naga's recursive sort.
    #[test]
    fn declarations() {
        assert_eq!(wgsl("const a=b;".repeat(WGSL_DECLARATIONS)), "");
        let expected = "\
error[SW0706]: too many declarations in one file
     --> m.wgsl:4097:10
     |
4097 | const a=b;
     |          ^ one too many
     |
     = at most 4096 are taken
";
        assert_eq!(wgsl("const a=b;\n".repeat(WGSL_DECLARATIONS + 1)), expected);
    }

    proptest! {
        /// Catches unbalanced or unfinished text that makes the checker underflow or read past the end.
        #[test]
        fn never_panics(text in "([(){}\\[\\];,+./*<>=!-]|else|if|a|1|é|\n| |//|/\\*|\\*/){0,200}") {
            wgsl(text);
        }
    }
}
