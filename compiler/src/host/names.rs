//! Names in Rust for names in WGSL.

use std::collections::{HashMap, HashSet};

use crate::reflect::{BindingType, Layout, Reflection, Stage};

/// Words that cannot be names, not even raw ones.
const PATHS: [&str; 4] = ["self", "Self", "super", "crate"];
/// Other words of Rust 2024.
const KEYWORDS: [&str; 48] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn", "else", "enum", "extern", "false",
    "final", "fn", "for", "gen", "if", "impl", "in", "let", "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub",
    "ref", "return", "static", "struct", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use", "virtual", "where", "while",
    "yield",
];
/// Types that the written code has or uses by these names.
const TAKEN: [&str; 32] = [
    "BindGroup0",
    "BindGroup1",
    "BindGroup2",
    "BindGroup3",
    "Clone",
    "Constants",
    "Copy",
    "Debug",
    "Default",
    "Layout",
    "Option",
    "PartialEq",
    "RenderState",
    "Some",
    "None",
    "Vec",
    "VertexInput",
    "Drop",
    "Box",
    "String",
    "Ok",
    "Err",
    "Result",
    "Send",
    "Sync",
    "Sized",
    "Into",
    "From",
    "Iterator",
    "Fn",
    "Eq",
    "Ord",
];

/// A name as Rust takes it.
pub fn rust(name: &str) -> String {
    if PATHS.contains(&name) || name == "_" {
        format!("{name}_")
    } else if KEYWORDS.contains(&name) {
        format!("r#{name}")
    } else {
        name.to_owned()
    }
}

/// The name of a pass's module: of the recipe's name, with that of the pass behind it where it is not the main one. Lower-case
/// letters, digits and underscores.
pub fn module_name(recipe: &str, pass: &str) -> String {
    let both = if pass == "main" {
        recipe.to_owned()
    } else {
        format!("{recipe}_{pass}")
    };
    let mut name: String = both
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' })
        .collect();
    if name.starts_with(|c: char| c.is_ascii_digit()) || name.trim_matches('_').is_empty() {
        name.insert_str(0, "pass_");
    }
    // What is raw could not be a file's name; an underscore does it.
    if PATHS.contains(&name.as_str()) || KEYWORDS.contains(&name.as_str()) {
        name.push('_');
    }
    name
}

/// A stage's name.
pub fn stage(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex",
        Stage::Fragment => "fragment",
        Stage::Compute => "compute",
    }
}

/// The names that a pass's module gives to structs and entry points; no two alike.
pub struct Names {
    structs: HashMap<String, String>,
    entries: HashMap<String, String>,
}

impl Names {
    /// Finds names.
    pub fn new(reflection: &Reflection) -> Self {
        let mut used: HashSet<String> = TAKEN.iter().map(|&name| name.to_owned()).collect();
        let mut structs = HashMap::new();
        for binding in &reflection.bindings {
            if let BindingType::Uniform { layout } | BindingType::Storage { layout, .. } = &binding.ty {
                name_structs(layout, &mut used, &mut structs);
            }
        }
        let mut used = HashSet::new();
        let mut entries = HashMap::new();
        for entry in &reflection.entry_points {
            entries.insert(entry.name.clone(), unique(entry.name.to_uppercase(), &mut used));
        }
        Self { structs, entries }
    }

    /// A struct's name.
    pub fn of_struct(&self, name: &str) -> String {
        self.structs.get(name).cloned().unwrap_or_else(|| rust(name))
    }

    /// Name of the constant with an entry point's name.
    pub fn entry(&self, name: &str) -> String {
        format!("ENTRY_{}", self.entries.get(name).map_or(name, String::as_str))
    }

    /// Name of the constant with the size of its workgroups.
    pub fn workgroup_size(&self, name: &str) -> String {
        format!("WORKGROUP_SIZE_{}", self.entries.get(name).map_or(name, String::as_str))
    }
}

fn name_structs(layout: &Layout, used: &mut HashSet<String>, names: &mut HashMap<String, String>) {
    if let Some(element) = &layout.element {
        name_structs(element, used, names);
    }
    if layout.members.is_empty() || names.contains_key(&layout.ty) {
        return;
    }
    names.insert(layout.ty.clone(), unique(rust(&layout.ty), used));
    for member in &layout.members {
        name_structs(&member.layout, used, names);
    }
}

/// The name, with underscores until nobody else has it.
pub fn unique(mut name: String, used: &mut HashSet<String>) -> String {
    while !used.insert(name.clone()) {
        name.push('_');
    }
    name
}
