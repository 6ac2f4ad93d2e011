//! Expressions: each gets a place, and code that puts its value there.

use naga::{
    BinaryOperator as B, Expression, Handle, MathFunction as M, RelationalFunction, Scalar, ScalarKind, SwizzleComponent, TypeInner,
};

use super::Place;
use super::function::Body;
use crate::code::{At, Convert, Op, Product, Test};
use crate::error::{EvaluateError, unsupported};
use crate::tree::Leaf;

/// Columns and rows of an operand of a product; none where it is a scalar.
fn sizes(inner: &TypeInner) -> Option<(u8, u8, bool)> {
    match *inner {
        TypeInner::Matrix { columns, rows, .. } => Some((columns as u8, rows as u8, true)),
        TypeInner::Vector { size, .. } => Some((1, size as u8, false)),
        _ => None,
    }
}

impl Body<'_, '_> {
    /// Compiles one expression; those that it is made of are there already.
    pub fn compile(&mut self, handle: Handle<Expression>) -> Result<Place, EvaluateError> {
        match self.expressions[handle] {
            Expression::Literal(literal) => self.compiler.literal(literal).map(Place::Value),
            Expression::Constant(constant) => {
                let place = match self.compiler.constants[constant.index()] {
                    // The expressions of constants are under way.
                    Place::Nothing => {
                        let init = self.compiler.module.constants[constant].init;
                        self.compiler
                            .global_expressions
                            .get(init.index())
                            .copied()
                            .unwrap_or(Place::Nothing)
                    }
                    place => place,
                };
                self.known(place, "a constant before its value")
            }
            Expression::Override(constant) => {
                let place = match (
                    self.compiler.overrides[constant.index()],
                    self.compiler.module.overrides[constant].init,
                ) {
                    (Place::Nothing, Some(init)) => self
                        .compiler
                        .global_expressions
                        .get(init.index())
                        .copied()
                        .unwrap_or(Place::Nothing),
                    (place, _) => place,
                };
                self.known(place, "an override before its value")
            }
            Expression::ZeroValue(ty) => Ok(Place::Value(self.compiler.variable(ty)?.0)),
            Expression::Compose { ty, ref components } => {
                let n = self.compiler.len_of(ty)?;
                self.compose(n, components)
            }
            Expression::Access { base, index } => self.access(base, index),
            Expression::AccessIndex { base, index } => self.access_index(base, index),
            Expression::Splat { size, value } => {
                let from = self.value(value)?;
                let n = size as u32;
                let to = self.compiler.alloc(n)?;
                self.compiler.code.push(Op::Fill { to, from, n });
                Ok(Place::Value(to))
            }
            Expression::Swizzle { size, vector, pattern } => self.swizzle(size as u32, vector, pattern),
            Expression::FunctionArgument(index) => {
                let place = self.arguments.get(index as usize).copied().unwrap_or(Place::Nothing);
                self.known(place, "an argument that is missing")
            }
            Expression::GlobalVariable(variable) => self.known(self.compiler.globals[variable.index()], "such a variable"),
            Expression::LocalVariable(variable) => {
                let place = self.locals.get(variable.index()).copied().unwrap_or(Place::Nothing);
                self.known(place, "such a variable")
            }
            Expression::Load { pointer } => self.load(pointer),
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => self.image(handle),
            Expression::Unary { op, expr } => {
                let (leaf, a) = (self.leaf_of(expr)?, self.value(expr)?);
                let (to, n) = self.result(handle)?;
                self.compiler.code.push(Op::Unary { op, leaf, to, a, n });
                Ok(Place::Value(to))
            }
            Expression::Binary { op, left, right } => self.binary(handle, op, left, right),
            Expression::Select { condition, accept, reject } => {
                let at = [self.value(condition)?, self.value(accept)?, self.value(reject)?];
                let step = u8::from(self.compiler.len(self.type_of(condition))? > 1);
                let (to, n) = self.result(handle)?;
                self.compiler.code.push(Op::Select {
                    to,
                    condition: at[0],
                    accept: at[1],
                    reject: at[2],
                    n,
                    step,
                });
                Ok(Place::Value(to))
            }
            Expression::Derivative { .. } => Err(unsupported("a derivative")),
            Expression::Relational { fun, argument } => {
                let test = match fun {
                    RelationalFunction::All => Test::All,
                    RelationalFunction::Any => Test::Any,
                    RelationalFunction::IsNan => Test::IsNan,
                    RelationalFunction::IsInf => Test::IsInf,
                };
                let (a, n) = (self.value(argument)?, self.compiler.len(self.type_of(argument))?);
                let (to, _) = self.result(handle)?;
                self.compiler.code.push(Op::Test { test, to, a, n });
                Ok(Place::Value(to))
            }
            Expression::Math {
                fun,
                arg,
                arg1,
                arg2,
                arg3,
            } => self.math(handle, fun, [Some(arg), arg1, arg2, arg3]),
            Expression::As { expr, kind, convert } => self.convert(handle, expr, kind, convert),
            Expression::CallResult(_) | Expression::AtomicResult { .. } | Expression::WorkGroupUniformLoadResult { .. } => {
                self.place(handle)
            }
            Expression::ArrayLength(array) => {
                let pointer = match self.place(array)? {
                    Place::Behind(pointer, _) | Place::Value(pointer) => pointer,
                    _ => return Err(unsupported("the length of such an array")),
                };
                let to = self.compiler.alloc(1)?;
                self.compiler.code.push(Op::Length { to, pointer });
                Ok(Place::Value(to))
            }
            Expression::RayQueryVertexPositions { .. } | Expression::RayQueryProceedResult | Expression::RayQueryGetIntersection { .. } => {
                Err(unsupported("a ray query"))
            }
            Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. } => Err(unsupported("a subgroup operation")),
            Expression::CooperativeLoad { .. } | Expression::CooperativeMultiplyAdd { .. } => Err(unsupported("a cooperative matrix")),
        }
    }

    /// A place that must be known by now.
    fn known(&self, place: Place, what: &str) -> Result<Place, EvaluateError> {
        match place {
            Place::Nothing => Err(unsupported(what)),
            Place::Trap(trap) => Err(self.compiler.traps[trap as usize].clone()),
            place => Ok(place),
        }
    }

    /// Room for an expression's value.
    pub fn result(&mut self, handle: Handle<Expression>) -> Result<(At, u32), EvaluateError> {
        let inner = self.type_of(handle);
        let n = self.compiler.len(inner)?;
        Ok((self.compiler.alloc(n)?, n))
    }

    fn compose(&mut self, n: u32, components: &[Handle<Expression>]) -> Result<Place, EvaluateError> {
        let mut parts = Vec::with_capacity(components.len());
        for component in components {
            parts.push((self.value(*component)?, self.compiler.len(self.type_of(*component))?));
        }
        // Numbers that stand in a row already need not be moved.
        if parts.windows(2).all(|pair| pair[0].0 + pair[0].1 == pair[1].0)
            && let Some((first, _)) = parts.first()
        {
            return Ok(Place::Value(*first));
        }
        let start = self.compiler.alloc(n)?;
        let mut to = start;
        for (from, n) in parts {
            self.compiler.code.push(Op::Copy { to, from, n });
            to += n;
        }
        Ok(Place::Value(start))
    }

    fn swizzle(&mut self, n: u32, vector: Handle<Expression>, pattern: [SwizzleComponent; 4]) -> Result<Place, EvaluateError> {
        let from = self.value(vector)?;
        let used = &pattern[..(n as usize).min(4)];
        if used.windows(2).all(|pair| pair[0] as u32 + 1 == pair[1] as u32) {
            return Ok(Place::Value(from + used.first().map_or(0, |first| *first as u32)));
        }
        let to = self.compiler.alloc(n)?;
        self.compiler.code.push(Op::Swizzle { to, from, n, pattern });
        Ok(Place::Value(to))
    }

    fn binary(
        &mut self,
        handle: Handle<Expression>,
        op: B,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Result<Place, EvaluateError> {
        let (a, b) = (self.value(left)?, self.value(right)?);
        let leaf = self.leaf_of(left)?;
        let (from, with) = (self.type_of(left), self.type_of(right));
        let (to, n) = self.result(handle)?;
        if let (B::Multiply, Some((left_columns, left_rows, left_is)), Some((right_columns, right_rows, right_is))) =
            (op, sizes(from), sizes(with))
            && (left_is || right_is)
        {
            // A vector on the left is one row.
            let (rows, inner) = if left_is { (left_rows, left_columns) } else { (1, left_rows) };
            let (columns, other) = if right_is { (right_columns, right_rows) } else { (1, right_rows) };
            if inner != other {
                return Err(unsupported("such a product"));
            }
            let shape = Product { columns, inner, rows };
            self.compiler.code.push(Op::Product { to, a, b, shape });
            return Ok(Place::Value(to));
        }
        let step = |inner: &TypeInner| self.compiler.len(inner).map(|n| u8::from(n > 1));
        let steps = [step(from)?, step(with)?];
        self.compiler.code.push(Op::Binary {
            op,
            leaf,
            to,
            a,
            b,
            n,
            steps,
        });
        Ok(Place::Value(to))
    }

    fn math(&mut self, handle: Handle<Expression>, fun: M, given: [Option<Handle<Expression>>; 4]) -> Result<Place, EvaluateError> {
        if fun == M::Inverse {
            return Err(unsupported("the inverse of a matrix"));
        }
        let (mut args, mut steps, mut lens) = ([0; 4], [0; 4], [0; 4]);
        for (i, argument) in given.iter().enumerate() {
            let Some(argument) = argument else { continue };
            args[i] = self.value(*argument)?;
            lens[i] = self.compiler.len(self.type_of(*argument))?;
            steps[i] = u8::from(lens[i] > 1);
        }
        let Some(first) = given[0] else {
            return Err(unsupported("a function without arguments"));
        };
        let leaf = self.leaf_of(first)?;
        let n = match (fun, self.type_of(first)) {
            // Columns, and rows above them.
            (M::Transpose | M::Determinant, TypeInner::Matrix { columns, rows, .. }) => *columns as u32 | (*rows as u32) << 8,
            (M::Outer, _) => lens[1] | lens[0] << 8,
            _ => lens[0],
        };
        let (to, _) = self.result(handle)?;
        self.compiler.code.push(Op::Math {
            fun,
            leaf,
            to,
            args,
            n,
            steps,
        });
        Ok(Place::Value(to))
    }

    fn convert(
        &mut self,
        handle: Handle<Expression>,
        expr: Handle<Expression>,
        kind: ScalarKind,
        width: Option<u8>,
    ) -> Result<Place, EvaluateError> {
        let (from, a) = (self.leaf_of(expr)?, self.value(expr)?);
        let to_leaf = Leaf::of(Scalar {
            kind,
            width: width.unwrap_or(4),
        })?;
        if from == to_leaf {
            return Ok(Place::Value(a));
        }
        let convert = if width.is_some() {
            Convert::Value(to_leaf)
        } else {
            Convert::Bits(to_leaf)
        };
        let (to, n) = self.result(handle)?;
        self.compiler.code.push(Op::Convert { convert, to, a, n });
        Ok(Place::Value(to))
    }
}
