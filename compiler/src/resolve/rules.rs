//! `requires` and `excludes`.

use std::collections::HashMap;
use std::sync::Arc;

use super::{Tree, TreeNode};
use crate::catalog::Module;
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::manifest::{Among, Rule};

/// Checks every rule of every module in the tree.
pub fn check(tree: &Tree) -> Result<(), Report> {
    for (index, node) in tree.nodes.iter().enumerate() {
        for rule in &node.module.manifest.rules {
            check_rule(tree, index, node, rule)?;
        }
    }
    labels(tree)
}

/// One label names one subtree of a module: else nobody could say which of them is meant.
fn labels(tree: &Tree) -> Result<(), Report> {
    let mut known: HashMap<(&str, &str, &str), usize> = HashMap::new();
    for (index, node) in tree.nodes.iter().enumerate() {
        let Some(label) = &node.label else { continue };
        let first = *known.entry((&node.module.category, &node.module.name, label)).or_insert(index);
        if !equal(tree, first, index) {
            let (place, other) = (tree.place(index), tree.place(first));
            return Err(Diagnostic::new(
                codes::BAD_LABEL,
                format!("the label `{label}` stands at two different subtrees of `{}`", node.module.name),
            )
            .at(&place.file, place.keys(&["label"]).span(), "the second one")
            .at(&other.file, other.keys(&["label"]).span(), "the first one")
            .note("a label names one subtree, wherever it stands: choose another one here")
            .into());
        }
    }
    Ok(())
}

fn equal(tree: &Tree, a: usize, b: usize) -> bool {
    let (x, y) = (&tree.nodes[a], &tree.nodes[b]);
    let (p, q) = (&x.fills, &y.fills);
    a == b
        || Arc::ptr_eq(&x.module, &y.module)
            && x.label == y.label
            && x.variant == y.variant
            && x.files == y.files
            && p.iter().map(Vec::len).eq(q.iter().map(Vec::len))
            && p.iter().flatten().zip(q.iter().flatten()).all(|(&c, &d)| equal(tree, c, d))
}

fn check_rule(tree: &Tree, index: usize, node: &TreeNode, rule: &Rule) -> Result<(), Report> {
    let (tag, among, because, wanted) = match rule {
        Rule::Requires { tag, among, because } => (tag, *among, because, true),
        Rule::Excludes { tag, among, because } => (tag, *among, because, false),
    };
    let found = tree.nodes.iter().enumerate().find(|&(other, candidate)| {
        let there = match among {
            Among::Parent => node.parent == Some(other),
            Among::Children => other != index && is_below(tree, other, index),
            Among::Tree => other != index,
        };
        there && has_tag(&candidate.module, tag)
    });
    let name = &node.module.name;
    let among_words = match among {
        Among::Parent => "the module whose slot it fills",
        Among::Children => "the modules in its slots",
        Among::Tree => "the tree",
    };
    // A subtree that stands alone has no parent to judge by.
    if wanted && among == Among::Parent && node.parent.is_none_or(|p| tree.nodes[p].module.category.is_empty()) {
        return Ok(());
    }
    let broken = |message: String| {
        let place = tree.place(index);
        Diagnostic::new(codes::RULE_BROKEN, message).at(&place.file, place.span(), format!("`{name}` stands here"))
    };
    match (wanted, found) {
        (true, None) => Err(broken(format!("`{name}` requires `{tag}` in {among_words}: {because}")).into()),
        (false, Some((other, candidate))) => {
            let there = tree.place(other);
            let text = format!("`{}` stands here", candidate.module.name);
            Err(broken(format!("`{name}` excludes `{tag}` in {among_words}: {because}"))
                .at(&there.file, there.span(), text)
                .into())
        }
        _ => Ok(()),
    }
}

fn is_below(tree: &Tree, mut node: usize, ancestor: usize) -> bool {
    while let Some(parent) = tree.nodes[node].parent {
        if parent == ancestor {
            return true;
        }
        node = parent;
    }
    false
}

/// Whether rules mean a module by this word.
pub fn has_tag(module: &Module, tag: &str) -> bool {
    module.name == tag
        || module.category == tag
        || module.manifest.properties.iter().any(|p| p == tag)
        || module.manifest.instances.values().any(|f| f.role.as_deref() == Some(tag))
}
