//! Emitted names: interfaces' items keep theirs, modules' items get the instance's before them.

use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

use super::{Body, Plan};

/// Gives every function and every item of a unit its emitted name.
pub fn assign(plan: &mut Plan) {
    let mut names = Names::new(plan);
    // Interfaces first: their names are the contract.
    let interfaces = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_none());
    let instances = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_some());
    let order: Vec<usize> = interfaces.chain(instances).collect();
    let mut functions: HashMap<(usize, String), usize> = HashMap::default();
    for (index, planned) in plan.functions.iter().enumerate() {
        if !matches!(planned.body, Body::Combined { .. }) {
            functions.insert((planned.home, planned.source_name(&plan.homes).to_owned()), index);
        }
    }
    for home in order {
        let unit = std::sync::Arc::clone(&plan.homes[home].unit);
        let prefix = plan.homes[home].prefix.clone();
        for item in unit.scan.items.iter().filter(|i| !i.name.is_empty()) {
            let function = functions.get(&(home, item.name.clone())).copied();
            let entry = function.is_some_and(|f| matches!(plan.functions[f].body, Body::Entry(_)));
            // The root's entry points are what a host calls by name.
            let wanted = if entry && home == 0 {
                item.name.clone()
            } else {
                joined(&prefix, &item.name)
            };
            let name = names.free(wanted);
            if let Some(function) = function {
                plan.functions[function].name.clone_from(&name);
            }
            plan.names.insert((home, item.name.clone()), name);
        }
        for name in unit.needs.overrides.keys().chain(unit.needs.constants.keys()) {
            let emitted = names.free(joined(&prefix, name));
            plan.names.insert((home, crate::parse::constant_name(name)), emitted);
        }
        if !unit.needs.instances.is_empty() {
            for name in ["Instance", "instances"] {
                let emitted = names.free(joined(&prefix, name));
                plan.names.insert((home, name.to_owned()), emitted);
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
            plan.functions[index].name = names.free(wanted);
        }
    }
}

/// Names that are taken: those of the blocks and those given so far. The words of every text of the plan are not given
/// either, lest a renamed item be captured by a local or hide a word of the language.
struct Names {
    given: HashSet<String>,
    units: Vec<std::sync::Arc<crate::parse::Unit>>,
}

impl Names {
    fn new(plan: &Plan) -> Self {
        let mut given = HashSet::default();
        for group in super::GROUPS {
            given.insert(format!("{group}_params"));
            given.insert(joined(group, "Params"));
        }
        let first = |&(index, home): &(usize, &super::Home)| home.first == index;
        let units = plan
            .homes
            .iter()
            .enumerate()
            .filter(first)
            .map(|(_, h)| std::sync::Arc::clone(&h.unit))
            .collect();
        Self { given, units }
    }

    fn free(&mut self, wanted: String) -> String {
        let mut name = wanted;
        while self.given.contains(&name) || self.units.iter().any(|u| u.words.contains(&name)) {
            name.push('_');
        }
        self.given.insert(name.clone());
        name
    }
}

/// Instance and item in the item's own style: `point_light`, `PointInstance`, `POINT_LIMIT`.
pub fn joined(prefix: &str, name: &str) -> String {
    if prefix.is_empty() {
        return name.to_owned();
    }
    let upper = name.chars().any(|c| c.is_ascii_uppercase());
    let lower = name.chars().any(|c| c.is_ascii_lowercase());
    match (upper, lower) {
        (true, false) => format!("{}_{name}", prefix.to_ascii_uppercase()),
        _ if name.starts_with(|c: char| c.is_ascii_uppercase()) => {
            let mut camel = String::new();
            for part in prefix.split('_').filter(|p| !p.is_empty()) {
                let (head, tail) = part.split_at(1);
                camel.push_str(&head.to_ascii_uppercase());
                camel.push_str(tail);
            }
            camel + name
        }
        _ => format!("{prefix}_{name}"),
    }
}
