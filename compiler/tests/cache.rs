//! What a host may key a cache of its own by: the canonical hash of a program, and a recipe's key before anything is compiled.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};

use common::{Texts, recipes, small, standard};
use shadewright_compiler::{Catalog, Library, Recipe};

/// A library that lists its folders the other way round.
struct Reversed(Texts);

impl Library for Reversed {
    fn folders(&self, folder: &str) -> Vec<String> {
        let mut names = self.0.folders(folder);
        names.reverse();
        names
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        self.0.read(path)
    }
}

/// A library that remembers what was read of it.
struct Watched(Texts, Mutex<BTreeSet<String>>);

impl Library for Watched {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.0.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        self.1.lock().unwrap().insert(path.to_owned());
        self.0.read(path)
    }
}

fn recipe(text: &str) -> Recipe {
    Recipe::parse("test.recipe.ron", text).unwrap_or_else(|report| panic!("{report}"))
}

fn load(library: impl Library + 'static) -> Catalog {
    Catalog::load(Arc::new(library)).unwrap_or_else(|report| panic!("{report}"))
}

fn key(texts: &Texts, recipe: &Recipe, pass: &str) -> u128 {
    load(texts.clone()).key(recipe, pass).unwrap_or_else(|report| panic!("{report}"))
}

/// Catches a hash or a key that changes from process to process, as one with a random seed does. Where a change of the compiler or of
/// naga changes them for good, users' caches are void: that belongs into the changelog.
#[test]
fn they_are_the_same_in_every_process() {
    let texts = small().module("value", "twice", "", "fn value(x: f32) -> f32 {\n    return 2.0 * x;\n}\n");
    let text = r#"(module: "run", fill: {"value": "twice"})"#;
    let found = (texts.link(text).hash(), key(&texts, &recipe(text), "main"));
    assert_eq!(found, (PINNED_HASH, PINNED_KEY), "{:#034x} {:#034x}", found.0, found.1);
}

const PINNED_HASH: u128 = 0x7923_0bf1_428a_0c6a_b27e_3129_4d85_033b;
const PINNED_KEY: u128 = 0x2cb9_b206_4521_fc45_8854_77ba_15ac_a514;

/// Catches a hash or key that depends on which thread was first, or on the order in which a file system lists folders.
#[test]
fn they_are_the_same_in_every_thread_and_order() {
    let texts = standard();
    let all: Vec<Recipe> = recipes().values().map(|text| recipe(text)).collect();
    let of = |catalog: &Catalog| -> Vec<(u128, u128)> {
        let both = all.iter().map(|recipe| {
            let program = catalog.compile(recipe, "main").unwrap_or_else(|report| panic!("{report}"));
            (program.hash(), catalog.key(recipe, "main").unwrap())
        });
        both.collect()
    };
    let expected = of(&load(texts.clone()));
    assert_eq!(of(&load(Reversed(texts.clone()))), expected);
    let shared = load(texts);
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| of(&shared))).collect();
        for thread in threads {
            assert_eq!(thread.join().unwrap(), expected);
        }
    });
    let distinct: BTreeSet<_> = expected.iter().flat_map(|(hash, key)| [hash, key]).collect();
    assert_eq!(distinct.len(), 2 * all.len());
}

/// Catches a form of a function, kept of one permutation, that another one is given although more or less of it is alive there.
#[test]
fn a_permutation_is_the_same_whatever_was_linked_before() {
    let texts = standard();
    let all: Vec<Recipe> = recipes().values().map(|text| recipe(text)).collect();
    let ir = |catalog: &Catalog, recipe: &Recipe| {
        let program = catalog.compile(recipe, "main").unwrap_or_else(|report| panic!("{report}"));
        format!("{:?}", program.validated().module())
    };
    let alone: Vec<String> = all.iter().map(|recipe| ir(&load(texts.clone()), recipe)).collect();
    let shared = load(texts);
    // Each after every other one.
    for first in &all {
        for (recipe, alone) in all.iter().zip(&alone) {
            ir(&shared, first);
            assert!(ir(&shared, recipe) == *alone, "{:?} after {:?}", recipe.root, first.root);
        }
    }
}

/// Catches a file that the compiler reads and the key forgets, so that a cache would give an old shader for a new text; and a key that
/// changes with files that the recipe has nothing to do with.
#[test]
fn a_key_changes_with_exactly_the_files_that_the_recipe_reaches() {
    let texts = standard();
    for name in ["forward.recipe.ron", "auto-exposure.recipe.ron"] {
        let recipe = recipe(&recipes()[name]);
        let watched = Arc::new(Watched(texts.clone(), Mutex::default()));
        let catalog = Catalog::load(Arc::clone(&watched) as Arc<dyn Library>).unwrap();
        // Declarations are all read before anything is known of recipes.
        watched.1.lock().unwrap().clear();
        catalog.compile_all(&recipe).unwrap_or_else(|report| panic!("{report}"));
        let mut reached = watched.1.lock().unwrap().clone();
        for path in reached.clone() {
            let (folder, file) = path.rsplit_once('/').unwrap();
            let declaration = if file == "interface.wgsl" { "category.ron" } else { "module.ron" };
            reached.insert(format!("{folder}/{declaration}"));
        }
        assert!(reached.len() > 10 && reached.len() + 10 < texts.0.len(), "{reached:?}");
        let before = key(&texts, &recipe, "main");
        for path in texts.0.keys() {
            let mut edited = texts.clone();
            let text = edited.0.get_mut(path).unwrap();
            // Another number, where it is a table.
            match text.strip_prefix('\0') {
                Some(rest) => *text = format!("\u{1}{rest}"),
                None => text.push('\n'),
            }
            let changed = key(&edited, &recipe, "main") != before;
            assert_eq!(changed, reached.contains(path), "{name}: {path}");
        }
    }
}

/// Catches a key that forgets what an interface uses, where no module of the tree names it.
#[test]
fn a_key_changes_with_what_interfaces_use() {
    let texts = small()
        .category("deep", "", "const SCALE: f32 = 2.0;\n")
        .category(
            "between",
            r#"uses: ["deep"]"#,
            "fn scaled(x: f32) -> f32 {\n    return x * SCALE;\n}\n",
        )
        .category(
            "value",
            r#"uses: ["between"]"#,
            "fn value(x: f32) -> f32 {\n    return scaled(x);\n}\n",
        )
        .module("value", "own", "", "fn value(x: f32) -> f32 {\n    return scaled(x) + 1.0;\n}\n");
    let recipe = recipe(r#"(module: "run", fill: {"value": "own"})"#);
    for path in [
        "deep/interface.wgsl",
        "deep/category.ron",
        "between/interface.wgsl",
        "between/category.ron",
    ] {
        let mut edited = texts.clone();
        edited.0.get_mut(path).unwrap().push('\n');
        assert_ne!(key(&edited, &recipe, "main"), key(&texts, &recipe, "main"), "{path}");
    }
}

/// Catches keys that are equal for unequal products, and a key of the recipe's spelling instead of its tree.
#[test]
fn a_key_is_that_of_the_tree_and_the_pass() {
    let texts = standard();
    let of = |text: &str, pass: &str| key(&texts, &recipe(text), pass);
    let plain = of(r#"(module: "forward", fill: {"lights": ["point"]})"#, "main");
    let spelled = of(
        "// With its default.\n(module: \"pass/forward\", fill: {\"lights\": \"point\", \"material\": \"metalness\"})",
        "main",
    );
    assert_eq!(plain, spelled);
    let others = [
        of(r#"(module: "forward", fill: {"lights": ["point"]})"#, "cube_map.shadow"),
        of(r#"(module: "forward", fill: {"lights": ["point", "point"]})"#, "main"),
        of(r#"(module: "forward", fill: {"lights": [(module: "point", label: "a")]})"#, "main"),
        of(r#"(module: "forward", fill: {"lights": ["directional"]})"#, "main"),
        of(
            r#"(module: "forward", fill: {"lights": ["point"]}, freeze: {"double_sided": true})"#,
            "main",
        ),
        of(r#"(module: "forward", fill: {"lights": []})"#, "main"),
    ];
    let distinct: BTreeSet<u128> = others.into_iter().chain([plain]).collect();
    assert_eq!(distinct.len(), 7);
    let mut more = texts.clone();
    more.0.insert("brdf/new/module.ron".to_owned(), "(summary: \"new\")".to_owned());
    assert_eq!(
        key(&more, &recipe(r#"(module: "forward", fill: {"lights": ["point"]})"#), "main"),
        plain
    );
}

/// Catches a pass that inherits what the recipe says and not what the root has by default: recipes of one tree, and so of one key, would have
/// two shadows.
#[test]
fn a_pass_inherits_defaults_as_well() {
    let mut texts = standard().module(
        "geometry",
        "raised",
        "",
        "fn deform(v: Vertex) -> Vertex {\n    var raised = v;\n    raised.position.y += 1.0;\n    return raised;\n}\n",
    );
    let forward = texts.0.get_mut("pass/forward/module.ron").unwrap();
    *forward = forward.replace(r#"default: ["static"]"#, r#"default: ["raised"]"#);
    let catalog = load(texts);
    let of = |text: &str| {
        let recipe = recipe(text);
        let program = catalog
            .compile(&recipe, "cube_map.shadow")
            .unwrap_or_else(|report| panic!("{report}"));
        (catalog.key(&recipe, "cube_map.shadow").unwrap(), program.hash())
    };
    let light = r#""lights": [(module: "point", fill: {"visibility": "cube-map"})]"#;
    let plain = of(&format!(r#"(module: "forward", fill: {{{light}}})"#));
    assert_eq!(
        plain,
        of(&format!(r#"(module: "forward", fill: {{"geometry": ["raised"], {light}}})"#))
    );
    assert_ne!(
        plain.1,
        of(&format!(r#"(module: "forward", fill: {{"geometry": ["static"], {light}}})"#)).1
    );
}

/// Catches a key of something that stands for no tree.
#[test]
fn no_key_without_a_tree() {
    let report = load(standard()).key(&recipe("forwrad"), "main").expect_err("no such module");
    assert_eq!(report.diagnostics[0].code, "SW0201", "{report}");
}

/// Catches a new naga whose products are taken for the old one's.
#[test]
fn the_key_has_the_version_of_naga_that_is_linked() {
    let lock = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../Cargo.lock")).unwrap();
    let naga = lock
        .split("[[package]]")
        .find(|package| package.contains("\nname = \"naga\"\n"))
        .unwrap();
    assert!(
        naga.contains(&format!("\nversion = \"{}\"\n", shadewright_compiler::NAGA)),
        "{naga}"
    );
}
