//! Kinds of operations, and which of them an expression is: the one table that static counts and executed counts share.
//!
//! Of a vector operation every component counts. A compound function counts as what the WGSL specification defines it by:
//! `dot` of three as 3 multiplications and 2 additions, `normalize` as a dot product, a root and as many multiplications.
//! What hardware does on the way (negation, absolute value, saturation, moving and swizzling) is free, and so are loads.

use std::ops::{AddAssign, Index, IndexMut};

use naga::{BinaryOperator as B, Expression, Handle, MathFunction as M, RelationalFunction, ScalarKind, TypeInner, UnaryOperator};
use serde::{Deserialize, Serialize};

/// What an operation costs by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// Additions and subtractions of floats; rounding to whole numbers.
    Add,
    /// Multiplications of floats.
    Multiply,
    /// Divisions and remainders of floats.
    Divide,
    /// Square roots and their inverses.
    Root,
    /// `sin`, `exp2`, `log2`, `pow`, `atan2` and their kind.
    Transcendental,
    /// Comparisons and choices: `select`, `min`, `max`, `step`, logic.
    Select,
    /// What integers do, conversions to and from them, packing.
    Integer,
    /// Texture reads and queries.
    Texture,
    /// `if` and `switch`.
    Branch,
    /// Trips of loops.
    Trip,
}

impl Kind {
    /// All of them, in order.
    pub const ALL: [Self; 10] = [
        Self::Add,
        Self::Multiply,
        Self::Divide,
        Self::Root,
        Self::Transcendental,
        Self::Select,
        Self::Integer,
        Self::Texture,
        Self::Branch,
        Self::Trip,
    ];
}

/// How many operations of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts([u64; Kind::ALL.len()]);

impl Counts {
    /// So many of one kind.
    pub fn of(kind: Kind, count: u64) -> Self {
        let mut counts = Self::default();
        counts[kind] = count;
        counts
    }

    /// These, so many times.
    #[must_use]
    pub fn times(self, factor: u64) -> Self {
        Self(self.0.map(|count| count.saturating_mul(factor)))
    }

    /// Whether there is nothing.
    pub fn is_zero(&self) -> bool {
        self.0.iter().all(|count| *count == 0)
    }
}

impl Index<Kind> for Counts {
    type Output = u64;

    fn index(&self, kind: Kind) -> &u64 {
        &self.0[kind as usize]
    }
}

impl IndexMut<Kind> for Counts {
    fn index_mut(&mut self, kind: Kind) -> &mut u64 {
        &mut self.0[kind as usize]
    }
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        for (own, other) in self.0.iter_mut().zip(other.0) {
            *own = own.saturating_add(other);
        }
    }
}

/// Kind and components of a scalar, vector or matrix; `None` of anything else.
fn shape(inner: &TypeInner) -> Option<(ScalarKind, u64)> {
    Some(match *inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => (scalar.kind, 1),
        TypeInner::Vector { size, scalar } => (scalar.kind, size as u64),
        TypeInner::Matrix { columns, rows, scalar } => (scalar.kind, columns as u64 * rows as u64),
        _ => return None,
    })
}

/// Operations that one evaluation of an expression is. `result` is its type, `operand` gives the types of others of its function.
pub fn operations<'a>(expression: &Expression, result: &TypeInner, operand: impl Fn(Handle<Expression>) -> &'a TypeInner) -> Counts {
    match *expression {
        Expression::Unary { op, expr } => match (op, shape(operand(expr))) {
            (UnaryOperator::LogicalNot, Some((_, n))) => Counts::of(Kind::Select, n),
            (_, Some((ScalarKind::Sint | ScalarKind::Uint, n))) => Counts::of(Kind::Integer, n),
            _ => Counts::default(),
        },
        Expression::Binary { op, left, right } => binary(op, result, operand(left), operand(right)),
        Expression::Select { .. } => Counts::of(Kind::Select, shape(result).map_or(1, |(_, n)| n)),
        Expression::Relational { fun, argument } => match fun {
            RelationalFunction::All | RelationalFunction::Any => {
                Counts::of(Kind::Select, shape(operand(argument)).map_or(0, |(_, n)| n.saturating_sub(1)))
            }
            RelationalFunction::IsNan | RelationalFunction::IsInf => {
                Counts::of(Kind::Select, shape(operand(argument)).map_or(1, |(_, n)| n))
            }
        },
        Expression::Math { fun, arg, .. } => math(fun, operand(arg), result),
        Expression::As { expr, convert, .. } => match (convert, shape(operand(expr)), shape(result)) {
            (Some(_), Some((from, n)), Some((to, _))) if from != to => match (from, to) {
                (ScalarKind::Bool, _) | (_, ScalarKind::Bool) => Counts::of(Kind::Select, n),
                _ => Counts::of(Kind::Integer, n),
            },
            _ => Counts::default(),
        },
        Expression::Derivative { .. } => Counts::of(Kind::Add, shape(result).map_or(1, |(_, n)| n)),
        Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. } => Counts::of(Kind::Texture, 1),
        Expression::Literal(_)
        | Expression::Constant(_)
        | Expression::Override(_)
        | Expression::ZeroValue(_)
        | Expression::Compose { .. }
        | Expression::Access { .. }
        | Expression::AccessIndex { .. }
        | Expression::Splat { .. }
        | Expression::Swizzle { .. }
        | Expression::FunctionArgument(_)
        | Expression::GlobalVariable(_)
        | Expression::LocalVariable(_)
        | Expression::Load { .. }
        | Expression::CallResult(_)
        | Expression::AtomicResult { .. }
        | Expression::WorkGroupUniformLoadResult { .. }
        | Expression::ArrayLength(_)
        | Expression::RayQueryVertexPositions { .. }
        | Expression::RayQueryProceedResult
        | Expression::RayQueryGetIntersection { .. }
        | Expression::SubgroupBallotResult
        | Expression::SubgroupOperationResult { .. }
        | Expression::CooperativeLoad { .. }
        | Expression::CooperativeMultiplyAdd { .. } => Counts::default(),
    }
}

fn binary(op: B, result: &TypeInner, left: &TypeInner, right: &TypeInner) -> Counts {
    let (kind, n) = shape(left).max(shape(right)).unwrap_or((ScalarKind::Float, 1));
    match op {
        B::Equal | B::NotEqual | B::Less | B::LessEqual | B::Greater | B::GreaterEqual | B::LogicalAnd | B::LogicalOr => {
            return Counts::of(Kind::Select, n);
        }
        _ if kind == ScalarKind::Bool => return Counts::of(Kind::Select, n),
        _ if kind != ScalarKind::Float => return Counts::of(Kind::Integer, shape(result).map_or(n, |(_, n)| n)),
        _ => {}
    }
    let n = shape(result).map_or(n, |(_, n)| n);
    match op {
        B::Add | B::Subtract => Counts::of(Kind::Add, n),
        B::Divide => Counts::of(Kind::Divide, n),
        B::Modulo => Counts::of(Kind::Divide, n),
        B::Multiply => {
            // Every number of a matrix product is a dot product.
            let terms = match (left, right) {
                (TypeInner::Matrix { columns, .. }, TypeInner::Vector { .. } | TypeInner::Matrix { .. }) => *columns as u64,
                (TypeInner::Vector { size, .. }, TypeInner::Matrix { .. }) => *size as u64,
                _ => 1,
            };
            let mut counts = Counts::of(Kind::Multiply, n * terms);
            counts[Kind::Add] = n * (terms - 1);
            counts
        }
        _ => Counts::of(Kind::Integer, n),
    }
}

fn math(fun: M, argument: &TypeInner, result: &TypeInner) -> Counts {
    let (kind, n) = shape(argument).unwrap_or((ScalarKind::Float, 1));
    let many = |list: &[(Kind, u64)]| {
        let mut counts = Counts::default();
        list.iter().for_each(|(kind, count)| counts[*kind] += count);
        counts
    };
    if !matches!(kind, ScalarKind::Float | ScalarKind::AbstractFloat) {
        let factor = match fun {
            M::Clamp => 2,
            M::Dot => 2,
            _ => 1,
        };
        return Counts::of(Kind::Integer, shape(result).map_or(n, |(_, r)| r.max(n)) * factor);
    }
    match fun {
        M::Abs | M::Saturate | M::Transpose => Counts::default(),
        M::Min | M::Max | M::Step => Counts::of(Kind::Select, n),
        M::Clamp | M::Sign => Counts::of(Kind::Select, 2 * n),
        M::Cos
        | M::Cosh
        | M::Sin
        | M::Sinh
        | M::Tan
        | M::Tanh
        | M::Acos
        | M::Asin
        | M::Atan
        | M::Atan2
        | M::Asinh
        | M::Acosh
        | M::Atanh
        | M::Exp
        | M::Exp2
        | M::Log
        | M::Log2
        | M::Pow => Counts::of(Kind::Transcendental, n),
        M::Radians | M::Degrees => Counts::of(Kind::Multiply, n),
        M::Ceil | M::Floor | M::Round | M::Fract | M::Trunc => Counts::of(Kind::Add, n),
        M::Modf => Counts::of(Kind::Add, 2 * n),
        M::Frexp | M::Ldexp | M::QuantizeToF16 => Counts::of(Kind::Integer, n),
        M::Dot => many(&[(Kind::Multiply, n), (Kind::Add, n - 1)]),
        M::Outer => Counts::of(Kind::Multiply, shape(result).map_or(n, |(_, r)| r)),
        M::Cross => many(&[(Kind::Multiply, 6), (Kind::Add, 3)]),
        M::Distance => many(&[(Kind::Multiply, n), (Kind::Add, 2 * n - 1), (Kind::Root, 1)]),
        M::Length => many(&[(Kind::Multiply, n), (Kind::Add, n - 1), (Kind::Root, 1)]),
        M::Normalize => many(&[(Kind::Multiply, 2 * n), (Kind::Add, n - 1), (Kind::Root, 1)]),
        M::FaceForward => many(&[(Kind::Multiply, n), (Kind::Add, n - 1), (Kind::Select, n)]),
        M::Reflect => many(&[(Kind::Multiply, 2 * n + 1), (Kind::Add, 2 * n - 1)]),
        M::Refract => many(&[
            (Kind::Multiply, 3 * n + 4),
            (Kind::Add, 2 * n + 2),
            (Kind::Root, 1),
            (Kind::Select, n),
        ]),
        M::Fma => many(&[(Kind::Multiply, n), (Kind::Add, n)]),
        M::Mix => many(&[(Kind::Multiply, 2 * n), (Kind::Add, 2 * n)]),
        M::SmoothStep => many(&[
            (Kind::Divide, n),
            (Kind::Multiply, 3 * n),
            (Kind::Add, 3 * n),
            (Kind::Select, 2 * n),
        ]),
        M::Sqrt | M::InverseSqrt => Counts::of(Kind::Root, n),
        M::Determinant => match n {
            4 => many(&[(Kind::Multiply, 2), (Kind::Add, 1)]),
            9 => many(&[(Kind::Multiply, 9), (Kind::Add, 5)]),
            _ => many(&[(Kind::Multiply, 28), (Kind::Add, 17)]),
        },
        M::Inverse => many(&[(Kind::Multiply, 3 * n), (Kind::Add, 2 * n), (Kind::Divide, 1)]),
        M::CountTrailingZeros
        | M::CountLeadingZeros
        | M::CountOneBits
        | M::ReverseBits
        | M::ExtractBits
        | M::InsertBits
        | M::FirstTrailingBit
        | M::FirstLeadingBit
        | M::Dot4I8Packed
        | M::Dot4U8Packed
        | M::Pack4x8snorm
        | M::Pack4x8unorm
        | M::Pack2x16snorm
        | M::Pack2x16unorm
        | M::Pack2x16float
        | M::Pack4xI8
        | M::Pack4xU8
        | M::Pack4xI8Clamp
        | M::Pack4xU8Clamp
        | M::Unpack4x8snorm
        | M::Unpack4x8unorm
        | M::Unpack2x16snorm
        | M::Unpack2x16unorm
        | M::Unpack2x16float
        | M::Unpack4xI8
        | M::Unpack4xU8 => Counts::of(Kind::Integer, n.max(shape(result).map_or(1, |(_, r)| r))),
    }
}
