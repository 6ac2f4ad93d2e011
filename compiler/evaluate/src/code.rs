//! What a program is compiled to: a list of instructions over one memory of numbers.
//!
//! naga has no recursion, so every function has its variables and values at fixed places: an operand is a place in memory, and a
//! call copies its arguments. A value of several numbers stands at consecutive places.

use naga::{AtomicFunction, BinaryOperator, BuiltIn, ImageDimension, MathFunction, SwizzleComponent, UnaryOperator};

use crate::error::EvaluateError;
use crate::kind::Counts;
use crate::tree::{Leaf, Tree};

/// A place in memory.
pub(crate) type At = u32;

/// A number in the memory that a program starts with.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Cell {
    Float(f32),
    Int(i32),
    Uint(u32),
    Bool(bool),
    Pointer(Pointer),
}

impl Cell {
    /// Zero of a kind.
    pub fn zero(leaf: Leaf) -> Self {
        match leaf {
            Leaf::Float => Self::Float(0.0),
            Leaf::Int => Self::Int(0),
            Leaf::Uint => Self::Uint(0),
            Leaf::Bool => Self::Bool(false),
        }
    }
}

/// Where something stands in memory, and how many elements the runtime-sized array at its end has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Pointer {
    pub at: At,
    pub elements: u32,
}

/// What a conversion makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Convert {
    /// To a kind by value.
    Value(Leaf),
    /// To a kind by bits.
    Bits(Leaf),
}

/// Tests of a vector as a whole, or of floats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Test {
    All,
    Any,
    IsNan,
    IsInf,
}

/// An instruction. `n` counts components; a `step` of 0 takes the same number for each component.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Op {
    Copy {
        to: At,
        from: At,
        n: u32,
    },
    Fill {
        to: At,
        from: At,
        n: u32,
    },
    Clear {
        to: At,
        n: u32,
    },
    Swizzle {
        to: At,
        from: At,
        n: u32,
        pattern: [SwizzleComponent; 4],
    },
    /// Copies an element; an index beyond the end is the last.
    Pick {
        to: At,
        base: At,
        index: At,
        stride: u32,
        count: u32,
    },
    Unary {
        op: UnaryOperator,
        leaf: Leaf,
        to: At,
        a: At,
        n: u32,
    },
    Binary {
        op: BinaryOperator,
        leaf: Leaf,
        to: At,
        a: At,
        b: At,
        n: u32,
        steps: [u8; 2],
    },
    /// A product with a matrix.
    Product {
        to: At,
        a: At,
        b: At,
        shape: Product,
    },
    Select {
        to: At,
        condition: At,
        accept: At,
        reject: At,
        n: u32,
        step: u8,
    },
    Test {
        test: Test,
        to: At,
        a: At,
        n: u32,
    },
    Convert {
        convert: Convert,
        to: At,
        a: At,
        n: u32,
    },
    Math {
        fun: MathFunction,
        leaf: Leaf,
        to: At,
        args: [At; 4],
        n: u32,
        steps: [u8; 4],
    },
    Load {
        to: At,
        pointer: At,
        offset: u32,
        n: u32,
    },
    Store {
        pointer: At,
        offset: u32,
        from: At,
        n: u32,
    },
    /// A pointer to an element; `count` 0 asks the pointer. An index beyond the end is the last.
    Index {
        to: At,
        pointer: At,
        offset: u32,
        index: At,
        stride: u32,
        count: u32,
    },
    /// A pointer to a part.
    Offset {
        to: At,
        pointer: At,
        offset: u32,
    },
    Length {
        to: At,
        pointer: At,
    },
    Atomic {
        fun: AtomicFunction,
        leaf: Leaf,
        pointer: At,
        offset: u32,
        value: At,
        compare: Option<At>,
        result: Option<At>,
    },
    Image {
        image: u32,
        to: At,
    },
    Jump {
        to: u32,
    },
    JumpUnless {
        condition: At,
        to: u32,
    },
    Switch {
        selector: At,
        table: u32,
    },
    Call {
        to: u32,
    },
    Return,
    Discard,
    Tally(u32),
    Trap(u32),
}

/// Sizes of a matrix product, in columns and rows; a vector on the right is one column, on the left one row.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Product {
    pub columns: u8,
    pub inner: u8,
    pub rows: u8,
}

/// Something done to a texture.
#[derive(Clone, Debug)]
pub(crate) enum ImageOp {
    Sample {
        sampler: At,
        coordinate: At,
        layer: Option<At>,
        offset: Option<At>,
        level: Option<At>,
        depth: Option<At>,
        gather: Option<SwizzleComponent>,
        clamp: bool,
    },
    Load {
        coordinate: At,
        layer: Option<At>,
        level: Option<At>,
    },
    Size {
        level: Option<At>,
    },
    Levels,
    Layers,
}

/// With what, and what comes out.
#[derive(Clone, Debug)]
pub(crate) struct ImageUse {
    pub image: At,
    pub dim: ImageDimension,
    pub is_depth: bool,
    pub leaf: Leaf,
    pub op: ImageOp,
}

/// Where a `switch` goes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Table {
    /// Bits of a selector, and where its case begins.
    pub cases: Vec<(u32, u32)>,
    pub default: u32,
}

/// What a variable with a binding is.
#[derive(Clone, Debug)]
pub(crate) enum Resource {
    Buffer(Tree),
    Texture { is_depth: bool, white: f32, layers: u32 },
    Sampler,
}

/// A variable with a binding.
#[derive(Clone, Debug)]
pub(crate) struct Bound {
    pub name: String,
    pub group: u32,
    pub binding: u32,
    /// Where its pointer stands, or the number of its texture or sampler.
    pub at: At,
    pub resource: Resource,
}

/// Where an input comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Source {
    BuiltIn(BuiltIn),
    Location(u32),
}

/// An input of an entry point.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    pub at: At,
    pub source: Source,
    pub leaves: Vec<Leaf>,
}

/// A compiled entry point. It depends on no number type: one serves machines of all.
#[derive(Clone, Debug)]
pub struct Program {
    pub(crate) limits: Limits,
    pub(crate) code: Vec<Op>,
    pub(crate) entry: u32,
    /// Evaluates constants and pipeline constants, once.
    pub(crate) constants: u32,
    pub(crate) memory: Vec<Cell>,
    pub(crate) tables: Vec<Table>,
    pub(crate) images: Vec<ImageUse>,
    pub(crate) traps: Vec<EvaluateError>,
    pub(crate) tallies: Vec<Counts>,
    /// The tallies from here on are the entry point's own.
    pub(crate) entry_tallies: usize,
    pub(crate) bound: Vec<Bound>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) result: Option<(At, Tree)>,
    pub(crate) workgroup_size: [u32; 3],
}

/// What an evaluation may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Instructions of one run; copying many numbers counts as many.
    pub steps: u64,
    /// Numbers in variables, values and buffers.
    pub numbers: usize,
}

impl Default for Limits {
    /// 2^26 steps, about a second, and 2^24 numbers.
    fn default() -> Self {
        Self {
            steps: 1 << 26,
            numbers: 1 << 24,
        }
    }
}
