//! naga's error about a linked module, in the authors' files.

use std::ops::Range;
use std::sync::Arc;

use naga::valid::ValidationError;
use naga::{Block, Expression, Function, Module, SampleLevel, ShaderStage, Span, Statement, WithSpan};

use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::parse::{chain, labelled, readable};
use crate::plan::Plan;

/// naga's error about what was linked, at its places in the authors' files.
pub(crate) fn located(plan: &Plan, module: &Module, error: &WithSpan<ValidationError>) -> Report {
    let locate = |range: Range<usize>| locate(plan, range);
    if let ValidationError::EntryPoint { stage, name, .. } = error.as_inner() {
        let entry = module.entry_points.iter().find(|e| e.stage == *stage && e.name == *name);
        if let Some((what, needed, span)) = entry.and_then(|e| foreign(module, &e.function, *stage)) {
            let mut diagnostic = Diagnostic::new(
                codes::WRONG_STAGE,
                format!("{what} in the {} stage `{name}`: only {needed} stages have that", word(*stage)),
            );
            if let Some((file, range)) = span.to_range().and_then(locate) {
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
    let mut diagnostic = labelled(diagnostic, error, &locate);
    if diagnostic.labels.is_empty() {
        let root = plan.tree.place(0);
        diagnostic = diagnostic.at(&root.file, root.name_span(), "linking this tree");
    }
    diagnostic
        .note("the modules are valid each by itself, but not linked together")
        .into()
}

/// The author's place of a span of the linked module.
fn locate(plan: &Plan, range: Range<usize>) -> Option<(&Arc<SourceFile>, Range<usize>)> {
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

/// What a stage reaches that it does not have: what it is, the stage that has it, and where.
fn foreign(module: &Module, function: &Function, stage: ShaderStage) -> Option<(&'static str, &'static str, Span)> {
    if stage != ShaderStage::Fragment {
        let found = function.expressions.iter().find_map(|(handle, expression)| {
            let what = match expression {
                Expression::Derivative { .. } => "a derivative",
                Expression::ImageSample {
                    level: SampleLevel::Auto | SampleLevel::Bias(_),
                    ..
                } => "sampling that chooses its mip level",
                _ => return None,
            };
            Some((what, "fragment", function.expressions.get_span(handle)))
        });
        if found.is_some() {
            return found;
        }
    }
    statements(module, &function.body, stage)
}

fn statements(module: &Module, block: &Block, stage: ShaderStage) -> Option<(&'static str, &'static str, Span)> {
    block.span_iter().find_map(|(statement, &span)| match statement {
        Statement::Kill if stage != ShaderStage::Fragment => Some(("`discard`", "fragment", span)),
        Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) | Statement::WorkGroupUniformLoad { .. }
            if stage != ShaderStage::Compute =>
        {
            Some(("a barrier", "compute", span))
        }
        Statement::Block(inner) => statements(module, inner, stage),
        Statement::If { accept, reject, .. } => statements(module, accept, stage).or_else(|| statements(module, reject, stage)),
        Statement::Switch { cases, .. } => cases.iter().find_map(|c| statements(module, &c.body, stage)),
        Statement::Loop { body, continuing, .. } => statements(module, body, stage).or_else(|| statements(module, continuing, stage)),
        Statement::Call { function, .. } => foreign(module, &module.functions[*function], stage),
        _ => None,
    })
}
