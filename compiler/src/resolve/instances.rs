//! Which places of a tree are one and the same instance.

use rustc_hash::FxHashMap as HashMap;

use super::Tree;
use crate::catalog::Catalog;
use crate::manifest::{Resource, ResourceKind};

/// A module instance: one or several equal places of the tree.
#[derive(Clone, Debug)]
pub struct Instance {
    /// Unique name, an identifier.
    pub name: String,
    /// The first place.
    pub node: usize,
    /// All places.
    pub nodes: Vec<usize>,
    /// Instance that owns the slot of the first place.
    pub parent: Option<usize>,
}

/// Instances of a tree.
#[derive(Clone, Debug)]
pub struct Instances {
    /// In the order of their first places.
    pub list: Vec<Instance>,
    /// Instance of each tree node.
    pub of_node: Vec<usize>,
}

impl Instances {
    /// Equal subtrees are one instance, unless a label tells them apart, files do, a texture of their own does (a scene names
    /// textures by place), they are offered functions by different owners, or they hold the shadow maps of different
    /// kinds of lights, which are numbered by light.
    pub fn find(catalog: &Catalog, tree: &Tree) -> Self {
        let structure = structures(tree);
        let offered = offered_subtrees(catalog, tree);
        let mapped = mapped_subtrees(tree);
        let mut list: Vec<Instance> = Vec::new();
        let mut of_node: Vec<usize> = Vec::with_capacity(tree.nodes.len());
        let mut known: HashMap<(usize, Option<usize>, Option<usize>), usize> = HashMap::default();
        for (index, node) in tree.nodes.iter().enumerate() {
            let parent = node.parent.map(|p| of_node[p]);
            // Below a shared parent everything is shared with it.
            let own_texture = node
                .module
                .manifest
                .resources
                .values()
                .any(|r| matches!(r.kind, ResourceKind::Texture { .. }));
            let shared_with_parent = node.parent.filter(|&p| list[of_node[p]].node != p);
            let twin = shared_with_parent.map(|p| twin_below(tree, p, index, list[of_node[p]].node));
            let instance = match twin {
                Some(Some(first)) => of_node[first],
                _ => {
                    let key = (
                        structure[index],
                        parent.filter(|_| offered[index] || mapped[index]),
                        own_texture.then_some(index),
                    );
                    *known.entry(key).or_insert_with(|| {
                        list.push(Instance {
                            name: String::new(),
                            node: index,
                            nodes: Vec::new(),
                            parent,
                        });
                        list.len() - 1
                    })
                }
            };
            list[instance].nodes.push(index);
            of_node.push(instance);
        }
        name(tree, &mut list);
        Self { list, of_node }
    }
}

/// The node below `first` that stands where `node` stands below `parent`.
fn twin_below(tree: &Tree, parent: usize, node: usize, first: usize) -> Option<usize> {
    // Equal subtrees have one module, and so the same slots.
    tree.nodes[parent].fills.iter().enumerate().find_map(|(slot, nodes)| {
        let position = nodes.iter().position(|&n| n == node)?;
        tree.nodes[first].fills.get(slot)?.get(position).copied()
    })
}

/// A number for each node that is equal for equal subtrees.
fn structures(tree: &Tree) -> Vec<usize> {
    let mut numbers = vec![0; tree.nodes.len()];
    let mut known = HashMap::default();
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        // Of one module the slots are the same, in one order.
        let slots = node.fills.iter().map(|nodes| nodes.iter().map(|&child| numbers[child]).collect());
        let slots: Vec<Vec<usize>> = slots.collect();
        let next = known.len();
        let files: Vec<_> = node.files.iter().collect();
        let key = (&node.module.category, &node.module.name, &node.label, &node.variant, files, slots);
        numbers[index] = *known.entry(key).or_insert(next);
    }
    numbers
}

/// Whether a module of the subtree calls functions of the subtree's owner.
fn offered_subtrees(catalog: &Catalog, tree: &Tree) -> Vec<bool> {
    let mut offered = vec![false; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        offered[index] = catalog
            .category(&node.module.category)
            .is_some_and(|c| !c.manifest.offers.is_empty());
    }
    offered
}

/// Whether a subtree holds maps of the views of an owner above it: those of a module with instances are its own.
fn mapped_subtrees(tree: &Tree) -> Vec<bool> {
    let is_map = |r: &Resource| matches!(r.kind, ResourceKind::Depth { .. } | ResourceKind::Views { .. });
    let mut mapped = vec![false; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        mapped[index] |= node.module.manifest.resources.values().any(is_map);
        if let Some(parent) = node.parent.filter(|_| mapped[index]) {
            mapped[parent] |= tree.nodes[parent].module.manifest.instances.is_empty();
        }
    }
    mapped
}

fn name(tree: &Tree, list: &mut [Instance]) {
    let mut used: HashMap<String, usize> = HashMap::default();
    for instance in list.iter_mut() {
        let node = &tree.nodes[instance.node];
        let module = identifier(&node.module.name);
        let base = node
            .label
            .as_ref()
            .map_or_else(|| module.clone(), |label| format!("{module}_{label}"));
        let mut name = base.clone();
        loop {
            let count = used.entry(name.clone()).or_insert(0);
            *count += 1;
            if *count == 1 {
                break;
            }
            // Letters, because naga's writers rename what ends in a digit.
            let suffix = letters(*count - 1);
            name = format!("{base}_{suffix}");
        }
        instance.name = name;
    }
}

/// A module's name as an identifier.
fn identifier(name: &str) -> String {
    let mut text: String = name
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    if text.starts_with(|c: char| c.is_ascii_digit()) || text.is_empty() {
        text.insert(0, 'm');
    }
    text
}

/// 1 is b, 2 is c, ..., 25 is z, 26 is ba.
fn letters(mut number: usize) -> String {
    let mut text = String::new();
    loop {
        text.insert(0, char::from(b'a' + (number % 26) as u8));
        number /= 26;
        if number == 0 {
            return text;
        }
    }
}
