//! What a probed function holds, without what the probe adds.

use shadewright_compiler::naga::{Block, Function, Handle, Statement};
use shadewright_evaluate::cost::cost_of_function;
use shadewright_evaluate::kind::{Counts, Kind};
use shadewright_runtime::probe::Probe;

use crate::data::{Cost, Executed};

/// Cost of the function that a probe calls.
pub(crate) fn cost(probe: &Probe) -> Cost {
    let validated = probe.program().validated();
    let module = validated.module();
    // The entry point is the compiler's own: its one call is of the function.
    let called = module.entry_points.first().and_then(|entry| called(&entry.function.body));
    called.map_or_else(Cost::default, |function| cost_of_function(module, validated.info(), function).cost)
}

fn called(block: &Block) -> Option<Handle<Function>> {
    block.iter().find_map(|statement| match statement {
        Statement::Call { function, .. } => Some(*function),
        Statement::Block(inner) => called(inner),
        Statement::If { accept, reject, .. } => called(accept).or_else(|| called(reject)),
        _ => None,
    })
}

/// What calls executed, one of each row.
pub(crate) fn executed(counts: &[Counts]) -> Executed {
    let rows = counts.len().max(1) as f64;
    let mean = |of: &dyn Fn(&Counts) -> f64| counts.iter().map(of).sum::<f64>() / rows;
    Executed {
        mean: mean(&Counts::weighted),
        max: counts.iter().map(Counts::weighted).fold(0.0, f64::max),
        trips: mean(&|counts| counts[Kind::Trip] as f64),
        texture: mean(&|counts| counts[Kind::Texture] as f64),
    }
}
