//! Which part of the source form comes from where.

use std::ops::Range;

use rustc_hash::FxHashMap as HashMap;

use super::splice::Stretch;
use crate::parse::Unit;
use crate::plan::Plan;

/// An item of the source form, or a member of a block of parameters.
#[derive(Clone, Debug)]
pub struct Section {
    /// Bytes of the source form.
    pub text: Range<usize>,
    /// Whose it is.
    pub home: usize,
    /// Its emitted name.
    pub name: String,
    /// The parameter that it stands for.
    pub param: Option<String>,
    /// The author's text in it, in its order; none where the linker has written it.
    pub stretches: Vec<Stretch>,
}

/// What is noted while the source form is written.
#[derive(Default)]
pub struct Trace {
    /// The author's text in the items other than functions; they are written before they have their places.
    pub items: HashMap<(usize, usize), Vec<Stretch>>,
    /// The functions, from the start of their text.
    pub functions: Vec<Section>,
    /// All of it.
    pub sections: Vec<Section>,
}

impl Trace {
    /// An item of a home got its place. Items count as the writer counts them: what the linker adds comes first.
    pub fn item(&mut self, plan: &Plan, (home, index): (usize, usize), at: usize, length: usize) {
        let mut stretches = self.items.remove(&(home, index)).unwrap_or_default();
        for stretch in &mut stretches {
            stretch.at += at;
        }
        let unit: &Unit = &plan.homes[home].unit;
        let (constants, overrides) = (&unit.needs.constants, &unit.needs.overrides);
        let added = constants.len() + overrides.len() + 2;
        let name = match index.checked_sub(added) {
            Some(own) => plan
                .names
                .of_item(home, own)
                .or_else(|| Some(unit.scan.items.get(own)?.name.as_str())),
            None => plan.names.of_added(&plan.homes, home, index),
        };
        let constant = constants.get_index(index).map(|(param, _)| param);
        let param = constant.or_else(|| overrides.get_index(index.wrapping_sub(constants.len())).map(|(param, _)| param));
        self.sections.push(Section {
            text: at..at + length,
            home,
            name: name.unwrap_or_default().to_owned(),
            param: param.cloned(),
            stretches,
        });
    }

    /// A member of a block was written.
    pub fn param(&mut self, plan: &Plan, home: usize, param: &str, text: Range<usize>) {
        let instance = plan.homes[home].instance.map(|i| plan.instances.list[i].name.as_str());
        self.sections.push(Section {
            text,
            home,
            name: format!("{}.{param}", instance.unwrap_or_default()),
            param: Some(param.to_owned()),
            stretches: Vec::new(),
        });
    }

    /// The functions stand from `start` on, and the first bytes of all were taken away.
    pub fn finish(&mut self, start: usize, removed: usize) {
        let shift = |section: &mut Section, by: &dyn Fn(usize) -> usize| {
            section.text = by(section.text.start)..by(section.text.end);
            for stretch in &mut section.stretches {
                stretch.at = by(stretch.at);
            }
        };
        for section in &mut self.functions {
            shift(section, &|at| at + start);
        }
        self.sections.append(&mut self.functions);
        for section in &mut self.sections {
            shift(section, &|at| at.saturating_sub(removed));
        }
    }
}
