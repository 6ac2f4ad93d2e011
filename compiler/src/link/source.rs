//! Writing a plan as source: the authors' own text, only what is reached, with linked names and bindings.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::ops::Range;

use super::edits::dead_text;
use super::splice::{Edit, Stretch, apply};
use super::trace::{Section, Trace};
use crate::manifest::Combine;
use crate::parse::scan::{Item, ItemKind};
use crate::parse::{Meaning, Origin, Unit, joined, typed_wgsl, wgsl_type, whole_lines};
use crate::plan::{Body, GROUPS, Plan, Planned};

/// Writes the source form.
pub fn write_source(plan: &Plan) -> String {
    write(plan, None).0
}

/// Writes the source form and says where each part of it comes from, in its order.
pub fn write_traced(plan: &Plan) -> (String, Vec<Section>) {
    let (text, trace) = write(plan, Some(Trace::default()));
    (text, trace.unwrap_or_default().sections)
}

fn write(plan: &Plan, trace: Option<Trace>) -> (String, Option<Trace>) {
    let mut params: Vec<Vec<String>> = plan.homes.iter().map(|_| Vec::new()).collect();
    for block in &plan.blocks {
        let group = GROUPS[block.group as usize];
        for member in &block.members {
            let of_home = &mut params[member.home];
            of_home.resize(plan.homes[member.home].unit.needs.uniforms.len(), String::new());
            of_home[member.index as usize] = format!("{group}_params.{}", member.name);
        }
    }
    let writer = Writer {
        plan,
        items: plan
            .homes
            .iter()
            .map(|h| vec![Wanted::No; added(&h.unit) + h.unit.scan.items.len()])
            .collect(),
        queue: Vec::new(),
        params,
        edits: Vec::new(),
        dead: Vec::new(),
        stretches: Vec::new(),
        trace,
    };
    writer.write()
}

/// How many items the linker itself adds to a unit: its constants and overrides, `Instance` and `instances`.
fn added(unit: &Unit) -> usize {
    unit.needs.constants.len() + unit.needs.overrides.len() + 2
}

/// An item other than a function that some written text names.
#[derive(Clone, Debug)]
enum Wanted {
    No,
    Yes,
    Written(ItemKind, String),
}

struct Writer<'p> {
    plan: &'p Plan,
    /// By home: what the linker adds, then the text's own items.
    items: Vec<Vec<Wanted>>,
    queue: Vec<(usize, usize)>,
    /// What a uniform parameter is called, by home and index; empty where nobody reads it.
    params: Vec<Vec<String>>,
    /// Of the item that is being written.
    edits: Vec<Edit<'p>>,
    dead: Vec<Range<usize>>,
    /// The author's text in what was written last.
    stretches: Vec<Stretch>,
    /// Where all of it comes from, if somebody wants to know.
    trace: Option<Trace>,
}

impl<'p> Writer<'p> {
    fn write(mut self) -> (String, Option<Trace>) {
        let plan = self.plan;
        let mut functions = String::with_capacity(1 << 15);
        for planned in &plan.functions {
            functions.push('\n');
            let start = functions.len();
            self.stretches.clear();
            self.function(planned, &mut functions);
            if let Some(trace) = &mut self.trace {
                trace.functions.push(Section {
                    text: start..functions.len(),
                    home: planned.home,
                    name: planned.name.clone(),
                    param: None,
                    stretches: self.stretches.clone(),
                });
            }
        }
        for global in &plan.globals {
            let unit = &plan.homes[global.home].unit;
            if let Some(name) = &unit.ir.global_variables[global.handle].name {
                self.want_named(global.home, name);
            }
        }
        while let Some((home, index)) = self.queue.pop() {
            self.stretches.clear();
            if let Some((kind, text)) = self.item(home, index) {
                if let Some(trace) = &mut self.trace {
                    trace.items.insert((home, index), self.stretches.clone());
                }
                self.items[home][index] = Wanted::Written(kind, text);
            }
        }
        let mut out = self.directives();
        // Interfaces first, instances in tree order, each in the order of its text.
        for kinds in [
            &[ItemKind::Constant, ItemKind::Override][..],
            &[ItemKind::Alias, ItemKind::Struct][..],
            &[ItemKind::Variable][..],
        ] {
            let interfaces = (0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_none());
            for home in interfaces.chain((0..plan.homes.len()).filter(|&h| plan.homes[h].instance.is_some())) {
                for (index, item) in self.items[home].iter().enumerate() {
                    if let Wanted::Written(kind, text) = item
                        && kinds.contains(kind)
                    {
                        gap(&mut out, *kind);
                        if let Some(trace) = &mut self.trace {
                            trace.item(plan, (home, index), out.len(), text.len());
                        }
                        out.push_str(text);
                    }
                }
            }
            if kinds.contains(&ItemKind::Struct) {
                self.blocks(&mut out);
            }
        }
        let start = out.len();
        out.push_str(&functions);
        let blank = out.len() - out.trim_start().len();
        out.drain(..blank);
        if let Some(trace) = &mut self.trace {
            trace.finish(start, blank);
        }
        (out, self.trace)
    }

    fn want(&mut self, home: usize, index: usize) {
        if let Some(item @ Wanted::No) = self.items[home].get_mut(index) {
            *item = Wanted::Yes;
            self.queue.push((home, index));
        }
    }

    fn want_named(&mut self, home: usize, name: &str) {
        let unit = &self.plan.homes[home].unit;
        let first = added(unit);
        if let Some(index) = unit.scan.item_index(name) {
            self.want(home, first + index);
        } else if name == "instances" {
            self.want(home, first - 1);
        }
    }

    /// `enable` and `requires` of every unit that has a function here.
    fn directives(&self) -> String {
        let mut lines = BTreeSet::new();
        for planned in &self.plan.functions {
            let unit = &self.plan.homes[planned.home].unit;
            for item in unit.scan.directives() {
                let text = &unit.file.text[item.span.clone()];
                if !text.starts_with("diagnostic") {
                    lines.insert(text);
                }
            }
        }
        lines.into_iter().flat_map(|line| [line, "\n"]).collect()
    }

    fn blocks(&mut self, out: &mut String) {
        for block in &self.plan.blocks {
            let group = GROUPS[block.group as usize];
            // Infallible: writing to a string.
            let _ = writeln!(out, "\nstruct {} {{", joined(group, "Params"));
            for member in &block.members {
                let declared = self.plan.homes[member.home].unit.needs.uniforms.get(&member.param);
                let Some(param) = declared else { continue };
                let start = out.len();
                if !param.doc.is_empty() {
                    let _ = write!(out, "    /// {}", param.doc.replace('\n', " "));
                    if !param.unit.is_empty() && param.unit != "1" {
                        let _ = write!(out, " [{}]", param.unit);
                    }
                    out.push('\n');
                }
                let _ = writeln!(out, "    {}: {},", member.name, wgsl_type(param.ty));
                if let Some(trace) = &mut self.trace {
                    trace.param(self.plan, member.home, &member.param, start..out.len());
                }
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
    fn item(&mut self, home: usize, index: usize) -> Option<(ItemKind, String)> {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        let needs = &unit.needs;
        let first = added(unit);
        if let Some((_, value)) = needs.constants.get_index(index) {
            let emitted = plan.names.of_added(&plan.homes, home, index)?;
            let text = format!("const {emitted}: {} = {};\n", typed_wgsl(value), value.wgsl());
            return Some((ItemKind::Constant, text));
        }
        if let Some((_, (declared, default))) = needs.overrides.get_index(index.wrapping_sub(needs.constants.len())) {
            let emitted = plan.names.of_added(&plan.homes, home, index)?;
            let text = format!("override {emitted}: {} = {};\n", wgsl_type(declared.ty), default.wgsl());
            return Some((ItemKind::Override, text));
        }
        if index + 2 == first {
            let emitted = plan.name(home, "Instance")?;
            return Some((ItemKind::Struct, crate::parse::fields_struct(emitted, &needs.instances)));
        }
        if index + 1 == first {
            let declared = plan.shared_home(home);
            self.want(declared, added(&plan.homes[declared].unit) - 2);
            let (emitted, ty) = (plan.name(home, "instances")?, plan.name(declared, "Instance")?);
            let text = format!("{}var<storage, read> {emitted}: array<{ty}>;\n", self.binding(home, "instances")?);
            return Some((ItemKind::Variable, text));
        }
        let at = index - first;
        let item = unit.scan.items.get(at).filter(|i| i.kind != ItemKind::Function)?;
        if unit.origin(&item.name) != Some(&Origin::Own) {
            return None;
        }
        self.edits.clear();
        self.dead.clear();
        self.references(home, at, None);
        let emitted = plan.name(home, &item.name).unwrap_or(&item.name);
        self.edits.push((item.name_span.clone(), emitted.into()));
        if item.kind == ItemKind::Struct {
            self.dead_members(home, item);
        }
        if item.kind == ItemKind::Variable
            && let Some(binding) = self.binding(home, &item.name)
        {
            self.edits.push((item.span.start..item.span.start, binding.into()));
        }
        let mut text = String::new();
        apply(
            &unit.file.text,
            item.doc_start..item.span.end,
            &mut self.edits,
            &mut self.stretches,
            &mut text,
        );
        text.push('\n');
        Some((item.kind, text))
    }

    fn binding(&self, home: usize, name: &str) -> Option<String> {
        let unit = &self.plan.homes[home].unit;
        let mut globals = self.plan.globals.iter();
        let global = globals.find(|g| g.home == home && unit.ir.global_variables[g.handle].name.as_deref() == Some(name))?;
        let (group, binding) = global.binding?;
        Some(format!("@group({group}) @binding({binding}) "))
    }

    fn dead_members(&mut self, home: usize, item: &Item) {
        let unit = &self.plan.homes[home].unit;
        let declared = self.plan.structs.named(&self.plan.homes, self.plan.homes[home].first, &item.name);
        let Some(id) = declared.filter(|&id| !self.plan.structs.list[id].fixed) else {
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
            self.edits.push((whole_lines(text, &unit.scan.tokens, bytes.start..end), "".into()));
        }
    }

    fn function(&mut self, planned: &'p Planned, out: &mut String) {
        let plan = self.plan;
        let home = &plan.homes[planned.home];
        let unit = &home.unit;
        if let Body::Combined { stub, rule, slot, .. } = &planned.body {
            self.combined(planned, *stub, *rule, slot, out);
            return;
        }
        let Some(at) = unit.scan.item_index(planned.source_name(&plan.homes)) else {
            return;
        };
        let item = &unit.scan.items[at];
        self.edits.clear();
        self.dead.clear();
        dead_text(plan, planned, &mut self.dead);
        self.references(planned.home, at, Some(planned));
        self.edits.push((item.name_span.clone(), planned.name.as_str().into()));
        self.edits.extend(self.dead.drain(..).map(|range| (range, "".into())));
        // Infallible: writing to a string.
        let (file, line) = unit.file.line_of(item.span.start, item.line);
        let _ = write!(out, "// {file}:{line}");
        for (number, &node) in home.instance.iter().flat_map(|&i| &plan.instances.list[i].nodes).enumerate() {
            out.push_str(if number == 0 { " at " } else { ", " });
            plan.tree.write_path(node, out);
        }
        out.push('\n');
        for directive in unit.scan.directives() {
            // A filter of the module's file holds for the module's functions alone.
            let directive = unit.file.text[directive.span.clone()].trim_end_matches(';');
            if directive.starts_with("diagnostic") {
                let _ = writeln!(out, "@{directive}");
            }
        }
        apply(
            &unit.file.text,
            item.doc_start..item.span.end,
            &mut self.edits,
            &mut self.stretches,
            out,
        );
        out.push('\n');
    }

    fn combined(&mut self, planned: &Planned, stub: naga::Handle<naga::Function>, rule: Combine, slot: &str, out: &mut String) {
        let plan = self.plan;
        let unit = &plan.homes[planned.home].unit;
        let ir = &unit.ir.functions[stub];
        let span = unit.ir.functions.get_span(stub).to_range().unwrap_or_default();
        // The stub's text stands in the composed text; its header is the signature.
        let header = unit.composed.text.get(span).and_then(|t| t.split('{').next()).unwrap_or_default();
        let parameters = header.split_once('(').map_or("", |(_, rest)| rest).trim_end();
        let names: Vec<&str> = ir.arguments.iter().map(|a| a.name.as_deref().unwrap_or_default()).collect();
        let calls: Vec<&str> = planned.targets.iter().map(|&t| plan.functions[t].name.as_str()).collect();
        let body = match rule {
            Combine::Sum | Combine::Product => {
                let sign = if rule == Combine::Sum { " + " } else { " * " };
                let all = names.join(", ");
                calls.iter().map(|c| format!("{c}({all})")).collect::<Vec<_>>().join(sign)
            }
            Combine::Chain => {
                let first = names.first().copied().unwrap_or_default().to_owned();
                let rest: String = names.iter().skip(1).map(|n| format!(", {n}")).collect();
                calls.iter().fold(first, |inner, call| format!("{call}({inner}{rest})"))
            }
        };
        self.signature_types(planned.home, header);
        let place = plan.homes[planned.home]
            .instance
            .map_or_else(String::new, |i| plan.tree.path(plan.instances.list[i].node));
        // Infallible: writing to a string.
        let _ = write!(
            out,
            "// {place}.{slot}: {rule:?} of {}\nfn {}({parameters} {{\n    return {body};\n}}\n",
            calls.len(),
            planned.name
        );
    }

    /// The structs that a signature names.
    fn signature_types(&mut self, home: usize, header: &str) {
        for token in crate::parse::lex::lex(header) {
            let word = &header[token.range()];
            if let Some(Origin::Interface(category)) = self.plan.homes[home].unit.origin(word)
                && let Some(declared) = self.plan.interface_home(category)
            {
                self.want_named(declared, word);
            }
        }
    }

    /// New names for what the living text of an item refers to.
    fn references(&mut self, home: usize, item: usize, function: Option<&'p Planned>) {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        let text = &unit.file.text;
        for mention in &unit.mentions[item] {
            if self.dead.iter().any(|range| range.contains(&mention.range.start)) {
                continue;
            }
            let old = &text[mention.range.clone()];
            let new = self.target(home, old, &mention.meaning, function);
            if let Some(new) = new
                && new != old
            {
                self.edits.push((mention.range.clone(), new));
            }
        }
    }

    /// Emitted name of what a word stands for.
    fn target(&mut self, home: usize, name: &str, meaning: &Meaning, caller: Option<&'p Planned>) -> Option<Cow<'p, str>> {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        let emitted = match meaning {
            Meaning::Uniform(index) => {
                let member = self.params[home].get(*index).filter(|name| !name.is_empty())?;
                return Some(member.clone().into());
            }
            &Meaning::Constant(index) => {
                let home = plan.shared_home(home);
                self.want(home, index);
                plan.names.of_added(&plan.homes, home, index)
            }
            Meaning::Function(function) => Some(plan.functions[caller?.calls.get(*function)?].name.as_str()),
            &Meaning::Own { item, instanced } => {
                let home = if instanced { home } else { plan.shared_home(home) };
                self.want(home, added(unit) + item);
                plan.names.of_item(home, item)
            }
            Meaning::Interface { category, name } => {
                let home = plan.interface_home(category)?;
                self.want_named(home, name);
                plan.name(home, name)
            }
            Meaning::InstanceType => {
                let home = plan.shared_home(home);
                self.want(home, added(unit) - 2);
                plan.names.of_added(&plan.homes, home, added(unit) - 2)
            }
            Meaning::Instances => {
                self.want(home, added(unit) - 1);
                plan.names.of_added(&plan.homes, home, added(unit) - 1)
            }
            Meaning::Other => plan.name(home, name),
        };
        emitted.map(Cow::Borrowed)
    }
}

fn gap(out: &mut String, kind: ItemKind) {
    let flat = matches!(kind, ItemKind::Constant | ItemKind::Override | ItemKind::Variable | ItemKind::Alias);
    if !flat || out.ends_with("}\n") {
        out.push('\n');
    }
}
