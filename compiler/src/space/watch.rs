//! Which tags, demands, limits and labels matter in a space, and what each module adds to them.

use std::collections::BTreeMap;

use crate::catalog::Module;
use crate::manifest::{Among, Rule};
use crate::resolve::rules::has_tag;

use super::amounts::Amounts;
use super::format::{Limits, SpaceRule};
use super::signature::{Demand, Own, Signatures};
use super::tree::{Expr, ModuleExpr, Tree};

/// A tag that a rule looks for: those of a space also see the tags that the space itself gives.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tag {
    /// The word.
    pub word: String,
    /// Whether a rule of the space looks for it.
    pub of_space: bool,
}

impl Tag {
    /// Whether a module with these tags of the space has it.
    pub fn is_on(&self, module: &Module, tags: &[String]) -> bool {
        has_tag(module, &self.word) || self.of_space && tags.contains(&self.word)
    }
}

/// A rule that binds a module.
#[derive(Clone, Debug)]
pub struct Bound {
    /// What must, or must not, stand there.
    pub tag: Tag,
    /// Where.
    pub among: Among,
    /// Must.
    pub wanted: bool,
}

/// The rules that bind a module: its own and those of the space.
pub fn rules_of(module: &Module, tags: &[String], root: bool, rules: &[SpaceRule]) -> Vec<Bound> {
    let own = module.manifest.rules.iter().map(|rule| {
        let (tag, among, wanted) = match rule {
            Rule::Requires { tag, among, .. } => (tag, among, true),
            Rule::Excludes { tag, among, .. } => (tag, among, false),
        };
        bound(tag, *among, wanted, false)
    });
    let space = rules.iter().filter_map(|rule| {
        let (when, tag, among, wanted) = match rule {
            SpaceRule::Requires { when, tag, among, .. } => (when, tag, among, true),
            SpaceRule::Excludes { when, tag, among, .. } => (when, tag, among, false),
        };
        let binds = match when {
            None => root,
            Some(word) => bound(word, *among, wanted, true).tag.is_on(module, tags),
        };
        binds.then(|| bound(tag, *among, wanted, true))
    });
    own.chain(space).collect()
}

fn bound(tag: &str, among: Among, wanted: bool, of_space: bool) -> Bound {
    Bound {
        tag: Tag {
            word: tag.to_owned(),
            of_space,
        },
        among,
        wanted,
    }
}

/// Finds out what matters, and writes each module's share into the tree. `shared` is what every tree has.
/// `None` where the shared amounts alone are over a limit.
pub fn watch(tree: &mut Tree, rules: &[SpaceRule], limits: &Limits, shared: &Amounts) -> Option<Signatures> {
    let bounds: Vec<Vec<Bound>> = tree.exprs.iter().map(|expr| bounds_of(expr, rules)).collect();
    let mut tags: Vec<Tag> = Vec::new();
    for bound in bounds.iter().flatten().filter(|bound| bound.among != Among::Parent) {
        if !tags.contains(&bound.tag) {
            tags.push(bound.tag.clone());
        }
    }
    let most = most(tree, limits, shared)?;
    let mut demands: Vec<Demand> = Vec::new();
    let contested = contested(tree);
    for (expr, bounds) in tree.exprs.iter_mut().zip(&bounds) {
        let Expr::Module(module) = expr else { continue };
        let has: Vec<u8> = tags.iter().map(|tag| u8::from(tag.is_on(&module.module, &module.tags))).collect();
        let mut own = Own {
            amounts: most.iter().map(|&(thing, _)| module.amounts[thing]).collect(),
            label: label_of(module)
                .and_then(|label| contested.iter().position(|other| *other == label))
                .map(|i| i as u32),
            tags: has.clone(),
            ..Own::default()
        };
        for bound in bounds {
            let Some(tag) = tags.iter().position(|tag| *tag == bound.tag) else {
                continue;
            };
            match bound.among {
                Among::Parent => {}
                Among::Children => own.children.push((tag, bound.wanted)),
                Among::Tree => {
                    let demand = Demand {
                        tag,
                        wanted: bound.wanted,
                        from: 1 + has[tag],
                    };
                    let number = demands.iter().position(|d| *d == demand).unwrap_or_else(|| {
                        demands.push(demand);
                        demands.len() - 1
                    });
                    own.demands.push(number as u16);
                }
            }
        }
        own.demands.sort_unstable();
        own.demands.dedup();
        module.own = own;
    }
    make_exact(tree);
    Some(Signatures::new(tags.len(), demands, most.iter().map(|&(_, most)| most).collect()))
}

fn bounds_of(expr: &Expr, rules: &[SpaceRule]) -> Vec<Bound> {
    match expr {
        Expr::Module(module) => rules_of(&module.module, &module.tags, module.root, rules),
        _ => Vec::new(),
    }
}

/// The limits that a tree of the space could exceed: which thing, and how much of it may stand in the tree.
fn most(tree: &Tree, limits: &Limits, shared: &Amounts) -> Option<Vec<(usize, u32)>> {
    let mut found = Vec::new();
    for (thing, limit) in limits.most().into_iter().enumerate() {
        let Some(limit) = limit else { continue };
        let left = limit.checked_sub(shared[thing])?;
        let worst = largest(tree, |module| module.amounts[thing]);
        if worst > left {
            found.push((thing, left));
        }
    }
    Some(found)
}

/// The largest sum over the modules of one tree, or more.
fn largest(tree: &Tree, amount: impl Fn(&ModuleExpr) -> u32) -> u32 {
    let mut sums: Vec<u32> = Vec::with_capacity(tree.exprs.len());
    for expr in &tree.exprs {
        let row = expr.row().iter().fold(0u32, |sum, &id| sum.saturating_add(sums[id]));
        sums.push(match expr {
            Expr::OneOf { options, .. } => options.iter().flatten().map(|&id| sums[id]).max().unwrap_or(0),
            Expr::Module(module) => row.saturating_add(amount(module)),
            _ => row,
        });
    }
    sums.last().copied().unwrap_or(0)
}

/// What a label names: a module's category and name, and the label.
type Label = (String, String, String);

fn label_of(module: &ModuleExpr) -> Option<Label> {
    let label = module.label.clone()?;
    Some((module.module.category.clone(), module.module.name.clone(), label))
}

/// Labels that may stand more than once in a tree, and so must name equal subtrees.
fn contested(tree: &Tree) -> Vec<Label> {
    let mut labels: BTreeMap<Label, u32> = BTreeMap::new();
    for expr in &tree.exprs {
        if let Expr::Module(module) = expr
            && let Some(label) = label_of(module)
        {
            *labels.entry(label).or_default() += 1;
        }
    }
    let several: Vec<Label> = labels
        .into_iter()
        .filter(|&(_, number)| number > 1)
        .map(|(label, _)| label)
        .collect();
    // Alternatives with one label stand in no tree together. With very many labels that is not looked into: more is told apart than need be.
    if several.len().saturating_mul(tree.exprs.len()) > MOST_LOOKS {
        return several;
    }
    let twice = |label: &Label| largest(tree, |module| u32::from(label_of(module).as_ref() == Some(label))) > 1;
    several.into_iter().filter(twice).collect()
}

/// Most expressions that are looked at for labels.
const MOST_LOOKS: usize = 1 << 22;

/// Below a contested label every difference matters.
fn make_exact(tree: &mut Tree) {
    let mut exact = vec![false; tree.exprs.len()];
    for id in (0..tree.exprs.len()).rev() {
        let expr = &mut tree.exprs[id];
        if let Expr::Module(module) = expr {
            exact[id] |= module.own.label.is_some();
            if exact[id] {
                let label = module.label.as_deref().unwrap_or_default();
                module.own.exact = Some(format!("{}/{}#{label}", module.module.category, module.module.name));
            }
        }
        if !exact[id] {
            if let Expr::Value { exact, .. } = expr {
                *exact = None;
            }
            continue;
        }
        let inside = match expr {
            Expr::OneOf { options, .. } => options.iter().flatten().copied().collect(),
            other => other.row(),
        };
        for inner in inside {
            exact[inner] = true;
        }
    }
}
