//! How many permutations there are, and which one has which number: dynamic programming over the opened tree.
//!
//! Every expression has a table: for each signature the number of ways to make it. A row of things that are taken one after the
//! other (the parts of a module, the elements of a list) has a table for each of its beginnings.

use std::collections::BTreeMap;

use super::signature::{NOTHING, SigId, Signatures};
use super::tree::{Expr, ExprId, Tree};

/// How many taken so far (of elements that may be left out), and the signature of them.
type Key = (u32, SigId);

/// Ways to make an expression.
#[derive(Clone, Debug, Default)]
pub struct Ways {
    /// For each beginning of the row, the empty one first.
    pub beginnings: Vec<Vec<(Key, u128)>>,
    /// For each signature, ascending.
    pub table: Vec<(SigId, u128)>,
}

/// One option for each choice of a permutation; [`UNCHOSEN`] where the choice does not come up.
pub type Picks = Vec<u32>;

/// The choice does not come up.
pub const UNCHOSEN: u32 = u32::MAX;

/// For each choice the only option that is allowed, where not all are.
pub type Fixed = Vec<Option<u32>>;

/// How signatures are put together: counting meets them first, everything after looks them up.
pub trait Rules {
    /// Two parts of one tree.
    fn sum(&mut self, a: SigId, b: SigId) -> Option<SigId>;
    /// What stands in a part of a module.
    fn enclose(&mut self, part: usize, inside: SigId) -> SigId;
    /// A module around its parts.
    fn wrap(&mut self, expr: ExprId, inside: SigId) -> Option<SigId>;
    /// A parameter's value.
    fn value(&mut self, text: &str) -> SigId;
}

/// Meets signatures.
pub struct Meeting<'a> {
    /// Where they are kept.
    pub signatures: &'a mut Signatures,
    /// The tree.
    pub tree: &'a Tree,
}

impl Rules for Meeting<'_> {
    fn sum(&mut self, a: SigId, b: SigId) -> Option<SigId> {
        self.signatures.sum(a, b)
    }
    fn enclose(&mut self, part: usize, inside: SigId) -> SigId {
        self.signatures.enclose(part, inside)
    }
    fn wrap(&mut self, expr: ExprId, inside: SigId) -> Option<SigId> {
        match &self.tree.exprs[expr] {
            Expr::Module(module) => self.signatures.wrap(expr, &module.own, inside),
            _ => Some(inside),
        }
    }
    fn value(&mut self, text: &str) -> SigId {
        self.signatures.value(text)
    }
}

/// Looks up signatures that counting has met.
pub struct Met<'a>(pub &'a Signatures);

impl Rules for Met<'_> {
    fn sum(&mut self, a: SigId, b: SigId) -> Option<SigId> {
        self.0.known_sum(a, b)
    }
    fn enclose(&mut self, part: usize, inside: SigId) -> SigId {
        self.0.known_enclosed(part, inside)
    }
    fn wrap(&mut self, expr: ExprId, inside: SigId) -> Option<SigId> {
        self.0.known_wrap(expr, inside)
    }
    fn value(&mut self, text: &str) -> SigId {
        self.0.known_value(text)
    }
}

/// Most sums of signatures that one count may take; beyond it rules tie together too much of the tree.
pub const MOST_SUMS: usize = 1 << 19;

/// Counts. Numbers saturate. `None` where it would take more than [`MOST_SUMS`].
pub fn ways(tree: &Tree, rules: &mut dyn Rules, fixed: &Fixed) -> Option<Vec<Ways>> {
    let mut all: Vec<Ways> = Vec::with_capacity(tree.exprs.len());
    let mut sums = 0usize;
    for (id, expr) in tree.exprs.iter().enumerate() {
        let ways = match expr {
            Expr::Value { exact, .. } => {
                let signature = exact.as_ref().map_or(NOTHING, |text| rules.value(text));
                Ways {
                    beginnings: Vec::new(),
                    table: vec![(signature, 1)],
                }
            }
            Expr::OneOf { point, options } => {
                let mut table: BTreeMap<SigId, u128> = BTreeMap::new();
                for (_, option) in allowed(fixed, *point, options) {
                    for &(signature, count) in &all[option].table {
                        add(table.entry(signature).or_default(), count);
                    }
                }
                Ways {
                    beginnings: Vec::new(),
                    table: table.into_iter().collect(),
                }
            }
            Expr::Module(_) | Expr::List(_) | Expr::SomeOf { .. } => {
                let beginnings = beginnings(expr, &all, rules, fixed, &mut sums)?;
                let mut table: BTreeMap<SigId, u128> = BTreeMap::new();
                for &(key, count) in beginnings.last().into_iter().flatten() {
                    if let Some(signature) = finished(expr, id, key, rules) {
                        add(table.entry(signature).or_default(), count);
                    }
                }
                Ways {
                    beginnings,
                    table: table.into_iter().collect(),
                }
            }
        };
        all.push(ways);
    }
    Some(all)
}

fn beginnings(expr: &Expr, all: &[Ways], rules: &mut dyn Rules, fixed: &Fixed, sums: &mut usize) -> Option<Vec<Vec<(Key, u128)>>> {
    let mut beginnings: Vec<Vec<(Key, u128)>> = vec![vec![((0, NOTHING), 1)]];
    for (index, element) in expr.row().into_iter().enumerate() {
        let mut table: BTreeMap<Key, u128> = BTreeMap::new();
        for &(key, count) in beginnings.last().into_iter().flatten() {
            if may_be_absent(expr, index, fixed) {
                add(table.entry(key).or_default(), count);
            }
            if !may_be_there(expr, index, fixed) {
                continue;
            }
            for &(signature, ways) in &all[element].table {
                *sums += 1;
                if let Some(next) = step(expr, index, key, signature, rules) {
                    add(table.entry(next).or_default(), count.saturating_mul(ways));
                }
            }
        }
        if *sums > MOST_SUMS {
            return None;
        }
        beginnings.push(table.into_iter().collect());
    }
    Some(beginnings)
}

fn add(to: &mut u128, count: u128) {
    *to = to.saturating_add(count);
}

/// The options of a choice that are possible at all and allowed.
fn allowed<'a>(fixed: &'a Fixed, point: usize, options: &'a [Option<ExprId>]) -> impl Iterator<Item = (u32, ExprId)> + 'a {
    let possible = options.iter().enumerate().filter_map(|(k, option)| Some((k as u32, (*option)?)));
    possible.filter(move |&(k, _)| fixed[point].is_none_or(|only| only == k))
}

fn may_be_absent(expr: &Expr, index: usize, fixed: &Fixed) -> bool {
    expr.element_point(index).is_some_and(|point| fixed[point] != Some(1))
}

fn may_be_there(expr: &Expr, index: usize, fixed: &Fixed) -> bool {
    expr.element_point(index).is_none_or(|point| fixed[point] != Some(0))
}

/// Whether it matters how many of its elements are there.
pub fn bounded(expr: &Expr) -> bool {
    matches!(expr, Expr::SomeOf { range, of, .. } if range.0 > 0 || (range.1 as usize) < of.len())
}

/// The next element of a row, there.
fn step(expr: &Expr, index: usize, (taken, before): Key, signature: SigId, rules: &mut dyn Rules) -> Option<Key> {
    let (signature, one) = match expr {
        Expr::Module(module) if module.own.exact.is_some() => (rules.enclose(index, signature), 0),
        Expr::SomeOf { range, .. } if bounded(expr) && taken >= range.1 => return None,
        Expr::SomeOf { .. } => (signature, u32::from(bounded(expr))),
        _ => (signature, 0),
    };
    Some((taken + one, rules.sum(before, signature)?))
}

/// The signature of a whole row.
fn finished(expr: &Expr, id: ExprId, (taken, signature): Key, rules: &mut dyn Rules) -> Option<SigId> {
    match expr {
        Expr::Module(_) => rules.wrap(id, signature),
        Expr::SomeOf { range, .. } if bounded(expr) && !(range.0..=range.1).contains(&taken) => None,
        _ => Some(signature),
    }
}

/// The `index`-th way to make an expression with a signature, written into `picks`. Counts must not be saturated.
pub fn unrank(tree: &Tree, signatures: &Signatures, ways: &[Ways], fixed: &Fixed, at: (ExprId, SigId), mut index: u128, picks: &mut Picks) {
    let (id, wanted) = at;
    let expr = &tree.exprs[id];
    let rules = &mut Met(signatures);
    if let Expr::OneOf { point, options } = expr {
        for (k, option) in allowed(fixed, *point, options) {
            let count = count_of(&ways[option], wanted);
            if index < count {
                picks[*point] = k;
                return unrank(tree, signatures, ways, fixed, (option, wanted), index, picks);
            }
            index -= count;
        }
        return;
    }
    let Some(last) = ways[id].beginnings.last() else { return };
    for &(key, count) in last {
        if finished(expr, id, key, rules) != Some(wanted) {
            continue;
        }
        if index < count {
            return unrank_row(tree, signatures, ways, fixed, (id, key), index, picks);
        }
        index -= count;
    }
}

fn unrank_row(
    tree: &Tree,
    signatures: &Signatures,
    ways: &[Ways],
    fixed: &Fixed,
    (id, mut key): (ExprId, Key),
    mut index: u128,
    picks: &mut Picks,
) {
    let expr = &tree.exprs[id];
    'elements: for (position, element) in expr.row().into_iter().enumerate().rev() {
        for way in row_ways(expr, ways, (id, position, element), key, fixed, &mut Met(signatures)) {
            if index >= way.count {
                index -= way.count;
                continue;
            }
            if let Some(point) = expr.element_point(position) {
                picks[point] = u32::from(way.there.is_some());
            }
            if let Some((signature, inner)) = way.there {
                unrank(tree, signatures, ways, fixed, (element, signature), index % inner, picks);
                index /= inner;
            }
            key = way.before;
            continue 'elements;
        }
        return;
    }
}

/// One way in which a beginning of a row ends in an element, or in the lack of it.
struct RowWay {
    /// The beginning without the element.
    before: Key,
    /// The element's signature and the number of ways to make it; `None` where it is left out.
    there: Option<(SigId, u128)>,
    /// Number of ways altogether.
    count: u128,
}

fn row_ways(
    expr: &Expr,
    ways: &[Ways],
    (id, position, element): (ExprId, usize, ExprId),
    key: Key,
    fixed: &Fixed,
    rules: &mut dyn Rules,
) -> Vec<RowWay> {
    let mut found = Vec::new();
    for &(before, count) in &ways[id].beginnings[position] {
        if before == key && may_be_absent(expr, position, fixed) {
            found.push(RowWay {
                before,
                there: None,
                count,
            });
        }
        if !may_be_there(expr, position, fixed) {
            continue;
        }
        for &(signature, inner) in &ways[element].table {
            if step(expr, position, before, signature, rules) == Some(key) {
                found.push(RowWay {
                    before,
                    there: Some((signature, inner)),
                    count: count.saturating_mul(inner),
                });
            }
        }
    }
    found
}

fn count_of(ways: &Ways, signature: SigId) -> u128 {
    let found = ways.table.binary_search_by_key(&signature, |&(s, _)| s);
    found.map_or(0, |at| ways.table[at].1)
}

/// The inverse of [`unrank`]: signature and number of the way that `picks` describe.
pub fn rank(tree: &Tree, signatures: &Signatures, ways: &[Ways], fixed: &Fixed, id: ExprId, picks: &Picks) -> Option<(SigId, u128)> {
    let expr = &tree.exprs[id];
    let rules = &mut Met(signatures);
    match expr {
        Expr::Value { .. } => ways[id].table.first().map(|&(signature, _)| (signature, 0)),
        Expr::OneOf { point, options } => {
            let chosen = picks[*point];
            let option = allowed(fixed, *point, options).find(|&(k, _)| k == chosen)?.1;
            let (signature, mut index) = rank(tree, signatures, ways, fixed, option, picks)?;
            for (_, before) in allowed(fixed, *point, options).take_while(|&(k, _)| k < chosen) {
                index += count_of(&ways[before], signature);
            }
            Some((signature, index))
        }
        Expr::Module(_) | Expr::List(_) | Expr::SomeOf { .. } => {
            let (mut key, mut index) = ((0, NOTHING), 0);
            for (position, element) in expr.row().into_iter().enumerate() {
                let there = match expr.element_point(position) {
                    Some(point) if picks[point] == 0 => None,
                    _ => Some(rank(tree, signatures, ways, fixed, element, picks)?),
                };
                let next = match there {
                    None => key,
                    Some((signature, _)) => step(expr, position, key, signature, rules)?,
                };
                let mut number = 0;
                for way in row_ways(expr, ways, (id, position, element), next, fixed, rules) {
                    if way.before == key && way.there.map(|(s, _)| s) == there.map(|(s, _)| s) {
                        break;
                    }
                    number += way.count;
                }
                let inner = there.map_or(1, |(signature, _)| count_of(&ways[element], signature));
                index = number + index * inner + there.map_or(0, |(_, index)| index);
                key = next;
            }
            let signature = finished(expr, id, key, rules)?;
            for &(other, count) in ways[id].beginnings.last()? {
                if other == key {
                    break;
                }
                if finished(expr, id, other, rules) == Some(signature) {
                    index += count;
                }
            }
            Some((signature, index))
        }
    }
}

/// For the options of all choices, whether a whole tree can have them.
pub fn possible(tree: &Tree, signatures: &Signatures, ways: &[Ways], fixed: &Fixed) -> Vec<bool> {
    let mut found = vec![false; tree.values];
    let rules = &mut Met(signatures);
    // For each expression the signatures with which it stands in a whole tree.
    let mut wanted: Vec<Vec<SigId>> = vec![Vec::new(); tree.exprs.len()];
    if let (Some(root), Some(table)) = (wanted.last_mut(), ways.last()) {
        root.extend(table.table.iter().map(|&(s, _)| s).filter(|&s| signatures.complete(s)));
    }
    for (id, expr) in tree.exprs.iter().enumerate().rev() {
        let mine = std::mem::take(&mut wanted[id]);
        if mine.is_empty() {
            continue;
        }
        if let Expr::OneOf { point, options } = expr {
            for (k, option) in allowed(fixed, *point, options) {
                for &(signature, _) in ways[option].table.iter().filter(|(s, _)| mine.contains(s)) {
                    found[tree.points[*point].first_value + k as usize] = true;
                    insert(&mut wanted[option], signature);
                }
            }
            continue;
        }
        let Some(last) = ways[id].beginnings.last() else { continue };
        let ends = |key: &Key| finished(expr, id, *key, &mut Met(signatures)).is_some_and(|s| mine.contains(&s));
        let mut keys: Vec<Key> = last.iter().map(|&(key, _)| key).filter(ends).collect();
        for (position, element) in expr.row().into_iter().enumerate().rev() {
            let mut earlier = Vec::new();
            for key in keys {
                for way in row_ways(expr, ways, (id, position, element), key, fixed, rules) {
                    if let Some(point) = expr.element_point(position) {
                        found[tree.points[point].first_value + usize::from(way.there.is_some())] = true;
                    }
                    if let Some((signature, _)) = way.there {
                        insert(&mut wanted[element], signature);
                    }
                    insert(&mut earlier, way.before);
                }
            }
            keys = earlier;
        }
    }
    found
}

fn insert<T: PartialEq>(list: &mut Vec<T>, item: T) {
    if !list.contains(&item) {
        list.push(item);
    }
}
