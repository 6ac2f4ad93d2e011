//! A compute program that evaluates one interface function over a table.

use std::sync::Arc;

use indexmap::IndexMap;

use crate::canonical::empty_manifest;
use crate::catalog::{Catalog, Module, Variants};
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::manifest::{Arity, Filling, ModuleManifest, Node, Resource, ResourceKind, Slot};
use crate::parse::lex::Kind;
use crate::parse::scan::{Field, Item, ItemKind, Scan};
use crate::plan::Roots;
use crate::program::{Program, Recipe};
use crate::resolve::{Instances, Place, resolve_root};

/// Name of the module that is made for a probe, and of its entry point.
const PROBE: &str = "probe";

impl Catalog {
    /// Makes a compute program that calls one interface function of a recipe's root over a table: entry point `probe`,
    /// workgroup size 64, group 3, `probe_input: array<ProbeInput>` (one member for each argument, named as in the
    /// interface; the function's name behind it where there are none) and `probe_output: array<ProbeOutput>` with the
    /// member `value`. Both are host resources of those names. Rows beyond the output's length are left alone.
    ///
    /// # Errors
    /// As for [`Catalog::compile`]; the root's interface has no such function, or one with arguments that no buffer holds.
    pub fn compile_probe(&self, recipe: &Recipe, function: &str) -> Result<Program, Report> {
        let place = Place::new(&recipe.source);
        let root = self.module_at(&recipe.root.module, None, || place.clone())?;
        let interface = self.interface(&root.category)?;
        let offers = &interface.category.manifest.offers;
        let functions: Vec<&Item> = interface
            .scan
            .items
            .iter()
            .filter(|i| i.kind == ItemKind::Function && !offers.contains(&i.name))
            .collect();
        let Some(item) = functions.iter().find(|i| i.name == function) else {
            let known: Vec<&str> = functions.iter().map(|i| i.name.as_str()).collect();
            return Err(
                Diagnostic::new(codes::UNKNOWN_PROBE, format!("`{}` has no function `{function}`", root.category))
                    .at(&recipe.source, place.name_span(), format!("a module of `{}`", root.category))
                    .suggest(function, "functions", known)
                    .into(),
            );
        };
        let pointer = |field: &&Field| interface.file.text[interface.scan.bytes(&field.ty)].starts_with("ptr");
        if let Some(field) = item.fields.iter().find(pointer) {
            let message = format!("`{function}` of `{}` cannot be probed", root.category);
            return Err(Diagnostic::new(codes::UNKNOWN_PROBE, message)
                .at(&recipe.source, place.name_span(), format!("a module of `{}`", root.category))
                .note(format!("`{}` is a pointer, and a table of inputs holds values", field.name))
                .into());
        }
        let text = probe_text(&interface.file.text, &interface.scan, item);
        let source = SourceFile::new("probe", "");
        let manifest = probe_manifest(&root.category);
        let mut module = Module {
            name: PROBE.to_owned(),
            category: String::new(),
            manifest,
            source,
            data: IndexMap::new(),
            variants: Variants::default(),
        };
        module.variants = self
            .parse_module(&module, SourceFile::new("probe.wgsl", text), &IndexMap::new())?
            .into();
        let module = Arc::new(module);
        let mut node = Node::new(PROBE);
        node.fill.insert("subject".to_owned(), Filling::One(recipe.root.clone()));
        let tree = resolve_root(self, module, &node, place)?;
        let instances = Instances::find(self, &tree);
        self.finish(self.plan_tree(tree, instances, &Roots::Main, PROBE)?)
    }
}

fn probe_manifest(interface: &str) -> ModuleManifest {
    let slot = Slot {
        interface: interface.to_owned(),
        arity: Arity::Single,
        default: None,
        prefix: String::new(),
        doc: String::new(),
        represents: IndexMap::new(),
    };
    let host = |name: &str| Resource {
        kind: ResourceKind::Host(name.to_owned()),
        group: Some(3),
        doc: String::new(),
    };
    ModuleManifest {
        summary: "Evaluates a function over a table".to_owned(),
        slots: IndexMap::from([("subject".to_owned(), slot)]),
        resources: IndexMap::from(["probe_input", "probe_output"].map(|n| (n.to_owned(), host(n)))),
        ..empty_manifest()
    }
}

/// The probe's WGSL for a function of an interface's text.
fn probe_text(text: &str, scan: &Scan, item: &Item) -> String {
    let mut members = String::new();
    let mut arguments = Vec::new();
    for field in &item.fields {
        let ty = &text[scan.bytes(&field.ty)];
        // Buffers hold no booleans.
        if ty == "bool" {
            members.push_str(&format!("    {}: u32,\n", field.name));
            arguments.push(format!("probe_input[row].{} != 0u", field.name));
        } else {
            members.push_str(&format!("    {}: {ty},\n", field.name));
            arguments.push(format!("probe_input[row].{}", field.name));
        }
    }
    if members.is_empty() {
        // WGSL has no empty structs.
        members.push_str("    nothing: u32,\n");
    }
    let skipped = item
        .result
        .clone()
        .find(|&at| scan.tokens[at].kind == Kind::Word)
        .unwrap_or(item.result.start);
    let result = text[scan.bytes(&(skipped..item.result.end))].to_owned();
    let (result, value) = if result == "bool" {
        ("u32".to_owned(), format!("u32({}(", item.name))
    } else {
        (result, format!("({}(", item.name))
    };
    format!(
        "struct ProbeInput {{\n{members}}}\nstruct ProbeOutput {{\n    value: {result},\n}}\n\
         var<storage, read> probe_input: array<ProbeInput>;\nvar<storage, read_write> probe_output: array<ProbeOutput>;\n\n\
         @compute @workgroup_size(64)\nfn probe(@builtin(global_invocation_id) id: vec3u) {{\n    let row = id.x;\n    \
         if row < arrayLength(&probe_output) {{\n        probe_output[row].value = {value}{}));\n    }}\n}}\n",
        arguments.join(", ")
    )
}
