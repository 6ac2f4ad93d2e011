//! What is true in a slot: the module that an experiment of the library holds the others against.

use std::sync::Arc;

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Filling, Node, ParamMode};
use shadewright_compiler::{Catalog, Module, Report};
use shadewright_report::Experiment;
use shadewright_report::experiment::TruthSource;

use super::Stored;

/// A module that is called true.
#[derive(Clone, Debug)]
pub struct Truth {
    /// The module.
    pub module: Arc<Module>,
    /// By which experiment.
    pub experiment: String,
}

/// What a library's experiments call true.
///
/// An experiment says it in two ways. Its truth is the closed form of a module, then that is true for the modules that are compared. Or it is a recipe:
/// then, where recipe and alternative have different modules in one place, the recipe's is true there.
#[derive(Clone, Debug, Default)]
pub struct Truths {
    /// By category and name of the module that approximates; the first experiment counts.
    of: IndexMap<(String, String), Truth>,
    /// By category, what integrates by brute force: true for modules of which no experiment speaks, too.
    brute: IndexMap<String, Vec<Truth>>,
    /// What the stored report says.
    pub stored: Stored,
}

impl Truths {
    /// Reads the library's experiments.
    ///
    /// # Errors
    /// One of them is wrong.
    pub fn load(catalog: &Catalog) -> Result<Self, Report> {
        let experiments = shadewright_report::experiments(catalog.library().as_ref(), catalog)?;
        Ok(Self::of_experiments(catalog, &experiments))
    }

    /// Of these experiments.
    pub fn of_experiments(catalog: &Catalog, experiments: &[Experiment]) -> Self {
        let mut truths = Self {
            stored: Stored::read(),
            ..Self::default()
        };
        for experiment in experiments {
            for alternative in &experiment.alternatives {
                let root = &alternative.root;
                let stored = truths.stored.row(&experiment.name, &alternative.label);
                truths.stored.add(root, &experiment.name, stored);
                match &experiment.declared.truth {
                    TruthSource::Closed(folder) => {
                        // A category's folder is no module: that truth cannot be drawn.
                        let module = catalog.module(folder).ok().filter(|_| folder.contains('/'));
                        if let Some(module) = module {
                            truths.add(root, module, &experiment.name);
                        }
                    }
                    TruthSource::Reference(node) | TruthSource::Sampled(node) => {
                        let mut pairs = Vec::new();
                        pair(catalog, &experiment.category, node, &alternative.recipe.root, &mut pairs);
                        for (other, module) in pairs {
                            truths.stored.add(&other, &experiment.name, stored);
                            truths.add(&other, &module, &experiment.name);
                            truths.add_brute(&other, &module, &experiment.name);
                        }
                    }
                    TruthSource::Own | TruthSource::Itself => {}
                }
            }
        }
        truths
    }

    fn add(&mut self, other: &Module, module: &Arc<Module>, experiment: &str) {
        // What has instances is in the scene, and no approximation of something else that could be there.
        if other.category != module.category || other.name == module.name || !other.manifest.instances.is_empty() {
            return;
        }
        let key = (other.category.clone(), other.name.clone());
        self.of.entry(key).or_insert_with(|| Truth {
            module: Arc::clone(module),
            experiment: experiment.to_owned(),
        });
    }

    fn add_brute(&mut self, other: &Module, module: &Arc<Module>, experiment: &str) {
        if other.category != module.category || !other.manifest.instances.is_empty() {
            return;
        }
        let known = self.brute.entry(module.category.clone()).or_default();
        if !known.iter().any(|truth| Arc::ptr_eq(&truth.module, module)) {
            known.push(Truth {
                module: Arc::clone(module),
                experiment: experiment.to_owned(),
            });
        }
    }

    /// What is true where this module stands, if that is another one.
    pub fn of(&self, module: &Module) -> Option<&Truth> {
        let key = (module.category.clone(), module.name.clone());
        let own = self.of.get(&key);
        // The only one of its category.
        let brute = self.brute.get(&module.category).and_then(|all| match all.as_slice() {
            [one] => Some(one),
            _ => None,
        });
        own.or_else(|| brute.filter(|_| !self.is_true(module)))
            .filter(|truth| truth.module.name != module.name)
    }

    /// Whether an experiment calls this module true.
    pub fn is_true(&self, module: &Module) -> bool {
        let brute = self.brute.get(&module.category).into_iter().flatten();
        self.of
            .values()
            .chain(brute)
            .any(|truth| truth.module.category == module.category && truth.module.name == module.name)
    }
}

/// The places where two trees have different modules of one category, as (the other's, the truth's).
fn pair(catalog: &Catalog, category: &str, truth: &Node, other: &Node, pairs: &mut Vec<(Arc<Module>, Arc<Module>)>) {
    let module = |node: &Node| {
        catalog
            .module_for(category, &node.module)
            .or_else(|_| catalog.module(&node.module))
            .ok()
    };
    let (Some(true_module), Some(other_module)) = (module(truth), module(other)) else {
        return;
    };
    if !Arc::ptr_eq(true_module, other_module) {
        // Told something of its subject, such as the index of one metal, it is true for that alone; a number of samples is the module's own affair.
        let of_one_subject = truth.freeze.keys().any(|name| {
            true_module
                .manifest
                .params
                .get(name)
                .is_none_or(|param| param.mode != ParamMode::Constant)
        });
        if !of_one_subject {
            pairs.push((Arc::clone(other_module), Arc::clone(true_module)));
        }
        return;
    }
    for (name, filling) in &truth.fill {
        let Some(slot) = true_module.manifest.slots.get(name) else {
            continue;
        };
        let Some(others) = other.fill.get(name).or(slot.default.as_ref()) else {
            continue;
        };
        for (truth, other) in nodes(filling).iter().zip(nodes(others)) {
            pair(catalog, &slot.interface, truth, other, pairs);
        }
    }
}

fn nodes(filling: &Filling) -> &[Node] {
    match filling {
        Filling::One(node) => std::slice::from_ref(node),
        Filling::Many(nodes) => nodes,
    }
}
