//! One permutation of a space: its number, what was chosen, and the recipe that comes of it.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::manifest::{Arity, Filling, Node};
use crate::program::Recipe;

use super::count::{Picks, UNCHOSEN};
use super::tree::{Expr, ExprId, PartKind, Tree};

/// One permutation of a space.
#[derive(Clone, Debug)]
pub struct Permutation {
    /// Its number among all legal ones; `None` in a space with too many to number.
    pub index: Option<u128>,
    /// What was chosen, outer choices first. Places without a choice are left out.
    pub choices: Vec<Chosen>,
    /// The same as numbers: of all options of all choices those that were chosen, ascending. What two permutations have in common, and
    /// which pairs of options a set of them covers, is read off these.
    pub options: Vec<usize>,
    /// The recipe.
    pub recipe: Recipe,
}

/// What was chosen in one place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Chosen {
    /// Slot path, `main.brdf`, with the parameter behind it where a value was chosen. In lists the index is the space's own.
    pub place: String,
    /// The alternative: a module's name, a value, or the names of what was taken of a list.
    pub chosen: String,
}

/// The recipe that these picks make.
pub fn recipe(tree: &Tree, picks: &Picks) -> Recipe {
    let mut nodes = Vec::new();
    if let Some(root) = tree.exprs.len().checked_sub(1) {
        build(tree, root, picks, &mut nodes);
    }
    // The root is one module, as opening has checked.
    let root = nodes.pop().unwrap_or_else(|| Node::new(""));
    Recipe::from(root)
}

/// What these picks chose, of the choices that are choices: those with several `possible` options.
pub fn choices(tree: &Tree, picks: &Picks, possible: &[bool]) -> Vec<Chosen> {
    let real: Vec<bool> = tree
        .points
        .iter()
        .map(|p| options(possible, p.first_value, p.options.len()) > 1)
        .collect();
    let mut found = Vec::new();
    if let Some(root) = tree.exprs.len().checked_sub(1) {
        describe(tree, root, picks, &real, &mut found);
    }
    found
}

/// The numbers of the options that these picks chose, of the choices that are choices.
pub fn numbers(tree: &Tree, picks: &Picks, possible: &[bool]) -> Vec<usize> {
    let chosen = tree.points.iter().zip(picks).filter(|&(_, &pick)| pick != UNCHOSEN);
    let real = chosen.filter(|(point, _)| options(possible, point.first_value, point.options.len()) > 1);
    real.map(|(point, &pick)| point.first_value + pick as usize).collect()
}

fn options(possible: &[bool], first: usize, number: usize) -> usize {
    possible[first..first + number].iter().filter(|p| **p).count()
}

/// The option that was taken.
fn taken(options: &[Option<ExprId>], pick: u32) -> Option<ExprId> {
    if pick == UNCHOSEN { None } else { *options.get(pick as usize)? }
}

fn build(tree: &Tree, id: ExprId, picks: &Picks, nodes: &mut Vec<Node>) {
    match &tree.exprs[id] {
        Expr::Value { .. } => {}
        Expr::OneOf { point, options } => {
            if let Some(option) = taken(options, picks[*point]) {
                build(tree, option, picks, nodes);
            }
        }
        Expr::List(row) => row.iter().for_each(|&element| build(tree, element, picks, nodes)),
        Expr::SomeOf { points, of, .. } => {
            for (&point, &element) in points.iter().zip(of) {
                if picks[point] == 1 {
                    build(tree, element, picks, nodes);
                }
            }
        }
        Expr::Module(module) => {
            let mut node = Node {
                module: module.name.clone(),
                fill: IndexMap::new(),
                freeze: IndexMap::new(),
                files: IndexMap::new(),
                label: module.label.clone(),
            };
            for part in module.parts.iter().filter(|part| !part.implicit) {
                match &part.kind {
                    PartKind::Param(name) => {
                        let value = match &tree.exprs[part.expr] {
                            Expr::OneOf { point, options } => taken(options, picks[*point]).map(|value| &tree.exprs[value]),
                            other => Some(other),
                        };
                        if let Some(Expr::Value { value, .. }) = value {
                            node.freeze.insert(name.clone(), value.clone());
                        }
                    }
                    PartKind::Slot(name, arity) => {
                        let mut inner = Vec::new();
                        build(tree, part.expr, picks, &mut inner);
                        let filling = match (arity, inner.len()) {
                            (Arity::Single | Arity::Optional, 1) => inner.pop().map(Filling::One),
                            _ => Some(Filling::Many(inner)),
                        };
                        node.fill.extend(filling.map(|filling| (name.clone(), filling)));
                    }
                }
            }
            nodes.push(node);
        }
    }
}

fn describe(tree: &Tree, id: ExprId, picks: &Picks, real: &[bool], found: &mut Vec<Chosen>) {
    match &tree.exprs[id] {
        Expr::Value { .. } => {}
        Expr::OneOf { point, options } => {
            let Some(option) = taken(options, picks[*point]) else { return };
            if real[*point] {
                let chosen = tree.points[*point].options.get(picks[*point] as usize);
                found.push(Chosen {
                    place: tree.points[*point].path.clone(),
                    chosen: chosen.cloned().unwrap_or_default(),
                });
            }
            describe(tree, option, picks, real, found);
        }
        Expr::List(row) => row.iter().for_each(|&element| describe(tree, element, picks, real, found)),
        Expr::SomeOf {
            points, of, path, names, ..
        } => {
            if points.iter().any(|&point| real[point]) {
                let there = points.iter().zip(names).filter(|&(&point, _)| picks[point] == 1);
                let there: Vec<&str> = there.map(|(_, name)| name.as_str()).collect();
                found.push(Chosen {
                    place: path.clone(),
                    chosen: format!("[{}]", there.join(", ")),
                });
            }
            for (&point, &element) in points.iter().zip(of) {
                if picks[point] == 1 {
                    describe(tree, element, picks, real, found);
                }
            }
        }
        Expr::Module(module) => module.parts.iter().for_each(|part| describe(tree, part.expr, picks, real, found)),
    }
}
