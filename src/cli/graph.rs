//! `graph`: the tree of a recipe, as text, JSON or DOT.

use clap::Args;

use super::failure::Failure;
use super::output::{say, say_json};
use super::tree::Tree;
use super::{Context, Format, input, text};

/// Options of `graph`.
#[derive(Args)]
pub struct Options {
    /// File, inline RON tree, module name, or - for standard input
    recipe: String,
    /// Write the DOT language of Graphviz
    #[arg(long)]
    dot: bool,
}

/// # Errors
/// The recipe is wrong.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    let recipe = input::recipe(&options.recipe)?;
    super::check::links(context, &recipe)?;
    let tree = Tree::of(&context.catalog, &recipe.root)?;
    match (options.dot, context.format) {
        (true, _) => say(&dot(&tree)),
        (false, Format::Json) => say_json(&tree),
        (false, Format::Text) => {
            let mut lines = String::new();
            line(&tree, "", "", "", &mut lines);
            say(&lines)
        }
    }
}

/// One node as people read it: category and module, whether by default, label, frozen parameters.
fn describe(tree: &Tree) -> String {
    let mut line = format!("{}/{}", tree.category, tree.module);
    if let Some(label) = &tree.label {
        line.push_str(&format!(" \"{label}\""));
    }
    if !tree.freeze.is_empty() {
        let frozen: Vec<String> = tree.freeze.iter().map(|(name, v)| format!("{name} = {}", text::value(v))).collect();
        line.push_str(&format!(" {{{}}}", frozen.join(", ")));
    }
    if tree.by_default {
        line.push_str(" (default)");
    }
    line
}

fn line(tree: &Tree, slot: &str, first: &str, rest: &str, lines: &mut String) {
    lines.push_str(&format!("{first}{slot}{}\n", describe(tree)));
    let mut children: Vec<(String, Option<&Tree>)> = Vec::new();
    for slot in &tree.slots {
        match slot.filled.as_slice() {
            [] => children.push((format!("{}: ", slot.name), None)),
            [child] => children.push((format!("{}: ", slot.name), Some(child))),
            many => children.extend(
                many.iter()
                    .enumerate()
                    .map(|(i, child)| (format!("{}[{i}]: ", slot.name), Some(child))),
            ),
        }
    }
    let last = children.len().saturating_sub(1);
    for (index, (slot, child)) in children.iter().enumerate() {
        let (branch, below) = if index == last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
        match child {
            Some(child) => line(child, slot, &format!("{rest}{branch}"), &format!("{rest}{below}"), lines),
            None => lines.push_str(&format!("{rest}{branch}{slot}(empty)\n")),
        }
    }
}

/// The tree in the DOT language. Slot paths are the nodes' identifiers, so equal trees give equal text.
fn dot(tree: &Tree) -> String {
    let quote = |text: &str| format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""));
    let mut text = "digraph recipe {\n  node [shape=box, fontname=\"sans-serif\"];\n".to_owned();
    for node in tree.walk() {
        let style = if node.by_default { ", style=dashed" } else { "" };
        text.push_str(&format!("  {} [label={}{style}];\n", quote(&node.path), quote(&describe(node))));
        for slot in &node.slots {
            for child in &slot.filled {
                text.push_str(&format!(
                    "  {} -> {} [label={}];\n",
                    quote(&node.path),
                    quote(&child.path),
                    quote(&slot.name)
                ));
            }
        }
    }
    text.push_str("}\n");
    text
}
