//! Spaces: recipes in which slots and parameters list alternatives.
//!
//! ```text
//! *.space.ron -> SpaceFile -> Tree of alternatives -> tables of counts -> permutations -> programs
//!                (format)     (open)                  (count)             (permutation)   (compile)
//! ```
//!
//! A space is never multiplied out. Opening makes a tree of alternatives, as large as the sum of what is listed, and leaves out what
//! a rule about the module above or a lacking capability forbids. What else decides whether a permutation is legal (rules about
//! children and about the tree, limits, labels) is seen through *signatures*: two fillings of a slot that no rule can tell apart have
//! one. Dynamic programming counts the ways to reach each signature; from the counts come the number of permutations, the permutation
//! of each number, uniform samples, and what is still possible beside what was decided.
//!
//! Permutations are numbered from 0. Those with one signature follow one another, otherwise the order is the written one, the last
//! choice changing fastest.

mod amounts;
mod compile;
mod count;
mod format;
mod open;
mod pairwise;
mod permutation;
mod sample;
mod signature;
mod tree;
mod values;
mod watch;

use std::sync::Arc;

use crate::catalog::Catalog;
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::limits;
use crate::resolve::{Place, Way};

pub use compile::{Compiled, Passes, Work, compile_all};
pub use format::{Choice, Fits, FitsChoice, Limits, Scale, SpaceFile, SpaceNode, SpaceRule, ValueRange, Values};
pub use open::{MOST_EXPRESSIONS, OPEN_DEPTH};
pub use permutation::{Chosen, Permutation};

use count::{Fixed, Meeting, Met, Picks, UNCHOSEN, Ways};
use signature::{SigId, Signatures};
use tree::{Expr, Tree};

/// A space, opened over a library and counted.
#[derive(Clone, Debug)]
pub struct Space {
    source: Arc<SourceFile>,
    place: Place,
    tree: Tree,
    signatures: Signatures,
    free: Fixed,
    ways: Vec<Ways>,
    /// Signatures of whole legal trees, with their counts.
    legal: Vec<(SigId, u128)>,
    /// `None` where it is more than can be numbered.
    count: Option<u128>,
    possible: Vec<bool>,
    /// Whether no choice bears on another but by being inside it.
    independent: bool,
    /// Of a space without permutations, what of its own text alone is the reason.
    blame: Vec<String>,
}

impl Space {
    /// Reads, opens and counts a space. `name` is what errors call the text.
    ///
    /// # Errors
    /// The text is no space, names what is not there, or is too large.
    pub fn parse(catalog: &Catalog, name: &str, text: &str) -> Result<Self, Report> {
        Self::open(catalog, &SpaceFile::parse(name, text)?)
    }

    /// Opens and counts a space.
    ///
    /// # Errors
    /// It names what is not there, or is too large or too tangled.
    pub fn open(catalog: &Catalog, file: &SpaceFile) -> Result<Self, Report> {
        check_tags(catalog, file)?;
        let mut space = Self::count_all(catalog, file)?;
        if space.count == Some(0) {
            space.blame = blame(catalog, file);
        }
        Ok(space)
    }

    fn count_all(catalog: &Catalog, file: &SpaceFile) -> Result<Self, Report> {
        let mut tree = open::open(catalog, file)?;
        let modules = tree.exprs.iter().filter_map(|expr| match expr {
            Expr::Module(module) => Some(module.module.as_ref()),
            _ => None,
        });
        let shared = amounts::shared(catalog, modules, &file.limits)?;
        let Some(mut signatures) = watch::watch(&mut tree, &file.rules, &file.limits, &shared) else {
            return Err(over_limits(file, &shared));
        };
        let free: Fixed = vec![None; tree.points.len()];
        let mut meeting = Meeting {
            signatures: &mut signatures,
            tree: &tree,
        };
        let place = open::root_place(file);
        let Some(ways) = count::ways(&tree, &mut meeting, &free) else {
            return Err(tangled(&place));
        };
        let ends = ways.last().map(|root| root.table.clone()).unwrap_or_default();
        let legal: Vec<(SigId, u128)> = ends.into_iter().filter(|&(s, _)| signatures.complete(s)).collect();
        let sum = legal.iter().fold(0u128, |sum, &(_, count)| sum.saturating_add(count));
        let possible = count::possible(&tree, &signatures, &ways, &free);
        let independent = signatures.only_nothing() && !tree.exprs.iter().any(count::bounded);
        Ok(Self {
            source: Arc::clone(&file.source),
            place,
            tree,
            signatures,
            free,
            ways,
            legal,
            count: (sum < u128::MAX).then_some(sum),
            possible,
            independent,
            blame: Vec::new(),
        })
    }

    /// The text it was read from.
    pub fn source(&self) -> &Arc<SourceFile> {
        &self.source
    }

    /// Number of legal permutations.
    ///
    /// # Errors
    /// There are 2^128 - 1 or more.
    pub fn count(&self) -> Result<u128, Report> {
        self.count.ok_or_else(|| {
            let message = format!("the space has {} permutations or more", u128::MAX);
            Diagnostic::new(codes::SPACE_UNCOUNTABLE, message)
                .at(&self.place.file, self.place.name_span(), "of this")
                .note("it can be covered pairwise; to number it, to walk through it or to sample it, leave alternatives out")
                .into()
        })
    }

    /// The error about a space without permutations, if it is one.
    ///
    /// # Errors
    /// That.
    pub fn not_empty(&self) -> Result<(), Report> {
        if self.count != Some(0) {
            return Ok(());
        }
        let found = Diagnostic::new(codes::SPACE_EMPTY, "no permutation of the space is legal").at(
            &self.place.file,
            self.place.name_span(),
            "nothing comes of this",
        );
        let found = self.blame.iter().fold(found, |found, text| found.note(text.clone()));
        Err(found
            .note("the rules of its modules, its own and its limits leave nothing; emit one of its recipes to see which rule it breaks")
            .into())
    }

    /// Number of choices with several options that can come up.
    pub fn choices(&self) -> usize {
        (0..self.tree.points.len()).filter(|&point| self.is_real(point)).count()
    }

    /// Alternatives that are listed but in no legal permutation: place and alternative.
    pub fn never(&self) -> Vec<Chosen> {
        // Of what is never itself, what is inside needs no word.
        let alive = |&(parent, option): &(usize, u32)| self.possible[self.tree.points[parent].first_value + option as usize];
        let points = self.tree.points.iter().filter(|point| point.parent.as_ref().is_none_or(alive));
        let options = points.flat_map(|point| {
            let alive = self.possible[point.first_value..].iter().take(point.options.len());
            let dead = point.options.iter().zip(alive).filter(|&(_, alive)| !alive);
            dead.map(|(option, _)| Chosen {
                place: point.path.clone(),
                chosen: option.clone(),
            })
        });
        let mut found: Vec<Chosen> = options.filter(|option| option.chosen != "absent").collect();
        found.dedup();
        found
    }

    /// The permutation of a number; `None` from [`Space::count`] on, and where there are too many to number.
    pub fn get(&self, index: u128) -> Option<Permutation> {
        let picks = self.picks(index)?;
        Some(self.permutation(Some(index), &picks))
    }

    /// All permutations in the order of their numbers, from a number on: to go on after an interruption, begin there.
    ///
    /// # Errors
    /// There are too many to number.
    pub fn iter_from(&self, first: u128) -> Result<impl Iterator<Item = Permutation> + '_, Report> {
        let count = self.count()?;
        Ok((first..count).filter_map(|index| self.get(index)))
    }

    /// All permutations in the order of their numbers.
    ///
    /// # Errors
    /// There are too many to number.
    pub fn iter(&self) -> Result<impl Iterator<Item = Permutation> + '_, Report> {
        self.iter_from(0)
    }

    /// Permutations in which any two options that can stand together in a legal permutation do so at least once. Greedy, so not the
    /// fewest; always the same.
    ///
    /// # Errors
    /// There are more than [`MOST_OPTIONS`] options.
    pub fn pairwise(&self) -> Result<Vec<Permutation>, Report> {
        if self.tree.values > MOST_OPTIONS {
            return Err(
                Diagnostic::new(codes::SPACE_TOO_LARGE, "the space has too many alternatives to cover pairwise")
                    .at(&self.place.file, self.place.name_span(), "of this")
                    .note(format!("it has {} options, at most {MOST_OPTIONS} are taken", self.tree.values))
                    .note("take a random sample, or leave alternatives out")
                    .into(),
            );
        }
        let cover = pairwise::cover(self).into_iter();
        Ok(cover.map(|picks| self.permutation(self.index_of(&picks), &picks)).collect())
    }

    /// Numbers of so many different permutations, ascending, each set of them as probable as any other. All where there are no more.
    ///
    /// # Errors
    /// There are too many to number, or more than [`limits::DRAWN`] would be drawn.
    pub fn random(&self, number: usize, seed: u64) -> Result<Vec<u128>, Report> {
        let count = self.count()?;
        let drawn = count.min(number as u128);
        if drawn > limits::DRAWN as u128 {
            let message = format!("{drawn} permutations are more than are drawn at once");
            return Err(Diagnostic::new(codes::SPACE_UNCOUNTABLE, message)
                .at(&self.place.file, self.place.name_span(), "of this")
                .note(format!("at most {} are drawn; all can be walked through", limits::DRAWN))
                .into());
        }
        Ok(sample::distinct(count, number, seed))
    }

    fn picks(&self, mut index: u128) -> Option<Picks> {
        let root = self.root().filter(|_| self.count.is_some())?;
        for &(signature, count) in &self.legal {
            if index < count {
                let mut picks = vec![UNCHOSEN; self.tree.points.len()];
                count::unrank(
                    &self.tree,
                    &self.signatures,
                    &self.ways,
                    &self.free,
                    (root, signature),
                    index,
                    &mut picks,
                );
                return Some(picks);
            }
            index -= count;
        }
        None
    }

    fn index_of(&self, picks: &Picks) -> Option<u128> {
        self.count?;
        let (signature, index) = count::rank(&self.tree, &self.signatures, &self.ways, &self.free, self.root()?, picks)?;
        let before = self.legal.iter().take_while(|&&(s, _)| s != signature);
        Some(before.map(|&(_, count)| count).sum::<u128>() + index)
    }

    fn permutation(&self, index: Option<u128>, picks: &Picks) -> Permutation {
        Permutation {
            index,
            choices: permutation::choices(&self.tree, picks, &self.possible),
            options: permutation::numbers(&self.tree, picks, &self.possible),
            recipe: permutation::recipe(&self.tree, picks),
        }
    }

    fn root(&self) -> Option<usize> {
        self.tree.exprs.len().checked_sub(1)
    }

    /// Whether several options of a choice can come up.
    fn is_real(&self, point: usize) -> bool {
        let point = &self.tree.points[point];
        let options = self.possible[point.first_value..].iter().take(point.options.len());
        options.filter(|possible| **possible).count() > 1
    }

    /// Which options are possible beside what is fixed.
    fn possible_with(&self, fixed: &Fixed) -> Vec<bool> {
        if self.independent {
            return self.possible_alone(fixed);
        }
        match count::ways(&self.tree, &mut Met(&self.signatures), fixed) {
            Some(ways) => count::possible(&self.tree, &self.signatures, &ways, fixed),
            // Never more sums than without anything fixed.
            None => vec![false; self.tree.values],
        }
    }

    /// The same where no choice bears on another but by being inside it: an option is possible unless what it is inside of was decided otherwise.
    fn possible_alone(&self, fixed: &Fixed) -> Vec<bool> {
        let mut found = self.possible.clone();
        for (point, only) in self.tree.points.iter().zip(fixed) {
            let inside = point
                .parent
                .is_none_or(|(parent, option)| found[self.tree.points[parent].first_value + option as usize]);
            for option in 0..point.options.len() {
                found[point.first_value + option] &= inside && only.is_none_or(|only| only as usize == option);
            }
        }
        found
    }
}

/// What of a space's own text leaves nothing by itself: without it something is legal.
fn blame(catalog: &Catalog, file: &SpaceFile) -> Vec<String> {
    let something = |file: &SpaceFile| Space::count_all(catalog, file).is_ok_and(|space| space.count != Some(0));
    let mut found = Vec::new();
    for (index, rule) in file.rules.iter().enumerate() {
        let mut without = file.clone();
        without.rules.remove(index);
        if something(&without) {
            let (SpaceRule::Requires { because, .. } | SpaceRule::Excludes { because, .. }) = rule;
            found.push(format!("without `rules[{index}]` something is: {because}"));
        }
    }
    let without = SpaceFile {
        limits: Limits::default(),
        ..file.clone()
    };
    if file.limits != without.limits && something(&without) {
        found.push("without `limits` something is".to_owned());
    }
    found
}

/// Most options that [`Space::pairwise`] takes ([`codes::SPACE_TOO_LARGE`]).
pub const MOST_OPTIONS: usize = 1 << 13;

fn tangled(place: &Place) -> Report {
    Diagnostic::new(codes::SPACE_TOO_TANGLED, "the rules tie together too much of the space")
        .at(&place.file, place.name_span(), "of this")
        .note("every tag, limit and label that rules look at multiplies what must be told apart: use fewer, or open less")
        .into()
}

fn over_limits(file: &SpaceFile, shared: &amounts::Amounts) -> Report {
    let at = Place::new(&file.source).keys(&["limits"]);
    let limits = file.limits.most().into_iter().zip(shared).zip(amounts::NAMES);
    let over = limits.filter_map(|((limit, &needed), name)| Some((limit?, needed, name)).filter(|&(limit, needed, _)| needed > limit));
    let text: Vec<String> = over
        .map(|(limit, needed, name)| format!("{needed} {name}, {limit} allowed"))
        .collect();
    Diagnostic::new(codes::SPACE_EMPTY, "no permutation of the space is legal")
        .at(&at.file, at.span(), "no tree keeps these limits")
        .note(format!("what every tree shares comes to {}", text.join(", ")))
        .into()
}

/// Tags of the space's rules that nobody has are slips of the pen.
fn check_tags(catalog: &Catalog, file: &SpaceFile) -> Result<(), Report> {
    let mut known: Vec<&str> = Vec::new();
    for module in catalog.modules() {
        known.extend([module.name.as_str(), module.category.as_str()]);
        known.extend(module.manifest.properties.iter().map(String::as_str));
        known.extend(module.manifest.instances.values().filter_map(|field| field.role.as_deref()));
    }
    known.extend(catalog.categories().map(|category| category.name.as_str()));
    tags(&file.root, &mut known);
    known.sort_unstable();
    known.dedup();
    for (index, rule) in file.rules.iter().enumerate() {
        let (SpaceRule::Requires { when, tag, .. } | SpaceRule::Excludes { when, tag, .. }) = rule;
        for (key, word) in [("when", when.as_ref()), ("tag", Some(tag))] {
            let Some(word) = word.filter(|word| known.binary_search(&word.as_str()).is_err()) else {
                continue;
            };
            let at = Place::new(&file.source).keys(&["rules"]).then(Way::Index(index)).keys(&[key]);
            return Err(Diagnostic::new(codes::UNKNOWN_TAG, format!("nothing has the tag `{word}`"))
                .at(&at.file, at.span(), "unknown")
                .note(
                    "a tag is a module's name, its category, a property that it claims, a role of one of its fields, or a tag of the space",
                )
                .suggest(word, "tags", known)
                .into());
        }
    }
    Ok(())
}

fn tags<'a>(choice: &'a Choice, known: &mut Vec<&'a str>) {
    match choice {
        Choice::Node(node) => {
            known.extend(node.tags.iter().map(String::as_str));
            node.fill.values().for_each(|choice| tags(choice, known));
        }
        Choice::List(of) | Choice::OneOf(of) | Choice::SomeOf { of, .. } => of.iter().for_each(|choice| tags(choice, known)),
        Choice::Fits(_) => {}
    }
}
