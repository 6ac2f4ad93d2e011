//! What holds of every recipe: linking is deterministic, its two forms agree, and nothing is there that no entry point needs.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use std::collections::BTreeSet;
use std::sync::Arc;

use common::{Texts, recipes, standard};
use naga::compact::{KeepUnused, compact};
use shadewright_compiler::canonical::canonical_hash;
use shadewright_compiler::manifest::{Arity, Filling, Node};
use shadewright_compiler::reflect::{ParamPlace, ParamUse};
use shadewright_compiler::{Catalog, Library, Program, Recipe, naga};

/// The same library with its folders the other way round.
struct Reversed(Texts);

impl Library for Reversed {
    fn folders(&self, folder: &str) -> Vec<String> {
        let mut folders = self.0.folders(folder);
        folders.reverse();
        folders
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        self.0.read(path)
    }
}

/// Every pass of a recipe: its own and those that its modules declare.
fn passes(catalog: &Catalog, recipe: &Recipe) -> Vec<String> {
    let main = catalog.compile(recipe, "main").unwrap_or_else(|report| panic!("{report}"));
    let mut passes = BTreeSet::from(["main".to_owned()]);
    for line in main.tree() {
        let module = catalog.module(&format!("{}/{}", line.category, line.module)).unwrap();
        passes.extend(module.manifest.passes.keys().map(|pass| format!("{}.{pass}", line.instance)));
    }
    passes.into_iter().collect()
}

/// All that a program says of itself.
fn product(program: &Program) -> (String, String, u128) {
    let reflection = serde_json::to_string_pretty(program.reflection()).unwrap();
    (program.wgsl().to_owned(), reflection, program.hash())
}

/// All passes of all recipes of the examples.
fn everything(catalog: &Catalog) -> Vec<(String, String, u128)> {
    let mut products = Vec::new();
    for (name, text) in recipes() {
        let recipe = Recipe::parse(&name, &text).unwrap();
        for pass in passes(catalog, &recipe) {
            products.push(product(&catalog.compile(&recipe, &pass).unwrap()));
        }
    }
    products
}

/// Catches an order that comes from a hash map, a thread or a directory, and a cache that changes what is linked.
#[test]
fn linking_is_deterministic() {
    let catalog = Catalog::load(Arc::new(standard())).unwrap();
    let first = everything(&catalog);
    assert_eq!(first, everything(&catalog), "linked twice from one catalog");
    let reversed = Catalog::load(Arc::new(Reversed(standard()))).unwrap();
    assert_eq!(first, everything(&reversed), "folders listed in another order");
    let fresh = Catalog::load(Arc::new(standard())).unwrap();
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| everything(&fresh))).collect();
        for thread in threads {
            assert_eq!(first, thread.join().unwrap(), "linked in four threads at once");
        }
    });
}

/// The source form means what the IR means, and nothing in the IR is there for nothing.
fn assert_lawful(what: &str, program: &Program) {
    let text = program.wgsl();
    match canonical_hash(what, text) {
        Ok(hash) => assert_eq!(hash, program.hash(), "{what}: the two forms differ:\n{text}"),
        Err(report) => panic!("{what}: the source form is no WGSL: {report}\n{text}"),
    }
    let module = program.validated().module();
    let mut compacted = module.clone();
    compact(&mut compacted, KeepUnused::No);
    let sizes = |m: &naga::Module| {
        [
            ("functions", m.functions.len()),
            ("variables", m.global_variables.len()),
            ("types", m.types.len()),
            ("constants", m.constants.len()),
            ("overrides", m.overrides.len()),
            ("global expressions", m.global_expressions.len()),
        ]
    };
    assert_eq!(sizes(module), sizes(&compacted), "{what} has more than it needs:\n{text}");
    let expressions = |m: &naga::Module| m.functions.iter().map(|(_, f)| f.expressions.len()).sum::<usize>();
    assert_eq!(
        expressions(module),
        expressions(&compacted),
        "{what} has expressions that nobody needs:\n{text}"
    );
}

/// Checks what a recipe gives, and its passes; says how many programs that were.
fn check(catalog: &Catalog, what: &str, recipe: &Recipe) -> usize {
    let passes = passes(catalog, recipe);
    for pass in &passes {
        let program = catalog
            .compile(recipe, pass)
            .unwrap_or_else(|report| panic!("{what}, {pass}: {report}"));
        assert_lawful(&format!("{what}, {pass}"), &program);
    }
    passes.len()
}

#[test]
fn of_the_recipes() {
    let catalog = Catalog::load(Arc::new(standard())).unwrap();
    for (name, text) in recipes() {
        check(&catalog, &name, &Recipe::parse(&name, &text).unwrap());
    }
}

/// A module with its defaults; slots that need a module and have none get the first that links.
fn alone(catalog: &Catalog, name: &str) -> Node {
    let module = catalog.module(name).unwrap();
    let mut node = Node::new(name);
    for (slot, declared) in &module.manifest.slots {
        if declared.arity == Arity::Single && declared.default.is_none() {
            let first = catalog.fits(&declared.interface).into_iter().next().unwrap();
            node.fill.insert(
                slot.clone(),
                Filling::One(alone(catalog, &format!("{}/{first}", declared.interface))),
            );
        }
    }
    node
}

/// Every way to put a module of the library into a slot somewhere below a node, one at a time.
fn variants(catalog: &Catalog, node: &Node, depth: usize, out: &mut Vec<(String, Node)>) {
    let module = catalog.module(&node.module).unwrap();
    for (slot, declared) in &module.manifest.slots {
        for fits in catalog.fits(&declared.interface) {
            let child = alone(catalog, &format!("{}/{fits}", declared.interface));
            let with = |child: Node| {
                let mut changed = node.clone();
                changed.fill.insert(slot.clone(), Filling::One(child));
                changed
            };
            out.push((format!("{slot}: {fits}"), with(child.clone())));
            if depth > 0 {
                let mut below = Vec::new();
                variants(catalog, &child, depth - 1, &mut below);
                out.extend(
                    below
                        .into_iter()
                        .map(|(what, child)| (format!("{slot}: {fits}, {what}"), with(child))),
                );
            }
        }
        if declared.arity == Arity::List {
            let all = catalog.fits(&declared.interface);
            let nodes: Vec<Node> = all
                .iter()
                .chain(&all)
                .map(|n| alone(catalog, &format!("{}/{n}", declared.interface)))
                .collect();
            let mut changed = node.clone();
            changed.fill.insert(slot.clone(), Filling::Many(nodes));
            out.push((format!("{slot}: all, twice"), changed));
        }
    }
}

/// Catches a module that links, but only in the company in which it was tried.
#[test]
fn of_every_filling_of_every_slot() {
    let catalog = Catalog::load(Arc::new(standard())).unwrap();
    let roots: Vec<String> = catalog.fits("pass");
    let (mut tried, mut refused) = (0, 0);
    for root in roots {
        let mut all = vec![("as it is".to_owned(), alone(&catalog, &root))];
        variants(&catalog, &all[0].1.clone(), 3, &mut all);
        for (what, node) in all {
            let recipe = Recipe::from(node);
            // A rule of a module may forbid it here.
            match catalog.compile(&recipe, "main") {
                Err(report) if report.diagnostics[0].code == "SW0206" => refused += 1,
                _ => tried += check(&catalog, &format!("{root} with {what}"), &recipe),
            }
        }
    }
    assert!(tried > 40 && refused < tried, "{tried} programs, {refused} refused");
}

/// The probe of a function; none where it samples as only fragment stages can.
fn probe(catalog: &Catalog, recipe: &Recipe, function: &str) -> Option<Program> {
    match catalog.compile_probe(recipe, function) {
        Ok(program) => Some(program),
        Err(report) if report.diagnostics[0].message.starts_with("sampling that chooses its mip level") => None,
        Err(report) => panic!("{}, {function}: {report}", recipe.root.module),
    }
}

/// Catches a function that links in a pass, but not alone.
#[test]
fn of_every_probe_and_every_module_check() {
    let catalog = Catalog::load(Arc::new(standard())).unwrap();
    let mut tried = 0;
    for module in catalog.modules() {
        let name = format!("{}/{}", module.category, module.name);
        catalog.check_module(&name).unwrap_or_else(|report| panic!("{name}: {report}"));
        let recipe = Recipe::from(alone(&catalog, &name));
        for function in catalog.functions(&module.category).unwrap().keys() {
            let Some(program) = probe(&catalog, &recipe, function) else {
                continue;
            };
            assert_lawful(&format!("{name}, {function}"), &program);
            tried += 1;
        }
    }
    assert!(tried >= 15, "{tried} probes");
}

/// Catches a frozen parameter that still reaches the shader from outside.
#[test]
fn of_frozen_parameters() {
    let catalog = Catalog::load(Arc::new(standard())).unwrap();
    for module in catalog.modules() {
        let name = format!("{}/{}", module.category, module.name);
        let plain = alone(&catalog, &name);
        let mut frozen = plain.clone();
        // What the linker fills in is a constant as it is.
        let free = |role: &Option<String>| !role.as_ref().is_some_and(|role| role.starts_with("filled:"));
        for (param, declared) in module.manifest.params.iter().filter(|(_, p)| free(&p.role)) {
            frozen.freeze.insert(param.clone(), declared.default.clone());
        }
        for function in catalog.functions(&module.category).unwrap().keys() {
            let Some(program) = probe(&catalog, &Recipe::from(frozen.clone()), function) else {
                continue;
            };
            let own = |p: &&ParamUse| {
                p.module == module.name && module.manifest.params.contains_key(&p.name) && !matches!(p.place, ParamPlace::Constant { .. })
            };
            let left: Vec<_> = program.reflection().params.iter().filter(own).collect();
            assert!(left.is_empty(), "{name}: {left:?}");
            let text = program.wgsl();
            canonical_hash(&name, text).unwrap_or_else(|report| panic!("{name}: {report}\n{text}"));
        }
    }
}
