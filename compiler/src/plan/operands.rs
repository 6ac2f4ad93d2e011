//! What expressions and statements depend on.

use naga::{Expression, Handle, Statement};

/// Operands of an expression.
pub fn expression_operands(expression: &Expression, visit: &mut dyn FnMut(Handle<Expression>)) {
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
        Expression::Compose { components, .. } => components.iter().for_each(|&c| visit(c)),
        Expression::Access { base, index } => {
            visit(*base);
            visit(*index);
        }
        Expression::AccessIndex { base, .. } => visit(*base),
        Expression::Splat { value, .. } => visit(*value),
        Expression::Swizzle { vector, .. } => visit(*vector),
        Expression::Load { pointer } => visit(*pointer),
        Expression::ImageSample {
            image,
            sampler,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref,
            gather: _,
            clamp_to_edge: _,
        } => {
            visit(*image);
            visit(*sampler);
            visit(*coordinate);
            array_index.iter().chain(offset).chain(depth_ref).for_each(|&h| visit(h));
            match level {
                naga::SampleLevel::Auto | naga::SampleLevel::Zero => {}
                naga::SampleLevel::Exact(h) | naga::SampleLevel::Bias(h) => visit(*h),
                naga::SampleLevel::Gradient { x, y } => {
                    visit(*x);
                    visit(*y);
                }
            }
        }
        Expression::ImageLoad {
            image,
            coordinate,
            array_index,
            sample,
            level,
        } => {
            visit(*image);
            visit(*coordinate);
            array_index.iter().chain(sample).chain(level).for_each(|&h| visit(h));
        }
        Expression::ImageQuery { image, query } => {
            visit(*image);
            if let naga::ImageQuery::Size { level: Some(level) } = query {
                visit(*level);
            }
        }
        Expression::Unary { expr, .. } | Expression::Derivative { expr, .. } | Expression::As { expr, .. } => visit(*expr),
        Expression::Binary { left, right, .. } => {
            visit(*left);
            visit(*right);
        }
        Expression::Select { condition, accept, reject } => {
            visit(*condition);
            visit(*accept);
            visit(*reject);
        }
        Expression::Relational { argument, .. } => visit(*argument),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            visit(*arg);
            arg1.iter().chain(arg2).chain(arg3).for_each(|&h| visit(h));
        }
        Expression::ArrayLength(h) => visit(*h),
        Expression::RayQueryVertexPositions { query, .. } | Expression::RayQueryGetIntersection { query, .. } => visit(*query),
        Expression::CooperativeLoad { data, .. } => {
            visit(data.pointer);
            visit(data.stride);
        }
        Expression::CooperativeMultiplyAdd { a, b, c } => {
            visit(*a);
            visit(*b);
            visit(*c);
        }
    }
}

/// Operands of a statement that has no blocks and is neither store nor call.
pub fn operands(statement: &Statement, visit: &mut dyn FnMut(Handle<Expression>)) {
    match statement {
        Statement::ImageStore {
            image,
            coordinate,
            array_index,
            value,
        } => {
            [*image, *coordinate, *value].into_iter().chain(*array_index).for_each(visit);
        }
        Statement::Atomic {
            pointer,
            fun,
            value,
            result,
        } => {
            let compare = match fun {
                naga::AtomicFunction::Exchange { compare } => *compare,
                _ => None,
            };
            [*pointer, *value].into_iter().chain(compare).chain(*result).for_each(visit);
        }
        Statement::ImageAtomic {
            image,
            coordinate,
            array_index,
            fun,
            value,
        } => {
            let compare = match fun {
                naga::AtomicFunction::Exchange { compare } => *compare,
                _ => None,
            };
            [*image, *coordinate, *value]
                .into_iter()
                .chain(compare)
                .chain(*array_index)
                .for_each(visit);
        }
        Statement::WorkGroupUniformLoad { pointer, result } => [*pointer, *result].into_iter().for_each(visit),
        Statement::SubgroupBallot { result, predicate } => [*result].into_iter().chain(*predicate).for_each(visit),
        Statement::SubgroupGather { mode, argument, result } => {
            let index = match *mode {
                naga::GatherMode::BroadcastFirst | naga::GatherMode::QuadSwap(_) => None,
                naga::GatherMode::Broadcast(h)
                | naga::GatherMode::Shuffle(h)
                | naga::GatherMode::ShuffleDown(h)
                | naga::GatherMode::ShuffleUp(h)
                | naga::GatherMode::ShuffleXor(h)
                | naga::GatherMode::QuadBroadcast(h) => Some(h),
            };
            [*argument, *result].into_iter().chain(index).for_each(visit);
        }
        Statement::SubgroupCollectiveOperation { argument, result, .. } => [*argument, *result].into_iter().for_each(visit),
        Statement::CooperativeStore { target, data } => [*target, data.pointer, data.stride].into_iter().for_each(visit),
        // Ray queries and ray pipelines: refused when the unit is checked.
        _ => {}
    }
}
