//! `diff`: what changes from one recipe's shader to another's, and which choice did it.

use std::collections::{BTreeMap, BTreeSet};

use clap::Args;
use serde::Serialize;
use shadewright::compiler::Program;
use shadewright::compiler::reflect::{Binding, BindingType, Layout, ParamPlace};

use super::failure::Failure;
use super::output::{say, say_json};
use super::text::{columns, value};
use super::tree::Tree;
use super::{Context, Format, input};

/// Options of `diff`.
#[derive(Args)]
pub struct Options {
    /// File, inline RON tree, module name, or - for standard input
    a: String,
    /// What to compare it with
    b: String,
    /// Which pass of both: the roots' own, or INSTANCE.PASS for one that a module of the trees declares
    #[arg(long, default_value = "main")]
    pass: String,
}

/// A difference between the trees.
#[derive(Debug, PartialEq, Serialize)]
struct Choice {
    /// Slot path.
    path: String,
    /// What stands there in A; `None` where nothing does.
    a: Option<String>,
    /// What stands there in B.
    b: Option<String>,
    /// Slot path of the topmost node that this can change.
    #[serde(skip)]
    scope: String,
}

/// Something that only one of the shaders has.
#[derive(Debug, PartialEq, Serialize)]
struct Item {
    name: String,
    /// Slot path of the choice that did it; `None` where it follows from several.
    because: Option<String>,
}

/// What one kind of thing lost and gained.
#[derive(Debug, Serialize)]
struct Change {
    removed: Vec<Item>,
    added: Vec<Item>,
}

#[derive(Debug, Serialize)]
struct Difference {
    /// The shaders mean the same.
    equal: bool,
    hash_a: String,
    hash_b: String,
    choices: Vec<Choice>,
    functions: Change,
    bindings: Change,
    params: Change,
    structs: Change,
}

/// # Errors
/// One of the recipes is wrong.
pub fn run(context: &Context, options: &Options) -> Result<(), Failure> {
    if options.a == "-" && options.b == "-" {
        return Err(Failure::Usage("only one recipe can come from standard input".to_owned()));
    }
    let (a, b) = (
        Side::of(context, &options.a, &options.pass)?,
        Side::of(context, &options.b, &options.pass)?,
    );
    let choices = choices(&a.tree, &b.tree);
    let change = |names: fn(&Program) -> BTreeMap<String, String>| change(&a, &b, names, &choices);
    let difference = Difference {
        equal: a.program.hash() == b.program.hash(),
        hash_a: a.program.reflection().hash.clone(),
        hash_b: b.program.reflection().hash.clone(),
        functions: change(functions),
        bindings: change(bindings),
        params: change(params),
        structs: change(structs),
        choices,
    };
    match context.format {
        Format::Json => say_json(&difference),
        Format::Text => say(&describe(&difference)),
    }
}

struct Side {
    program: Program,
    tree: Tree,
}

impl Side {
    fn of(context: &Context, typed: &str, pass: &str) -> Result<Self, Failure> {
        let recipe = input::recipe(typed)?;
        Ok(Self {
            program: context.catalog.compile(&recipe, pass)?,
            tree: Tree::of(&context.catalog, &recipe.root)?,
        })
    }

    /// The choice to which something of this shader is owed: the deepest one above the function that needs it,
    /// or else above the nearest of its callers. All is owed to an only choice.
    fn because(&self, name: &str, choices: &[Choice]) -> Option<String> {
        if let [only] = choices {
            return Some(only.path.clone());
        }
        let reasons = self.program.why(name);
        let reflection = self.program.reflection();
        let places_of = |function: &String| -> Vec<&String> {
            let origin = reflection.functions.iter().find(|origin| origin.name == *function);
            let instance = origin.and_then(|origin| origin.instance.as_ref());
            let instance = reflection.instances.iter().find(|known| Some(&known.name) == instance);
            instance.map(|instance| instance.paths.iter().collect()).unwrap_or_default()
        };
        let callers = reasons.iter().flat_map(|reason| reason.path.iter().rev());
        let of_callers = callers.flat_map(places_of).find_map(|place| above(place, choices));
        of_callers.or_else(|| {
            // A struct that only a binding's type names.
            let binding = reflection
                .bindings
                .iter()
                .find(|binding| binding.name != name && layout_of(binding).is_some_and(|l| names(l, name)));
            binding.and_then(|binding| self.because(&binding.name, choices))
        })
    }
}

/// Layout of a buffer's contents.
fn layout_of(binding: &Binding) -> Option<&Layout> {
    match &binding.ty {
        BindingType::Uniform { layout } | BindingType::Storage { layout, .. } => Some(layout),
        _ => None,
    }
}

/// Whether a type is, or holds, the struct of this name.
fn names(layout: &Layout, name: &str) -> bool {
    let members = layout.members.iter().map(|member| &member.layout);
    layout.ty == name || members.chain(layout.element.as_deref()).any(|inner| names(inner, name))
}

fn above(place: &str, choices: &[Choice]) -> Option<String> {
    let above = choices.iter().filter(|choice| {
        let rest = place.strip_prefix(choice.scope.as_str());
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    });
    above.max_by_key(|choice| choice.scope.len()).map(|choice| choice.path.clone())
}

/// Where the trees differ. Below a place where another module stands, everything differs: that isn't said again.
fn choices(a: &Tree, b: &Tree) -> Vec<Choice> {
    let whole = |tree: &Tree| format!("{}/{}", tree.category, tree.module);
    if whole(a) != whole(b) {
        return vec![Choice {
            path: a.path.clone(),
            a: Some(whole(a)),
            b: Some(whole(b)),
            scope: a.path.clone(),
        }];
    }
    let mut found = Vec::new();
    let frozen = |tree: &Tree, name: &String| tree.freeze.get(name).map(value);
    let names: BTreeSet<&String> = a.freeze.keys().chain(b.freeze.keys()).collect();
    for name in names {
        let (in_a, in_b) = (frozen(a, name), frozen(b, name));
        if in_a != in_b {
            found.push(Choice {
                path: format!("{}.{name}", a.path),
                a: in_a,
                b: in_b,
                scope: a.path.clone(),
            });
        }
    }
    for (in_a, in_b) in a.slots.iter().zip(&b.slots) {
        for index in 0..in_a.filled.len().max(in_b.filled.len()) {
            match (in_a.filled.get(index), in_b.filled.get(index)) {
                (Some(one), Some(other)) => found.extend(choices(one, other)),
                (one, other) => {
                    let path = one.or(other).map(|tree| tree.path.clone()).unwrap_or_default();
                    found.push(Choice {
                        scope: path.clone(),
                        path,
                        a: one.map(whole),
                        b: other.map(whole),
                    });
                }
            }
        }
    }
    found
}

/// Things by the name to compare, with the emitted name to ask `why` for.
fn functions(program: &Program) -> BTreeMap<String, String> {
    let functions = program.reflection().functions.iter();
    functions.map(|function| (function.name.clone(), function.name.clone())).collect()
}

fn bindings(program: &Program) -> BTreeMap<String, String> {
    let bindings = program.reflection().bindings.iter();
    bindings.map(|binding| (binding.name.clone(), binding.name.clone())).collect()
}

fn params(program: &Program) -> BTreeMap<String, String> {
    let params = program.reflection().params.iter();
    params
        .map(|param| {
            let emitted = match &param.place {
                ParamPlace::Uniform { member, .. } => member,
                ParamPlace::Override { name } => name,
                ParamPlace::Constant { .. } => &param.name,
            };
            (format!("{}.{}", param.instance, param.name), emitted.clone())
        })
        .collect()
}

fn structs(program: &Program) -> BTreeMap<String, String> {
    let types = program.validated().module().types.iter();
    types
        .filter(|(_, ty)| matches!(ty.inner, shadewright::compiler::naga::TypeInner::Struct { .. }))
        .filter_map(|(_, ty)| ty.name.clone())
        .map(|name| (name.clone(), name))
        .collect()
}

fn change(a: &Side, b: &Side, names: fn(&Program) -> BTreeMap<String, String>, choices: &[Choice]) -> Change {
    let (in_a, in_b) = (names(&a.program), names(&b.program));
    let only = |side: &Side, mine: &BTreeMap<String, String>, others: &BTreeMap<String, String>| -> Vec<Item> {
        let only = mine.iter().filter(|(name, _)| !others.contains_key(*name));
        only.map(|(name, emitted)| Item {
            name: name.clone(),
            because: side.because(emitted, choices),
        })
        .collect()
    };
    Change {
        removed: only(a, &in_a, &in_b),
        added: only(b, &in_b, &in_a),
    }
}

fn describe(difference: &Difference) -> String {
    let mut text = match difference.equal {
        true => format!("the shaders mean the same: {}\n", difference.hash_a),
        false => format!("the shaders differ: {} and {}\n", difference.hash_a, difference.hash_b),
    };
    let or_nothing = |what: &Option<String>| what.clone().unwrap_or_else(|| "nothing".to_owned());
    for choice in &difference.choices {
        text.push_str(&format!(
            "{}: {} -> {}\n",
            choice.path,
            or_nothing(&choice.a),
            or_nothing(&choice.b)
        ));
    }
    let kinds = [
        ("functions", &difference.functions),
        ("bindings", &difference.bindings),
        ("parameters", &difference.params),
        ("structs", &difference.structs),
    ];
    for (kind, change) in kinds {
        let lines: Vec<Vec<String>> = change
            .removed
            .iter()
            .map(|item| ("-", item))
            .chain(change.added.iter().map(|item| ("+", item)))
            .map(|(sign, item)| {
                let because = item.because.as_ref().map(|path| format!("because of {path}"));
                vec![format!("{sign} {}", item.name), because.unwrap_or_default()]
            })
            .collect();
        if !lines.is_empty() {
            text.push_str(&format!("{kind}\n{}", columns(&lines, "  ")));
        }
    }
    text
}
