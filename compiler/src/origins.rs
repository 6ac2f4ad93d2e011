//! Where each line of the source form comes from.

use std::sync::Arc;

use rustc_hash::FxHashMap as HashMap;

use crate::link::Section;
use crate::manifest::{Locator, Step};
use crate::plan::Plan;

/// Where a line of the source form comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineOrigin {
    /// What it is a line of.
    pub item: Arc<ItemOrigin>,
    /// Line of [`ItemOrigin::file`], from 1; 0 where the linker has written it.
    pub line: usize,
}

/// Where an item of the source form comes from: a function, struct, constant, variable, or a member of a block of parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ItemOrigin {
    /// By which [`crate::Program::why`] knows it.
    pub name: String,
    /// Module; the category for an interface's own.
    pub module: String,
    /// Slot paths where the module stands: `main.brdf.ndf`. None for an interface's own.
    pub places: Vec<String>,
    /// The author's file: WGSL, or of a parameter the manifest.
    pub file: String,
}

/// One for each line of the text; `None` for lines between items.
pub fn origins(plan: &Plan, text: &str, sections: &[Section]) -> Vec<Option<LineOrigin>> {
    let mut starts = HashMap::default();
    let mut lines = Vec::new();
    let mut items: Vec<Option<Arc<ItemOrigin>>> = vec![None; sections.len()];
    let (mut start, mut at) = (0, 0);
    for line in text.split_inclusive('\n') {
        let byte = start + (line.len() - line.trim_start().len());
        let is_blank = line.trim_start().is_empty();
        start += line.len();
        while sections.get(at).is_some_and(|section| section.text.end <= byte) {
            at += 1;
        }
        let section = sections.get(at).filter(|section| section.text.contains(&byte) && !is_blank);
        lines.push(section.map(|section| {
            let item = items[at].get_or_insert_with(|| Arc::new(item(plan, section)));
            LineOrigin {
                item: Arc::clone(item),
                line: line_of(plan, section, byte, &mut starts),
            }
        }));
    }
    lines
}

fn item(plan: &Plan, section: &Section) -> ItemOrigin {
    let home = &plan.homes[section.home];
    let Some(instance) = home.instance.map(|instance| &plan.instances.list[instance]) else {
        return ItemOrigin {
            name: section.name.clone(),
            module: home.unit.interface.clone().unwrap_or_default(),
            places: Vec::new(),
            file: home.unit.file.name.clone(),
        };
    };
    let module = &plan.tree.nodes[instance.node].module;
    let author = section.stretches.first().map(|first| home.unit.file.line_of(first.from.start, 0).0);
    ItemOrigin {
        name: match &section.param {
            Some(param) => format!("{}.{param}", instance.name),
            None => section.name.clone(),
        },
        module: module.name.clone(),
        places: instance.nodes.iter().map(|&node| plan.tree.path(node)).collect(),
        file: match &section.param {
            Some(_) => module.source.name.clone(),
            None => author.unwrap_or(&home.unit.file.name).to_owned(),
        },
    }
}

/// Line of the author's file for a byte of the source form.
fn line_of(plan: &Plan, section: &Section, byte: usize, starts: &mut HashMap<usize, Vec<usize>>) -> usize {
    let home = &plan.homes[section.home];
    if let (Some(param), Some(instance)) = (&section.param, home.instance) {
        let source = &plan.tree.nodes[plan.instances.list[instance].node].module.source;
        let declared = Locator::new(&source.text).find_key(&[Step::Key("params"), Step::Key(param)]);
        return declared.map_or(0, |span| source.position(span.start).line);
    }
    let index = section.stretches.partition_point(|stretch| stretch.at <= byte);
    // Before the first: the comment that the linker writes above a function.
    let Some(stretch) = section.stretches.get(index.saturating_sub(1)) else {
        return 0;
    };
    let into = byte.saturating_sub(stretch.at).min(stretch.from.len());
    let from = stretch.from.start + into;
    let starts = starts.entry(section.home).or_insert_with(|| {
        let newlines = home.unit.file.text.match_indices('\n').map(|(at, _)| at + 1);
        std::iter::once(0).chain(newlines).collect()
    });
    let line = starts.partition_point(|&start| start <= from);
    home.unit.file.line_of(from, line).1
}
