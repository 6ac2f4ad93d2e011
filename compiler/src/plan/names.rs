//! Emitted names: interfaces' items keep theirs, modules' items get the instance's before them.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use super::{Body, Home, Plan};
use crate::parse::scan::ItemKind;
use crate::parse::{Filter, Joined, Unit, joined, word_hash};

/// Emitted names of the items of all homes.
#[derive(Debug, Default)]
pub struct Names(Vec<HomeNames>);

#[derive(Debug, Default)]
struct HomeNames {
    /// What the unit's items, by their index in its scan, are called with the instance's name before them; behind the items what
    /// the linker itself adds to the unit.
    joined: Arc<Joined>,
    /// Items that are called something else, since that name is taken.
    renamed: Vec<(usize, String)>,
}

impl HomeNames {
    fn item(&self, item: usize) -> Option<&str> {
        match self.renamed.iter().find(|(index, _)| *index == item) {
            Some((_, name)) => Some(name),
            None => self.joined.names.get(item).map(|(name, _)| name.as_str()),
        }
    }

    /// Gives an item its name, or another one if that is taken.
    fn give(&mut self, item: usize, taken: &mut Taken) {
        let (name, hash) = &self.joined.names[item];
        if !taken.take(name, *hash) {
            self.renamed.push((item, taken.free(name.clone())));
        }
    }
}

impl Names {
    /// The emitted name of an item.
    pub fn get(&self, homes: &[Home], home: usize, name: &str) -> Option<&str> {
        let names = self.0.get(home)?;
        let scan = &homes[home].unit.scan;
        let index = scan.item_index(name).or_else(|| {
            let added = names.joined.added.iter().position(|own| own == name)?;
            Some(scan.items.len() + added)
        });
        names.item(index?)
    }

    /// The emitted name of an item by its index in the unit's scan.
    pub fn of_item(&self, home: usize, item: usize) -> Option<&str> {
        self.0.get(home)?.item(item)
    }

    /// The emitted name of what the linker adds to a unit, by its index: constants, overrides, `Instance`, `instances`.
    pub fn of_added(&self, homes: &[Home], home: usize, index: usize) -> Option<&str> {
        self.0.get(home)?.item(homes[home].unit.scan.items.len() + index)
    }

    /// All of them: home, name there, emitted name. Of functions that are not planned it is what they would be called.
    pub fn all<'n>(&'n self, homes: &'n [Home]) -> impl Iterator<Item = (usize, &'n str, &'n str)> {
        self.0.iter().enumerate().flat_map(|(home, names)| {
            let items = homes[home].unit.scan.items.iter().enumerate();
            let items = items.filter_map(|(index, item)| Some((item.name.as_str(), names.item(index)?)));
            let first = homes[home].unit.scan.items.len();
            let added = names.joined.added.iter().enumerate();
            let added = added.filter_map(move |(index, own)| Some((own.as_str(), names.item(first + index)?)));
            items.chain(added).map(move |(own, emitted)| (home, own, emitted))
        })
    }
}

/// Gives every planned function and every item of a unit its emitted name.
pub fn assign(plan: &mut Plan) {
    let mut taken = Taken::new(plan);
    let mut names: Vec<HomeNames> = plan.homes.iter().map(|_| HomeNames::default()).collect();
    // Home, item, function.
    let mut planned: Vec<(usize, usize, usize)> = Vec::with_capacity(plan.functions.len());
    for (index, function) in plan.functions.iter().enumerate() {
        let scan = &plan.homes[function.home].unit.scan;
        if !matches!(function.body, Body::Combined { .. })
            && let Some(item) = scan.item_index(function.source_name(&plan.homes))
        {
            planned.push((function.home, item, index));
        }
    }
    planned.sort_unstable();
    // Interfaces first: their names are the contract.
    let interfaces = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_none());
    let instances = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_some());
    for home in interfaces.chain(instances) {
        let unit = &plan.homes[home].unit;
        let given = &mut names[home];
        given.joined = unit.joined.get(unit, &plan.homes[home].prefix);
        let mut functions = planned[planned.partition_point(|&(of, ..)| of < home)..].iter().peekable();
        for (index, item) in unit.scan.items.iter().enumerate() {
            let function = functions.next_if(|&&(of, item, _)| (of, item) == (home, index));
            if item.name.is_empty() || (item.kind == ItemKind::Function && function.is_none()) {
                continue;
            }
            let function = function.map(|&(.., function)| &mut plan.functions[function]);
            // The root's entry points are what a host calls by name.
            if home == 0 && function.as_ref().is_some_and(|f| matches!(f.body, Body::Entry(_))) {
                given.renamed.push((index, taken.free(item.name.clone())));
            } else {
                given.give(index, &mut taken);
            }
            if let (Some(function), Some(name)) = (function, given.item(index)) {
                function.name = name.to_owned();
            }
        }
        for index in unit.scan.items.len()..given.joined.names.len() {
            given.give(index, &mut taken);
        }
    }
    for index in 0..plan.functions.len() {
        if let Body::Combined { slot, function, .. } = &plan.functions[index].body {
            let prefix = &plan.homes[plan.functions[index].home].prefix;
            let wanted = if slot == function {
                format!("{prefix}_{slot}")
            } else {
                format!("{prefix}_{slot}_{function}")
            };
            plan.functions[index].name = taken.free(wanted);
        }
    }
    plan.names = Names(names);
}

/// Names that are taken: those of the blocks and those given so far. The words of every text of the plan are not given
/// either, lest a renamed item be captured by a local or hide a word of the language.
struct Taken {
    /// By hash: two names of one hash cost the second an underscore.
    given: HashSet<u64>,
    words: Filter,
    units: Vec<Arc<Unit>>,
}

impl Taken {
    fn new(plan: &Plan) -> Self {
        let items = plan.homes.iter().map(|home| home.unit.scan.items.len()).sum();
        let mut taken = Self {
            given: HashSet::with_capacity_and_hasher(items, Default::default()),
            words: Filter::default(),
            units: Vec::with_capacity(plan.homes.len()),
        };
        for (_, home) in plan.homes.iter().enumerate().filter(|(index, home)| home.first == *index) {
            home.unit.word_hashes.iter().for_each(|&hash| taken.words.insert(hash));
            taken.units.push(Arc::clone(&home.unit));
        }
        for group in super::GROUPS {
            for name in [format!("{group}_params"), joined(group, "Params")] {
                taken.given.insert(word_hash(&name));
            }
        }
        taken
    }

    /// Takes a name if it is free.
    fn take(&mut self, name: &str, hash: u64) -> bool {
        let is_word = self.words.may_have(hash) && self.units.iter().any(|u| u.words.contains(name));
        !is_word && self.given.insert(hash)
    }

    fn free(&mut self, wanted: String) -> String {
        let mut name = wanted;
        while !self.take(&name, word_hash(&name)) {
            name.push('_');
        }
        name
    }
}
