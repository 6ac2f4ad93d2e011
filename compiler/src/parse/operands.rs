//! What expressions and statements depend on: one list of operands, for looking and for changing.

use naga::{AtomicFunction, Expression, GatherMode, Handle, ImageQuery, SampleLevel, Statement};

/// Writes a pair of visitors. The bodies are the same for shared and for mutable borrows; every expression is named, so
/// that a new kind of a new naga does not slip through.
macro_rules! visitors {
    ($(#[$doc:meta])* $expression:ident, $statement:ident: $($borrow:tt)+) => {
        $(#[$doc])*
        pub fn $expression(expression: $($borrow)+ Expression, visit: &mut dyn FnMut($($borrow)+ Handle<Expression>)) {
            match expression {
                Expression::Literal(_)
                | Expression::Constant(_)
                | Expression::Override(_)
                | Expression::ZeroValue(_)
                | Expression::FunctionArgument(_)
                | Expression::GlobalVariable(_)
                | Expression::LocalVariable(_)
                | Expression::CallResult(_)
                | Expression::AtomicResult { .. }
                | Expression::WorkGroupUniformLoadResult { .. }
                | Expression::RayQueryProceedResult
                | Expression::SubgroupBallotResult
                | Expression::SubgroupOperationResult { .. } => {}
                Expression::Compose { components, .. } => components.into_iter().for_each(visit),
                Expression::Access { base, index } => [base, index].into_iter().for_each(visit),
                Expression::AccessIndex { base: h, .. }
                | Expression::Splat { value: h, .. }
                | Expression::Swizzle { vector: h, .. }
                | Expression::Load { pointer: h }
                | Expression::Unary { expr: h, .. }
                | Expression::Derivative { expr: h, .. }
                | Expression::As { expr: h, .. }
                | Expression::Relational { argument: h, .. }
                | Expression::ArrayLength(h)
                | Expression::RayQueryVertexPositions { query: h, .. }
                | Expression::RayQueryGetIntersection { query: h, .. } => visit(h),
                Expression::ImageSample { image, sampler, coordinate, array_index, offset, level, depth_ref, gather: _, clamp_to_edge: _ } => {
                    [image, sampler, coordinate].into_iter().for_each(&mut *visit);
                    array_index.into_iter().chain(offset).chain(depth_ref).for_each(&mut *visit);
                    match level {
                        SampleLevel::Auto | SampleLevel::Zero => {}
                        SampleLevel::Exact(h) | SampleLevel::Bias(h) => visit(h),
                        SampleLevel::Gradient { x, y } => [x, y].into_iter().for_each(visit),
                    }
                }
                Expression::ImageLoad { image, coordinate, array_index, sample, level } => {
                    [image, coordinate].into_iter().for_each(&mut *visit);
                    array_index.into_iter().chain(sample).chain(level).for_each(visit);
                }
                Expression::ImageQuery { image, query } => {
                    visit(image);
                    if let ImageQuery::Size { level: Some(level) } = query {
                        visit(level);
                    }
                }
                Expression::Binary { left, right, .. } => [left, right].into_iter().for_each(visit),
                Expression::Select { condition, accept, reject } => [condition, accept, reject].into_iter().for_each(visit),
                Expression::Math { arg, arg1, arg2, arg3, .. } => {
                    visit(arg);
                    arg1.into_iter().chain(arg2).chain(arg3).for_each(visit);
                }
                Expression::CooperativeLoad { data, .. } => {
                    visit($($borrow)+ data.pointer);
                    visit($($borrow)+ data.stride);
                }
                Expression::CooperativeMultiplyAdd { a, b, c } => [a, b, c].into_iter().for_each(visit),
            }
        }

        /// The same of a statement, without what stands in its blocks. Ray tracing is refused when a unit is checked.
        pub fn $statement(statement: $($borrow)+ Statement, visit: &mut dyn FnMut($($borrow)+ Handle<Expression>)) {
            match statement {
                Statement::If { condition: h, .. } | Statement::Switch { selector: h, .. } => visit(h),
                Statement::Loop { break_if: h, .. } | Statement::Return { value: h } => h.into_iter().for_each(visit),
                Statement::Store { pointer, value } => [pointer, value].into_iter().for_each(visit),
                Statement::Call { arguments, result, .. } => arguments.into_iter().chain(result).for_each(visit),
                Statement::ImageStore { image, coordinate, array_index, value } => {
                    [image, coordinate, value].into_iter().for_each(&mut *visit);
                    array_index.into_iter().for_each(visit);
                }
                Statement::Atomic { pointer, fun, value, result } => {
                    [pointer, value].into_iter().for_each(&mut *visit);
                    result.into_iter().for_each(&mut *visit);
                    if let AtomicFunction::Exchange { compare: Some(compare) } = fun {
                        visit(compare);
                    }
                }
                Statement::ImageAtomic { image, coordinate, array_index, fun, value } => {
                    [image, coordinate, value].into_iter().for_each(&mut *visit);
                    array_index.into_iter().for_each(&mut *visit);
                    if let AtomicFunction::Exchange { compare: Some(compare) } = fun {
                        visit(compare);
                    }
                }
                Statement::WorkGroupUniformLoad { pointer, result } => [pointer, result].into_iter().for_each(visit),
                Statement::SubgroupBallot { result, predicate } => {
                    visit(result);
                    predicate.into_iter().for_each(visit);
                }
                Statement::SubgroupGather { mode, argument, result } => {
                    [argument, result].into_iter().for_each(&mut *visit);
                    match mode {
                        GatherMode::BroadcastFirst | GatherMode::QuadSwap(_) => {}
                        GatherMode::Broadcast(h)
                        | GatherMode::Shuffle(h)
                        | GatherMode::ShuffleDown(h)
                        | GatherMode::ShuffleUp(h)
                        | GatherMode::ShuffleXor(h)
                        | GatherMode::QuadBroadcast(h) => visit(h),
                    }
                }
                Statement::SubgroupCollectiveOperation { argument, result, .. } => [argument, result].into_iter().for_each(visit),
                Statement::CooperativeStore { target, data } => {
                    visit(target);
                    visit($($borrow)+ data.pointer);
                    visit($($borrow)+ data.stride);
                }
                Statement::Emit(_)
                | Statement::Block(_)
                | Statement::Break
                | Statement::Continue
                | Statement::Kill
                | Statement::ControlBarrier(_)
                | Statement::MemoryBarrier(_)
                | Statement::RayQuery { .. }
                | Statement::RayPipelineFunction(_) => {}
            }
        }
    };
}

visitors! {
    /// Looks at the operands of an expression.
    expression_operands, statement_operands: &
}

visitors! {
    /// Changes the operands of an expression.
    expression_operands_mut, statement_operands_mut: &mut
}
