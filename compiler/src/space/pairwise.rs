//! A small set of permutations in which any two options that can stand together do so somewhere.
//!
//! Greedy, one permutation at a time (Cohen, Dalal, Fredman and Patton 1997, The AETG System), but that what is possible beside what
//! was already decided is not tried out: it is read off the counts of the tree, so that every step keeps a legal end in reach.

use super::Space;
use super::count::{Fixed, Picks, UNCHOSEN};

/// Which options may stand together, by number among the options of all choices. Symmetric; an option stands with itself.
pub struct Pairs {
    /// For each option those that may stand beside it, a bit each.
    rows: Vec<Vec<u64>>,
}

impl Pairs {
    fn none(values: usize) -> Self {
        Self {
            rows: vec![vec![0; values.div_ceil(64)]; values],
        }
    }

    /// Whether two options may stand together.
    pub fn has(&self, a: usize, b: usize) -> bool {
        self.rows[a][b / 64] >> (b % 64) & 1 == 1
    }

    fn set(&mut self, a: usize, b: usize, to: bool) {
        for (a, b) in [(a, b), (b, a)] {
            let bit = 1u64 << (b % 64);
            if to {
                self.rows[a][b / 64] |= bit;
            } else {
                self.rows[a][b / 64] &= !bit;
            }
        }
    }

    fn left(&self, a: usize) -> u32 {
        self.rows[a].iter().map(|word| word.count_ones()).sum()
    }

    fn first(&self) -> Option<(usize, usize)> {
        self.rows.iter().enumerate().find_map(|(a, row)| {
            let word = row.iter().position(|word| *word != 0)?;
            Some((a, word * 64 + row[word].trailing_zeros() as usize))
        })
    }
}

/// The pairs of options of real choices that stand together in some legal permutation, each option with itself among them.
pub fn legal_pairs(space: &Space) -> Pairs {
    let values = space.tree.values;
    let mut pairs = Pairs::none(values);
    let real: Vec<bool> = (0..values).map(|value| space.is_real(space.tree.value(value).0)).collect();
    for a in (0..values).filter(|&a| real[a] && space.possible[a]) {
        let mut fixed: Fixed = vec![None; space.tree.points.len()];
        if !force(space, a, &mut fixed) {
            continue;
        }
        let beside = space.possible_with(&fixed);
        let point = space.tree.value(a).0;
        for b in (0..values).filter(|&b| real[b] && beside[b]) {
            if a == b || space.tree.value(b).0 != point {
                pairs.set(a, b, true);
            }
        }
    }
    pairs
}

/// Decides for an option, and for what it stands below of. `false` where that was decided otherwise.
fn force(space: &Space, value: usize, fixed: &mut Fixed) -> bool {
    let mut at = Some(space.tree.value(value));
    while let Some((point, option)) = at {
        if fixed[point].is_some_and(|only| only != option) {
            return false;
        }
        fixed[point] = Some(option);
        at = space.tree.points[point].parent;
    }
    true
}

/// The cover.
pub fn cover(space: &Space) -> Vec<Picks> {
    let mut open = legal_pairs(space);
    let mut found = Vec::new();
    if space.root().is_some() && space.count != Some(0) && open.first().is_none() {
        // Nothing to choose: the only permutation there is.
        found.extend(complete(space, vec![None; space.tree.points.len()], &open));
    }
    while let Some((a, b)) = open.first() {
        let mut fixed: Fixed = vec![None; space.tree.points.len()];
        let possible = force(space, a, &mut fixed) && force(space, b, &mut fixed);
        let picks = if possible { complete(space, fixed, &open) } else { None };
        // Legal pairs can be completed; one that cannot is given up, so that this always ends.
        open.set(a, b, false);
        let Some(picks) = picks else { continue };
        let chosen = chosen(space, &picks);
        for &a in &chosen {
            for &b in &chosen {
                open.set(a, b, false);
            }
        }
        found.push(picks);
    }
    found
}

/// Options that were chosen, by number.
fn chosen(space: &Space, picks: &Picks) -> Vec<usize> {
    let points = space.tree.points.iter().zip(picks);
    points
        .filter(|&(_, &pick)| pick != UNCHOSEN)
        .map(|(point, &pick)| point.first_value + pick as usize)
        .collect()
}

/// Decides the rest, each time for the option with the most pairs that are still to be covered.
fn complete(space: &Space, mut fixed: Fixed, open: &Pairs) -> Option<Picks> {
    let tree = &space.tree;
    let promise = promise(space, open);
    let mut possible = space.possible_with(&fixed);
    let mut forced = tree
        .points
        .iter()
        .zip(&fixed)
        .filter_map(|(point, only)| Some(point.first_value + (*only)? as usize));
    if forced.any(|value| !possible[value]) {
        return None;
    }
    let mut picks: Picks = vec![UNCHOSEN; tree.points.len()];
    let mut taken: Vec<usize> = Vec::new();
    for (index, point) in tree.points.iter().enumerate() {
        if point.parent.is_some_and(|(parent, option)| picks[parent] != option) {
            continue;
        }
        let options = 0..point.options.len();
        let candidates: Vec<usize> = options.map(|k| point.first_value + k).filter(|&v| possible[v]).collect();
        // None is possible where the choice itself was ruled out while opening.
        let Some(&first) = candidates.first() else { continue };
        let score = |value: usize| {
            let now = taken.iter().filter(|&&other| open.has(value, other)).count();
            (now, promise[value])
        };
        let best = candidates
            .iter()
            .fold(first, |best, &value| if score(value) > score(best) { value } else { best });
        let option = (best - point.first_value) as u32;
        picks[index] = option;
        taken.push(best);
        if candidates.len() > 1 {
            fixed[index] = Some(option);
            possible = space.possible_with(&fixed);
        }
    }
    Some(picks)
}

/// For each option the number of open pairs that it has, with those of the options that it opens.
fn promise(space: &Space, open: &Pairs) -> Vec<u64> {
    let mut promise: Vec<u64> = (0..space.tree.values).map(|value| u64::from(open.left(value))).collect();
    for point in space.tree.points.iter().rev() {
        if let Some((parent, option)) = point.parent {
            let below: u64 = promise[point.first_value..point.first_value + point.options.len()].iter().sum();
            promise[space.tree.points[parent].first_value + option as usize] += below;
        }
    }
    promise
}
