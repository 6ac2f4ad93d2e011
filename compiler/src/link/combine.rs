//! The functions that combine the modules of a list slot.

use naga::{BinaryOperator, Block, Expression, Function, FunctionArgument, FunctionResult, Handle, Range, Span, Statement};

use super::ir::Linker;
use crate::manifest::Combine;
use crate::plan::Planned;

impl Linker<'_> {
    /// As the parser would make it of the text that the source writer writes.
    pub fn combined(&mut self, planned: &Planned, stub: Handle<Function>, rule: Combine) -> Function {
        let plan = self.plan;
        let declared = &plan.homes[planned.home].unit.ir.functions[stub];
        let mut function = Function {
            name: Some(planned.name.clone()),
            ..Function::default()
        };
        for argument in &declared.arguments {
            let ty = self.ty(planned.home, argument.ty);
            function.arguments.push(FunctionArgument {
                name: argument.name.clone(),
                ty,
                binding: None,
            });
        }
        function.result = declared.result.as_ref().map(|r| FunctionResult {
            ty: self.ty(planned.home, r.ty),
            binding: None,
        });
        let mut block = Block::new();
        let expressions = &mut function.expressions;
        let mut arguments: Vec<Handle<Expression>> = (0..declared.arguments.len() as u32)
            .map(|index| expressions.append(Expression::FunctionArgument(index), Span::default()))
            .collect();
        let mut value = None;
        for &target in &planned.targets {
            // Callees precede callers in the plan.
            let Some(callee) = self.functions[target] else { continue };
            let result = expressions.append(Expression::CallResult(callee), Span::default());
            block.push(
                Statement::Call {
                    function: callee,
                    arguments: arguments.clone(),
                    result: Some(result),
                },
                Span::default(),
            );
            value = match (rule, value) {
                (Combine::Chain, _) => {
                    if let Some(first) = arguments.first_mut() {
                        *first = result;
                    }
                    Some(result)
                }
                (_, None) => Some(result),
                (_, Some(left)) => {
                    let op = if rule == Combine::Sum {
                        BinaryOperator::Add
                    } else {
                        BinaryOperator::Multiply
                    };
                    let combined = expressions.append(Expression::Binary { op, left, right: result }, Span::default());
                    block.push(Statement::Emit(Range::new_from_bounds(combined, combined)), Span::default());
                    Some(combined)
                }
            };
        }
        block.push(Statement::Return { value }, Span::default());
        function.body = block;
        function
    }
}
