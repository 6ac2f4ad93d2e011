//! Edits of a library that is open: what they touch is parsed again, and nothing else.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use shadewright_compiler::{Catalog, Library, Recipe};

/// The standard library with some files edited.
#[derive(Default)]
struct Edited(Mutex<BTreeMap<String, String>>);

impl Edited {
    fn edit(&self, path: &str, from: &str, to: &str) {
        let text = self.read(path).unwrap().unwrap();
        assert!(text.contains(from), "{path} has no {from:?}");
        self.0.lock().unwrap().insert(path.to_owned(), text.replacen(from, to, 1));
    }
}

impl Library for Edited {
    fn folders(&self, folder: &str) -> Vec<String> {
        shadewright_modules::library().folders(folder)
    }
    fn read(&self, path: &str) -> Result<Option<String>, String> {
        match self.0.lock().unwrap().get(path) {
            Some(text) => Ok(Some(text.clone())),
            None => shadewright_modules::library().read(path),
        }
    }
    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        shadewright_modules::library().bytes(path)
    }
}

fn forward() -> Recipe {
    Recipe::parse("forward", include_str!("../../examples/recipes/forward.recipe.ron")).unwrap()
}

fn depth() -> Recipe {
    Recipe::parse("depth", include_str!("../../examples/recipes/depth.recipe.ron")).unwrap()
}

/// Catches a cache that forgets what an edit didn't touch, and one that keeps what it did.
#[test]
fn an_edited_leaf_is_parsed_again_alone() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let before = catalog.compile(&forward(), "main").unwrap();
    let other = catalog.compile(&depth(), "main").unwrap();
    assert!(catalog.parsed() > 10);

    let same = catalog.reload().unwrap();
    assert!(before.is_current(&same) && other.is_current(&same));
    assert_eq!(same.compile(&forward(), "main").unwrap().hash(), before.hash());
    assert_eq!(same.parsed(), 0);

    library.edit("ndf/ggx/ggx.wgsl", "fn distribution(", "// An edit.\nfn distribution(");
    let edited = same.reload().unwrap();
    assert!(!before.is_current(&edited) && other.is_current(&edited));
    let after = edited.compile(&forward(), "main").unwrap();
    assert_eq!(edited.parsed(), 1);
    assert!(after.is_current(&edited) && !after.is_current(&catalog));
    // A comment changes the text and nothing else.
    assert!(after.wgsl().contains("// An edit.") && !before.wgsl().contains("// An edit."));
    assert_eq!(after.hash(), before.hash());
    edited.compile(&depth(), "main").unwrap();
    assert_eq!(edited.parsed(), 1);
}

/// Catches frozen variants of a module that outlive its text.
#[test]
fn all_variants_of_an_edited_module_go() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let frozen = |value: f64| Recipe::parse("r", &format!(r#"(module: "manual", freeze: {{"ev100": {value}}})"#)).unwrap();
    for value in [1.0, 2.0] {
        catalog.compile_probe(&frozen(value), "exposure").unwrap();
    }
    library.edit("exposure/manual/manual.wgsl", "params.ev100", "(params.ev100 + 1.0)");
    let edited = catalog.reload().unwrap();
    for value in [1.0, 2.0] {
        let program = edited.compile_probe(&frozen(value), "exposure").unwrap();
        assert!(program.wgsl().contains("+ 1.0)"), "{}", program.wgsl());
    }
}

/// Catches a module that is kept although its declaration has changed.
#[test]
fn an_edited_declaration_is_seen() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let recipe = Recipe::parse("r", "manual").unwrap();
    let before = catalog.compile_probe(&recipe, "exposure").unwrap();
    library.edit("exposure/manual/module.ron", "default: 12.0", "default: 13.0");
    let edited = catalog.reload().unwrap();
    assert!(!before.is_current(&edited));
    let default = |catalog: &Catalog| {
        let program = catalog.compile_probe(&recipe, "exposure").unwrap();
        serde_json::to_string(&program.reflection().params[0].declared.default).unwrap()
    };
    assert_eq!((default(&catalog).as_str(), default(&edited).as_str()), ("12.0", "13.0"));
}

/// Catches a pass that is taken for current although the module that declares it has changed.
#[test]
fn a_pass_goes_with_the_module_that_declares_it() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let shadow = |catalog: &Catalog| catalog.compile(&forward(), "perspective.shadow").unwrap();
    let before = shadow(&catalog);
    assert!(before.is_current(&catalog.reload().unwrap()));
    let (root, other) = (r#"root: "depth""#, r#"root: (module: "depth", label: "edited")"#);
    library.edit("visibility/perspective/module.ron", root, other);
    let edited = catalog.reload().unwrap();
    assert!(!before.is_current(&edited));
    assert_ne!(shadow(&edited).wgsl(), before.wgsl());
}

/// Catches modules that are kept although the interface that they were checked against has changed.
#[test]
fn an_edited_interface_touches_its_users_only() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let before = catalog.compile(&forward(), "main").unwrap();
    library.edit("ndf/interface.wgsl", "fn distribution(", "// An edit.\nfn distribution(");
    let edited = catalog.reload().unwrap();
    assert!(!before.is_current(&edited));
    assert_eq!(edited.compile(&forward(), "main").unwrap().hash(), before.hash());
    // The distribution of normals, and the BRDF that has a slot for it.
    assert_eq!(edited.parsed(), 2);

    library.edit("ndf/interface.wgsl", "fn distribution(", "fn other(");
    let broken = edited.reload().unwrap();
    assert!(broken.compile(&forward(), "main").is_err());
    assert!(edited.compile(&forward(), "main").is_ok());
}

/// Catches a half-loaded catalog.
#[test]
fn an_edit_that_cannot_be_loaded_costs_nothing() {
    let library = Arc::new(Edited::default());
    let catalog = Catalog::load(library.clone()).unwrap();
    let before = catalog.compile(&forward(), "main").unwrap();
    library.edit("ndf/ggx/module.ron", "summary", "sumary");
    assert!(catalog.reload().is_err());
    assert_eq!(catalog.compile(&forward(), "main").unwrap().hash(), before.hash());
    assert!(before.is_current(&catalog));
}

/// Catches a memory that grows with every value that is frozen.
#[test]
fn variants_are_bounded() {
    let catalog = Catalog::load(shadewright_modules::library()).unwrap();
    let frozen = |step: u32| {
        Recipe::parse(
            "r",
            &format!(r#"(module: "manual", freeze: {{"ev100": {}}})"#, f64::from(step) / 16.0),
        )
        .unwrap()
    };
    let compile = |step| drop(catalog.compile_probe(&frozen(step), "exposure").unwrap());
    (0..100).for_each(compile);
    let parsed = catalog.parsed();
    compile(99);
    // The probe itself is parsed each time.
    assert_eq!(catalog.parsed(), parsed + 1);
    compile(0);
    assert_eq!(catalog.parsed(), parsed + 3);
}
