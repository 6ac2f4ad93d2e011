//! Writing a plan as source: the authors' own text, only what is reached, with linked names and bindings.

use rustc_hash::FxHashMap as HashMap;
use std::collections::{BTreeSet, VecDeque};
use std::fmt::Write as _;
use std::ops::Range;

use super::edits::{Edit, dead_text};
use crate::manifest::Combine;
use crate::parse::scan::{Item, ItemKind, whole_lines};
use crate::parse::{Origin, StructKey, constant_name, param_uses, typed_wgsl, wgsl_type};
use crate::plan::{Body, GROUPS, Plan, Planned, joined};

/// Writes the source form.
pub fn write_source(plan: &Plan) -> String {
    let mut writer = Writer {
        plan,
        wanted: BTreeSet::new(),
        queue: VecDeque::new(),
        params: HashMap::default(),
    };
    for (number, block) in plan.blocks.iter().enumerate() {
        for member in &block.members {
            writer
                .params
                .insert((member.home, member.param.clone()), (number, member.name.clone()));
        }
    }
    writer.write()
}

struct Writer<'p> {
    plan: &'p Plan,
    /// Items other than functions that some written text names: home, name.
    wanted: BTreeSet<(usize, String)>,
    queue: VecDeque<(usize, String)>,
    /// Block and member of a uniform parameter.
    params: HashMap<(usize, String), (usize, String)>,
}

impl Writer<'_> {
    fn write(&mut self) -> String {
        let plan = self.plan;
        let mut functions = String::new();
        for planned in &plan.functions {
            functions.push('\n');
            functions.push_str(&self.function(planned));
        }
        for global in &plan.globals {
            let unit = &plan.homes[global.home].unit;
            if let Some(name) = &unit.ir.global_variables[global.handle].name {
                self.want(global.home, name);
            }
        }
        let mut items: HashMap<(usize, String), (ItemKind, String)> = HashMap::default();
        while let Some((home, name)) = self.queue.pop_front() {
            if let Some(written) = self.item(home, &name) {
                items.insert((home, name), written);
            }
        }
        let mut out = self.directives();
        // Interfaces first, instances in tree order, each in the order of its text.
        for kinds in [
            &[ItemKind::Constant, ItemKind::Override][..],
            &[ItemKind::Alias, ItemKind::Struct][..],
            &[ItemKind::Variable][..],
        ] {
            for home in self.homes_in_order() {
                for name in self.names_in_order(home) {
                    if let Some((kind, text)) = items.get(&(home, name))
                        && kinds.contains(kind)
                    {
                        self.gap(&mut out, *kind);
                        out.push_str(text);
                    }
                }
            }
            if kinds.contains(&ItemKind::Struct) {
                self.blocks(&mut out);
            }
        }
        out.push_str(&functions);
        out.trim_start().to_owned()
    }

    fn gap(&self, out: &mut String, kind: ItemKind) {
        let flat = matches!(kind, ItemKind::Constant | ItemKind::Override | ItemKind::Variable | ItemKind::Alias);
        if !flat || out.ends_with("}\n") {
            out.push('\n');
        }
    }

    fn homes_in_order(&self) -> Vec<usize> {
        let homes = &self.plan.homes;
        let interfaces = (0..homes.len()).filter(|&h| homes[h].instance.is_none());
        interfaces
            .chain((0..homes.len()).filter(|&h| homes[h].instance.is_some()))
            .collect()
    }

    /// Names of a home's items, the linker's own first.
    fn names_in_order(&self, home: usize) -> Vec<String> {
        let unit = &self.plan.homes[home].unit;
        let mut names: Vec<String> = unit
            .needs
            .constants
            .keys()
            .chain(unit.needs.overrides.keys())
            .map(|n| constant_name(n))
            .collect();
        names.extend(["Instance".to_owned(), "instances".to_owned()]);
        names.extend(unit.scan.items.iter().map(|i| i.name.clone()));
        let mut seen = BTreeSet::new();
        names.retain(|n| !n.is_empty() && seen.insert(n.clone()));
        names
    }

    fn want(&mut self, home: usize, name: &str) {
        if self.wanted.insert((home, name.to_owned())) {
            self.queue.push_back((home, name.to_owned()));
        }
    }

    /// `enable` and `requires` of every unit that has a function here.
    fn directives(&self) -> String {
        let mut lines = BTreeSet::new();
        for planned in &self.plan.functions {
            let unit = &self.plan.homes[planned.home].unit;
            for item in unit.scan.items.iter().filter(|i| i.kind == ItemKind::Directive) {
                let text = &unit.file.text[item.span.clone()];
                if !text.starts_with("diagnostic") {
                    lines.insert(text.to_owned());
                }
            }
        }
        lines.into_iter().map(|line| line + "\n").collect()
    }

    fn blocks(&self, out: &mut String) {
        for block in &self.plan.blocks {
            let group = GROUPS[block.group as usize];
            // Infallible: writing to a string.
            let _ = writeln!(out, "\nstruct {} {{", joined(group, "Params"));
            for member in &block.members {
                let declared = self.plan.homes[member.home].unit.needs.uniforms.get(&member.param);
                let Some(param) = declared else { continue };
                if !param.doc.is_empty() {
                    let unit = if param.unit.is_empty() || param.unit == "1" {
                        String::new()
                    } else {
                        format!(" [{}]", param.unit)
                    };
                    let _ = writeln!(out, "    /// {}{unit}", param.doc.replace('\n', " "));
                }
                let _ = writeln!(out, "    {}: {},", member.name, wgsl_type(param.ty));
            }
            out.push_str("}\n");
        }
        for block in &self.plan.blocks {
            let group = GROUPS[block.group as usize];
            let (number, ty) = (block.binding, joined(group, "Params"));
            let _ = writeln!(
                out,
                "\n@group({}) @binding({number}) var<uniform> {group}_params: {ty};",
                block.group
            );
        }
    }

    /// An item other than a function.
    fn item(&mut self, home: usize, name: &str) -> Option<(ItemKind, String)> {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        let emitted = plan.names.get(&(home, name.to_owned())).cloned().unwrap_or_else(|| name.to_owned());
        match unit.origin(name) {
            Some(Origin::Param(param)) => {
                if let Some(value) = unit.needs.constants.get(param) {
                    return Some((
                        ItemKind::Constant,
                        format!("const {emitted}: {} = {};\n", typed_wgsl(value), value.wgsl()),
                    ));
                }
                let (declared, default) = unit.needs.overrides.get(param)?;
                Some((
                    ItemKind::Override,
                    format!("override {emitted}: {} = {};\n", wgsl_type(declared.ty), default.wgsl()),
                ))
            }
            Some(Origin::Instances) if name == "Instance" => {
                Some((ItemKind::Struct, crate::parse::fields_struct(&emitted, &unit.needs.instances)))
            }
            Some(Origin::Instances) => {
                let declared = plan.shared_home(home);
                self.want(declared, "Instance");
                let ty = plan.names.get(&(declared, "Instance".to_owned()))?;
                Some((
                    ItemKind::Variable,
                    format!("{}var<storage, read> {emitted}: array<{ty}>;\n", self.binding(home, name)?),
                ))
            }
            Some(Origin::Own) => {
                let item = unit.scan.item(name).filter(|i| i.kind != ItemKind::Function)?;
                let mut edits = self.references(home, item, None);
                edits.push((item.name_span.clone(), emitted));
                if item.kind == ItemKind::Struct {
                    let key = (plan.homes[home].first, name);
                    self.dead_members(key, home, item, &mut edits);
                }
                if item.kind == ItemKind::Variable
                    && let Some(binding) = self.binding(home, name)
                {
                    edits.push((item.span.start..item.span.start, binding));
                }
                let mut text = apply(&unit.file.text, item.doc_start..item.span.end, edits);
                text.push('\n');
                Some((item.kind, text))
            }
            _ => None,
        }
    }

    fn binding(&self, home: usize, name: &str) -> Option<String> {
        let unit = &self.plan.homes[home].unit;
        let global = self
            .plan
            .globals
            .iter()
            .find(|g| g.home == home && unit.ir.global_variables[g.handle].name.as_deref() == Some(name))?;
        let (group, binding) = global.binding?;
        Some(format!("@group({group}) @binding({binding}) "))
    }

    fn dead_members(&self, (declared, name): (usize, &str), home: usize, item: &Item, edits: &mut Vec<Edit>) {
        let unit = &self.plan.homes[home].unit;
        let key = StructKey {
            interface: None,
            name: name.to_owned(),
        };
        let Some(id) = self
            .plan
            .structs
            .named(declared, name)
            .filter(|_| !unit.fixed_structs.contains(&key))
        else {
            return;
        };
        let text = &unit.file.text;
        for (index, field) in item.fields.iter().enumerate() {
            if self.plan.structs.is_live(id, index as u32) {
                continue;
            }
            let bytes = unit.scan.bytes(&field.tokens);
            let mut end = bytes.end;
            if unit.scan.tokens.get(field.tokens.end).is_some_and(|t| t.is(b',')) {
                end = unit.scan.tokens[field.tokens.end].end as usize;
            }
            edits.push((whole_lines(text, &unit.scan.tokens, bytes.start..end), String::new()));
        }
    }

    fn function(&mut self, planned: &Planned) -> String {
        let plan = self.plan;
        let home = &plan.homes[planned.home];
        let unit = &home.unit;
        if let Body::Combined { stub, rule, slot, .. } = &planned.body {
            return self.combined(planned, *stub, *rule, slot);
        }
        let Some(item) = unit.scan.item(planned.source_name(&plan.homes)) else {
            return String::new();
        };
        let dead = dead_text(plan, planned, item);
        let mut edits = self.references(planned.home, item, Some((planned, &dead)));
        edits.push((item.name_span.clone(), planned.name.clone()));
        edits.extend(dead.into_iter().map(|range| (range, String::new())));
        let mut text = String::new();
        let (file, span) = unit.file.origin(item.span.clone());
        let line = file.position(span.start).line;
        let place = home.instance.map_or_else(String::new, |i| {
            let paths: Vec<&str> = plan.instances.list[i]
                .nodes
                .iter()
                .map(|&n| plan.tree.nodes[n].path.as_str())
                .collect();
            format!(" at {}", paths.join(", "))
        });
        let _ = writeln!(text, "// {}:{line}{place}", file.name);
        for directive in unit.scan.items.iter().filter(|i| i.kind == ItemKind::Directive) {
            // A filter of the module's file holds for the module's functions alone.
            let directive = unit.file.text[directive.span.clone()].trim_end_matches(';');
            if directive.starts_with("diagnostic") {
                let _ = writeln!(text, "@{directive}");
            }
        }
        text.push_str(&apply(&unit.file.text, item.doc_start..item.span.end, edits));
        text.push('\n');
        text
    }

    fn combined(&mut self, planned: &Planned, stub: naga::Handle<naga::Function>, rule: Combine, slot: &str) -> String {
        let plan = self.plan;
        let unit = &plan.homes[planned.home].unit;
        let ir = &unit.ir.functions[stub];
        let span = unit.ir.functions.get_span(stub).to_range().unwrap_or_default();
        // The stub's text stands in the composed text; its header is the signature.
        let header = unit.composed.text.get(span).and_then(|t| t.split('{').next()).unwrap_or_default();
        let parameters = header.split_once('(').map_or("", |(_, rest)| rest).trim_end();
        let names: Vec<String> = ir.arguments.iter().map(|a| a.name.clone().unwrap_or_default()).collect();
        let calls: Vec<&str> = planned.targets.iter().map(|&t| plan.functions[t].name.as_str()).collect();
        let body = match rule {
            Combine::Sum | Combine::Product => {
                let sign = if rule == Combine::Sum { " + " } else { " * " };
                let all = names.join(", ");
                calls.iter().map(|c| format!("{c}({all})")).collect::<Vec<_>>().join(sign)
            }
            Combine::Chain => {
                let first = names.first().cloned().unwrap_or_default();
                let rest: String = names.iter().skip(1).map(|n| format!(", {n}")).collect();
                calls.iter().fold(first, |inner, call| format!("{call}({inner}{rest})"))
            }
        };
        self.signature_types(planned.home, header);
        let place = plan.homes[planned.home]
            .instance
            .map_or("", |i| plan.tree.nodes[plan.instances.list[i].node].path.as_str());
        format!(
            "// {place}.{slot}: {rule:?} of {}\nfn {}({parameters} {{\n    return {body};\n}}\n",
            calls.len(),
            planned.name
        )
    }

    /// The structs that a signature names.
    fn signature_types(&mut self, home: usize, header: &str) {
        let scan = crate::parse::lex::lex(header);
        let words: Vec<String> = scan.iter().map(|t| header[t.range()].to_owned()).collect();
        for word in words {
            if let Some(Origin::Interface(category)) = self.plan.homes[home].unit.origin(&word)
                && let Some(declared) = self.plan.interface_home(category)
            {
                self.want(declared, &word);
            }
        }
    }

    /// New names for what the living text of an item refers to.
    fn references(&mut self, home: usize, item: &Item, function: Option<(&Planned, &[Range<usize>])>) -> Vec<Edit> {
        let plan = self.plan;
        let unit = std::sync::Arc::clone(&plan.homes[home].unit);
        let text = &unit.file.text;
        let is_dead = |start: usize| function.is_some_and(|(_, dead)| dead.iter().any(|r| r.contains(&start)));
        let mut edits = Vec::new();
        let mut params: HashMap<usize, (&str, Range<usize>)> = HashMap::default();
        for (name, range) in param_uses(text, &unit.scan) {
            params.insert(range.start, (name, range));
        }
        for reference in &item.references {
            let token = unit.scan.tokens[reference.token];
            if is_dead(token.start as usize) {
                continue;
            }
            let name = &text[token.range()];
            if let (Some(Origin::Params) | None, Some((param, range))) = (unit.origin(name), params.get(&(token.start as usize))) {
                if let Some(edit) = self.param(home, param, range.clone()) {
                    edits.push(edit);
                }
                continue;
            }
            if let Some(new) = self.target(home, name, function.map(|(p, _)| p))
                && new != name
            {
                edits.push((token.range(), new));
            }
        }
        edits
    }

    fn param(&mut self, home: usize, param: &str, range: Range<usize>) -> Option<Edit> {
        let unit = &self.plan.homes[home].unit;
        if unit.needs.uniforms.contains_key(param) {
            let (block, member) = self.params.get(&(home, param.to_owned()))?;
            let group = GROUPS[self.plan.blocks[*block].group as usize];
            return Some((range, format!("{group}_params.{member}")));
        }
        let home = self.plan.shared_home(home);
        let name = constant_name(param);
        self.want(home, &name);
        Some((range, self.plan.names.get(&(home, name))?.clone()))
    }

    /// Emitted name of what a word stands for; `None` for words of the language.
    fn target(&mut self, home: usize, name: &str, caller: Option<&Planned>) -> Option<String> {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        if let Some(handle) = unit.functions.get(name) {
            return Some(plan.functions[*caller?.calls.get(handle)?].name.clone());
        }
        let (declared, is_item) = match unit.origin(name)? {
            Origin::Own => {
                let kind = unit.scan.item(name)?.kind;
                let own = matches!(kind, ItemKind::Variable | ItemKind::Override);
                (if own { home } else { plan.shared_home(home) }, true)
            }
            Origin::Interface(category) => (plan.interface_home(category)?, true),
            Origin::Instances => (if name == "Instance" { plan.shared_home(home) } else { home }, true),
            Origin::Slot { .. } | Origin::Offered { .. } | Origin::Params | Origin::Param(_) => (home, false),
        };
        if is_item {
            self.want(declared, name);
        }
        plan.names.get(&(declared, name.to_owned())).cloned()
    }
}

/// The text of a range with the edits made. Edits inside a removed stretch go with it.
fn apply(text: &str, range: Range<usize>, mut edits: Vec<Edit>) -> String {
    edits.sort_by_key(|(a, _)| (a.start, std::cmp::Reverse(a.end)));
    let mut out = String::with_capacity(range.len());
    let mut at = range.start;
    for (span, new) in edits {
        if span.start < at || span.end > range.end {
            // An edit that begins in a removed stretch may still reach beyond it.
            at = at.max(span.end.min(range.end).max(at));
            continue;
        }
        out.push_str(&text[at..span.start]);
        out.push_str(&new);
        at = span.end;
    }
    out.push_str(&text[at..range.end]);
    out
}
