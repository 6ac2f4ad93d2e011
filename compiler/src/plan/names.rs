//! Emitted names: interfaces' items keep theirs, modules' items get the instance's before them.

use std::sync::Arc;

use rustc_hash::FxHashSet as HashSet;

use super::{Body, Home, Plan};
use crate::parse::scan::ItemKind;
use crate::parse::{Filter, Unit, constant_name, word_hash};

/// Emitted names of the items of all homes. Functions that are not planned have none.
#[derive(Debug, Default)]
pub struct Names(Vec<HomeNames>);

#[derive(Debug, Default)]
struct HomeNames {
    /// By the item's index in the unit's scan.
    items: Vec<Option<String>>,
    /// Of what the linker itself adds to the unit: name there, emitted name. Constants, overrides, `Instance`, `instances`.
    added: Vec<(String, String)>,
}

impl Names {
    /// The emitted name of an item.
    pub fn get(&self, homes: &[Home], home: usize, name: &str) -> Option<&str> {
        let names = self.0.get(home)?;
        match homes[home].unit.scan.item_index(name) {
            Some(index) => names.items.get(index)?.as_deref(),
            None => names.added.iter().find(|(own, _)| own == name).map(|(_, emitted)| emitted.as_str()),
        }
    }

    /// The emitted name of an item by its index in the unit's scan.
    pub fn of_item(&self, home: usize, item: usize) -> Option<&str> {
        self.0.get(home)?.items.get(item)?.as_deref()
    }

    /// The emitted name of what the linker adds to a unit, by its index: constants, overrides, `Instance`, `instances`.
    pub fn of_added(&self, home: usize, index: usize) -> Option<&str> {
        self.0.get(home)?.added.get(index).map(|(_, emitted)| emitted.as_str())
    }

    /// All of them: home, name there, emitted name.
    pub fn all<'n>(&'n self, homes: &'n [Home]) -> impl Iterator<Item = (usize, &'n str, &'n str)> {
        self.0.iter().enumerate().flat_map(|(home, names)| {
            let items = names.items.iter().zip(&homes[home].unit.scan.items);
            let items = items.filter_map(|(emitted, item)| Some((item.name.as_str(), emitted.as_deref()?)));
            let added = names.added.iter().map(|(own, emitted)| (own.as_str(), emitted.as_str()));
            items.chain(added).map(move |(own, emitted)| (home, own, emitted))
        })
    }
}

/// Gives every planned function and every item of a unit its emitted name.
pub fn assign(plan: &mut Plan) {
    let mut taken = Taken::new(plan);
    let mut names: Vec<HomeNames> = plan.homes.iter().map(|_| HomeNames::default()).collect();
    let mut planned: Vec<Vec<(usize, usize)>> = vec![Vec::new(); plan.homes.len()];
    for (index, function) in plan.functions.iter().enumerate() {
        let scan = &plan.homes[function.home].unit.scan;
        if !matches!(function.body, Body::Combined { .. })
            && let Some(item) = scan.item_index(function.source_name(&plan.homes))
        {
            planned[function.home].push((item, index));
        }
    }
    // Interfaces first: their names are the contract.
    let interfaces = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_none());
    let instances = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_some());
    for home in interfaces.chain(instances) {
        let unit = &plan.homes[home].unit;
        let prefix = &plan.homes[home].prefix;
        let given = &mut names[home];
        given.items = vec![None; unit.scan.items.len()];
        planned[home].sort_unstable();
        let mut functions = planned[home].iter().peekable();
        for (index, item) in unit.scan.items.iter().enumerate() {
            let function = functions.next_if(|(item, _)| *item == index).map(|&(_, function)| function);
            if item.name.is_empty() || (item.kind == ItemKind::Function && function.is_none()) {
                continue;
            }
            let entry = function.is_some_and(|f| matches!(plan.functions[f].body, Body::Entry(_)));
            // The root's entry points are what a host calls by name.
            let wanted = if entry && home == 0 {
                item.name.clone()
            } else {
                joined(prefix, &item.name)
            };
            let name = taken.free(wanted);
            if let Some(function) = function {
                plan.functions[function].name.clone_from(&name);
            }
            given.items[index] = Some(name);
        }
        for name in unit.needs.constants.keys().chain(unit.needs.overrides.keys()) {
            given.added.push((constant_name(name), taken.free(joined(prefix, name))));
        }
        if !unit.needs.instances.is_empty() {
            for name in ["Instance", "instances"] {
                given.added.push((name.to_owned(), taken.free(joined(prefix, name))));
            }
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
        let mut taken = Self {
            given: HashSet::default(),
            words: Filter::default(),
            units: Vec::new(),
        };
        for (_, home) in plan.homes.iter().enumerate().filter(|(index, home)| home.first == *index) {
            taken.words.join(&home.unit.words_filter);
            taken.units.push(Arc::clone(&home.unit));
        }
        for group in super::GROUPS {
            for name in [format!("{group}_params"), joined(group, "Params")] {
                taken.given.insert(word_hash(&name));
            }
        }
        taken
    }

    fn free(&mut self, wanted: String) -> String {
        let mut name = wanted;
        loop {
            let hash = word_hash(&name);
            let is_word = self.words.may_have(hash) && self.units.iter().any(|u| u.words.contains(&name));
            if !is_word && self.given.insert(hash) {
                return name;
            }
            name.push('_');
        }
    }
}

/// Instance and item in the item's own style: `point_light`, `PointInstance`, `POINT_LIMIT`.
pub fn joined(prefix: &str, name: &str) -> String {
    if prefix.is_empty() {
        return name.to_owned();
    }
    let upper = name.bytes().any(|c| c.is_ascii_uppercase());
    let lower = name.bytes().any(|c| c.is_ascii_lowercase());
    let mut joined = String::with_capacity(prefix.len() + 1 + name.len());
    if upper && !lower {
        joined.push_str(prefix);
        joined.make_ascii_uppercase();
        joined.push('_');
    } else if name.starts_with(|c: char| c.is_ascii_uppercase()) {
        for part in prefix.split('_').filter(|p| !p.is_empty()) {
            let (head, tail) = part.split_at(1);
            joined.extend(head.chars().map(|c| c.to_ascii_uppercase()));
            joined.push_str(tail);
        }
    } else {
        joined.push_str(prefix);
        joined.push('_');
    }
    joined + name
}
