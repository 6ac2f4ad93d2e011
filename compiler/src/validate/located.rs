//! naga's error about a linked module, in the authors' files.

use std::ops::Range;
use std::sync::Arc;

use naga::valid::ValidationError;
use naga::{Block, Expression, Function, Module, SampleLevel, ShaderStage, Span, Statement, WithSpan};

use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::parse::{chain, labelled, readable};
use crate::plan::{ITEMS, Plan};

/// A place in an author's file.
type Place<'p> = (&'p Arc<SourceFile>, Range<usize>);

/// naga's error about what was linked, at its places in the authors' files.
pub(crate) fn located(plan: &Plan, module: &Module, error: &WithSpan<ValidationError>) -> Report {
    let home = match error.as_inner() {
        ValidationError::Function { handle, .. } => plan.home_of(*handle),
        ValidationError::EntryPoint { stage, name, .. } => plan.home_of_entry(name, *stage),
        _ => None,
    };
    if let ValidationError::EntryPoint { stage, name, .. } = error.as_inner() {
        let entry = module.entry_points.iter().find(|e| e.stage == *stage && e.name == *name);
        let linked = Linked {
            plan,
            module,
            stage: *stage,
        };
        if let Some((what, needed, place)) = entry.and_then(|e| linked.foreign(&e.function, home)) {
            let mut diagnostic = Diagnostic::new(
                codes::WRONG_STAGE,
                format!("{what} in the {} stage `{name}`: only {needed} stages have that", word(*stage)),
            );
            if let Some((file, range)) = place {
                diagnostic = diagnostic.at(file, range, "used here");
            }
            let root = plan.tree.place(0);
            return diagnostic
                .at(&root.file, root.name_span(), "the root of this tree has the stage")
                .note("the module is valid by itself: it does not fit into this tree")
                .into();
        }
    }
    let diagnostic = Diagnostic::new(codes::LINKED_INVALID, readable(&chain(error.as_inner()), module));
    let mut diagnostic = labelled(diagnostic, error, &|range| locate(plan, home, range));
    if diagnostic.labels.is_empty() {
        let root = plan.tree.place(0);
        diagnostic = diagnostic.at(&root.file, root.name_span(), "linking this tree");
    }
    diagnostic
        .note("the modules are valid each by itself, but not linked together")
        .into()
}

/// The author's place of a span of the linked module: of an item, or within a function of a home.
fn locate(plan: &Plan, home: Option<usize>, range: Range<usize>) -> Option<Place<'_>> {
    if range.start < ITEMS as usize {
        return plan.homes[home?].unit.composed.locate(range);
    }
    let home = plan.homes.iter().rev().find(|h| h.base as usize <= range.start)?;
    let base = home.base as usize;
    home.unit.composed.locate(range.start - base..range.end.saturating_sub(base))
}

fn word(stage: ShaderStage) -> &'static str {
    match stage {
        ShaderStage::Vertex => "vertex",
        ShaderStage::Fragment => "fragment",
        ShaderStage::Compute => "compute",
        _ => "other",
    }
}

/// A linked module that a stage does not fit into.
struct Linked<'p> {
    plan: &'p Plan,
    module: &'p Module,
    stage: ShaderStage,
}

/// What a stage reaches that it does not have: what it is, the stage that has it, and where.
type Foreign<'p> = (&'static str, &'static str, Option<Place<'p>>);

impl<'p> Linked<'p> {
    fn place(&self, home: Option<usize>, span: Span) -> Option<Place<'p>> {
        locate(self.plan, home, span.to_range()?)
    }

    /// What it reaches in a function of a home.
    fn foreign(&self, function: &Function, home: Option<usize>) -> Option<Foreign<'p>> {
        if self.stage != ShaderStage::Fragment {
            let found = function.expressions.iter().find_map(|(handle, expression)| {
                let what = match expression {
                    Expression::Derivative { .. } => "a derivative",
                    Expression::ImageSample {
                        level: SampleLevel::Auto | SampleLevel::Bias(_),
                        ..
                    } => "sampling that chooses its mip level",
                    _ => return None,
                };
                Some((what, "fragment", self.place(home, function.expressions.get_span(handle))))
            });
            if found.is_some() {
                return found;
            }
        }
        self.statements(&function.body, home)
    }

    fn statements(&self, block: &Block, home: Option<usize>) -> Option<Foreign<'p>> {
        let inner = |block: &Block| self.statements(block, home);
        block.span_iter().find_map(|(statement, &span)| match statement {
            Statement::Kill if self.stage != ShaderStage::Fragment => Some(("`discard`", "fragment", self.place(home, span))),
            Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) | Statement::WorkGroupUniformLoad { .. }
                if self.stage != ShaderStage::Compute =>
            {
                Some(("a barrier", "compute", self.place(home, span)))
            }
            Statement::Block(block) => inner(block),
            Statement::If { accept, reject, .. } => inner(accept).or_else(|| inner(reject)),
            Statement::Switch { cases, .. } => cases.iter().find_map(|c| inner(&c.body)),
            Statement::Loop { body, continuing, .. } => inner(body).or_else(|| inner(continuing)),
            Statement::Call { function, .. } => self.foreign(&self.module.functions[*function], self.plan.home_of(*function)),
            _ => None,
        })
    }
}
