//! What goes from the text of a function that keeps only its living parts.

use std::ops::Range;

use crate::parse::scan::ItemKind;
use crate::parse::{Constructor, Cuts, Facts, Let, Origin, Unit, Value};
use crate::plan::{Plan, Planned};

/// Finds the dead text of a function. Stretches may nest.
pub fn dead_text(plan: &Plan, planned: &Planned, dead: &mut Vec<Range<usize>>) {
    let unit = &plan.homes[planned.home].unit;
    let (Some(facts), Some(cuts)) = (planned.facts(&plan.homes), planned.cuts(&plan.homes)) else {
        return;
    };
    dead.extend(cuts.branches.iter().cloned());
    statements(plan, planned, facts, cuts, dead);
    for constructor in &cuts.constructors {
        arguments(plan, planned, constructor, dead);
    }
    lets(plan, planned, unit, &cuts.lets, dead);
}

/// Stores into members that nobody reads, and calls that can go.
fn statements(plan: &Plan, planned: &Planned, facts: &Facts, cuts: &Cuts, dead: &mut Vec<Range<usize>>) {
    let unit = &plan.homes[planned.home].unit;
    for (store, cut) in facts.stores.iter().zip(&cuts.stores) {
        let unread = |&(ty, member): &(naga::Handle<naga::Type>, u32)| {
            let id = plan.structs.id(planned.home, ty);
            id.is_some_and(|id| !plan.structs.is_live(id, member))
        };
        if store.path.iter().any(unread) {
            dead.extend(cut.clone());
        }
    }
    for (call, cut) in facts.calls.iter().zip(&cuts.calls) {
        let unread = call.result.is_none_or(|r| !planned.live[r.index()]);
        if unread && !planned.is_kept(&plan.functions, unit, call.callee) {
            dead.extend(cut.clone());
        }
    }
}

/// `S(a, b, c)` of a struct that lost members loses their arguments.
fn arguments(plan: &Plan, planned: &Planned, constructor: &Constructor, dead: &mut Vec<Range<usize>>) {
    let unit = &plan.homes[planned.home].unit;
    let tokens = &unit.scan.tokens;
    let name = unaliased(plan, unit, &constructor.name);
    let declared = match unit.origin(name) {
        Some(Origin::Interface(category)) => plan.interface_home(category),
        Some(Origin::Own) => Some(plan.homes[planned.home].first),
        _ => None,
    };
    let Some(id) = declared.and_then(|home| plan.structs.named(&plan.homes, home, name)) else {
        return;
    };
    let close = constructor.bounds.last().copied().unwrap_or_default();
    for (member, pair) in constructor.bounds.windows(2).enumerate() {
        if pair[0] + 1 == pair[1] || plan.structs.is_live(id, member as u32) {
            continue;
        }
        // With the comma behind it, or, of the last one, the comma before it.
        let range = if pair[1] == close {
            let kept_before = (0..member).any(|m| plan.structs.is_live(id, m as u32));
            let from = if kept_before { tokens[pair[0]].start } else { tokens[pair[0]].end };
            from as usize..tokens[close].start as usize
        } else {
            let to = tokens.get(pair[1] + 1).map_or(tokens[pair[1]].end, |t| t.start);
            tokens[pair[0] + 1].start as usize..to as usize
        };
        dead.push(range);
    }
}

/// `let`s whose value nobody needs, and assignments to `_`: unless they call something.
fn lets(plan: &Plan, planned: &Planned, unit: &Unit, lets: &[Let], dead: &mut Vec<Range<usize>>) {
    let is_dead = |dead: &[Range<usize>], at: usize| dead.iter().any(|range| range.contains(&at));
    // Removing one may leave another without readers.
    loop {
        let before = dead.len();
        for declared in lets {
            if declared.acts || is_dead(dead, declared.start) {
                continue;
            }
            let kept = |&callee: &naga::Handle<naga::Function>| planned.is_kept(&plan.functions, unit, callee);
            let unread = || !declared.uses.iter().any(|&at| !is_dead(dead, at));
            if !declared.callees.iter().any(kept) && (declared.phony || unneeded(planned, lets, declared) || unread()) {
                dead.push(declared.cut.clone());
            }
        }
        if dead.len() == before {
            return;
        }
    }
}

/// Whether the IR knows the value of a `let`, and knows it to be dead.
fn unneeded(planned: &Planned, lets: &[Let], declared: &Let) -> bool {
    match declared.value {
        Value::Expression(value) => !planned.live[value.index()],
        // An earlier one: this ends.
        Value::Earlier(index) => unneeded(planned, lets, &lets[index]),
        Value::Unknown => false,
    }
}

/// What `alias A = S;` of a module or of an interface stands for; other names as they are.
fn unaliased<'p>(plan: &'p Plan, unit: &'p Unit, mut name: &'p str) -> &'p str {
    // An alias cannot lead to itself: naga has accepted the unit.
    loop {
        let declares = match unit.origin(name) {
            Some(Origin::Interface(category)) => plan.interface_home(category).map_or(unit, |home| &plan.homes[home].unit),
            _ => unit,
        };
        match declares
            .scan
            .item(name)
            .filter(|i| i.kind == ItemKind::Alias && i.tokens.len() == 5)
        {
            Some(item) => name = &declares.file.text[declares.scan.tokens[item.tokens.start + 3].range()],
            None => return name,
        }
    }
}
