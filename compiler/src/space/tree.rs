//! A space, opened: every alternative of every place that it can have, rules about parents and capabilities already applied.

use std::sync::Arc;

use crate::catalog::Module;
use crate::manifest::{Arity, Value};

use super::amounts::Amounts;
use super::signature::Own;

/// Index of an expression. What stands in an expression has a smaller index.
pub type ExprId = usize;

/// Something that yields modules, in order, or a parameter's value.
#[derive(Clone, Debug)]
pub enum Expr {
    /// A parameter's value.
    Value {
        /// As written.
        value: Value,
        /// As a WGSL constant, where it matters for a label.
        exact: Option<String>,
    },
    /// One module.
    Module(Box<ModuleExpr>),
    /// Exactly one of these. What can never stand there is `None`.
    OneOf {
        /// The choice that it is.
        point: usize,
        /// Alternatives.
        options: Vec<Option<ExprId>>,
    },
    /// One after the other.
    List(Vec<ExprId>),
    /// Some of these, in order.
    SomeOf {
        /// For each the choice whether it is there, 0 no, 1 yes.
        points: Vec<usize>,
        /// What there is to choose from.
        of: Vec<ExprId>,
        /// How many may be there.
        range: (u32, u32),
        /// Slot path.
        path: String,
        /// What each is called.
        names: Vec<String>,
    },
}

/// A module in its place.
#[derive(Clone, Debug)]
pub struct ModuleExpr {
    /// As recipes name it.
    pub name: String,
    /// The module.
    pub module: Arc<Module>,
    /// Keeps it apart from an equal subtree.
    pub label: Option<String>,
    /// Parameters, then slots.
    pub parts: Vec<Part>,
    /// Whether it is the root.
    pub root: bool,
    /// What it declares of limited things.
    pub amounts: Amounts,
    /// Its own share of the signature.
    pub own: Own,
    /// Words by which rules of the space find it.
    pub tags: Vec<String>,
}

/// A parameter or slot of a module.
#[derive(Clone, Debug)]
pub struct Part {
    /// Which.
    pub kind: PartKind,
    /// Whether a recipe need not say it, because it is the default.
    pub implicit: bool,
    /// What it may be.
    pub expr: ExprId,
}

/// What a part of a module is.
#[derive(Clone, Debug)]
pub enum PartKind {
    /// A frozen parameter.
    Param(String),
    /// A slot.
    Slot(String, Arity),
}

/// A choice.
#[derive(Clone, Debug)]
pub struct Point {
    /// The choice and its option that this one is below of.
    pub parent: Option<(usize, u32)>,
    /// Slot path, for people.
    pub path: String,
    /// What there is to choose, for people.
    pub options: Vec<String>,
    /// Number of its first option among the options of all choices.
    pub first_value: usize,
}

/// An opened space.
#[derive(Clone, Debug, Default)]
pub struct Tree {
    /// All expressions; the root is the last one.
    pub exprs: Vec<Expr>,
    /// All choices, outer ones first.
    pub points: Vec<Point>,
    /// Number of options of all choices together.
    pub values: usize,
}

impl Expr {
    /// What is taken one after the other to make it.
    pub fn row(&self) -> Vec<ExprId> {
        match self {
            Self::Module(module) => module.parts.iter().map(|part| part.expr).collect(),
            Self::List(of) | Self::SomeOf { of, .. } => of.clone(),
            Self::Value { .. } | Self::OneOf { .. } => Vec::new(),
        }
    }

    /// The choice whether an element of its row is there; `None` where it always is.
    pub fn element_point(&self, index: usize) -> Option<usize> {
        match self {
            Self::SomeOf { points, .. } => Some(points[index]),
            _ => None,
        }
    }
}

impl Tree {
    /// Choice and option of a value.
    pub fn value(&self, value: usize) -> (usize, u32) {
        let point = self.points.partition_point(|point| point.first_value <= value) - 1;
        (point, (value - self.points[point].first_value) as u32)
    }
}
