//! The house's rules: who may know whom, what the compiler may touch, and that what is written twice agrees.

#![allow(clippy::expect_used, clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use shadewright::compiler::Catalog;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Folders of what is shipped.
const SOURCES: &[&str] = &[
    "compiler/src",
    "compiler/evaluate/src",
    "modules/src",
    "runtime/src",
    "runtime/report/src",
    "examples/explorer/src",
    "examples/explorer/page/src",
    "src",
];

fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO"))
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("cargo writes UTF-8")
}

/// Files below a folder with this ending, sorted.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(files(&path, ending));
        } else if path.to_string_lossy().ends_with(ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Rust outside tests and comments. Tests stand at a file's end under `#[cfg(test)]`, or in files of their own.
fn code(path: &Path) -> Vec<(usize, String)> {
    let is_tests = path.components().any(|part| part.as_os_str() == "tests") || path.ends_with("tests.rs");
    if is_tests {
        return Vec::new();
    }
    let text = read(path);
    let mut lines = Vec::new();
    let mut previous_is_test = false;
    for (index, line) in text.lines().enumerate() {
        if previous_is_test && line.trim_start().starts_with("mod ") && line.trim_end().ends_with('{') {
            break;
        }
        previous_is_test = line.trim() == "#[cfg(test)]";
        if !line.trim_start().starts_with("//") {
            lines.push((index + 1, line.to_owned()));
        }
    }
    lines
}

/// Catches a dependency that turns the order of the house round, in any kind of dependency (also of tests).
#[test]
fn the_arrows_go_one_way() {
    let allowed: BTreeMap<&str, &[&str]> = BTreeMap::from([
        ("shadewright-compiler", &[][..]),
        ("shadewright-evaluate", &[][..]),
        ("shadewright-modules", &["shadewright-compiler"][..]),
        (
            "shadewright-runtime",
            &["shadewright-compiler", "shadewright-evaluate", "shadewright-modules"][..],
        ),
        (
            "shadewright-report",
            &[
                "shadewright-compiler",
                "shadewright-evaluate",
                "shadewright-modules",
                "shadewright-runtime",
            ][..],
        ),
        (
            "shadewright-benchmark",
            &["shadewright-compiler", "shadewright-modules", "shadewright-runtime"][..],
        ),
        (
            "shadewright",
            &[
                "shadewright-compiler",
                "shadewright-evaluate",
                "shadewright-modules",
                "shadewright-report",
                "shadewright-runtime",
            ][..],
        ),
        (
            "explorer",
            &[
                "shadewright-compiler",
                "shadewright-evaluate",
                "shadewright-modules",
                "shadewright-report",
                "shadewright-runtime",
            ][..],
        ),
        ("explorer-page", &[][..]),
        // Somebody else's: the compiler when it runs, the modules when it is built.
        ("renderer", &["shadewright-compiler", "shadewright-modules"][..]),
    ]);
    let metadata: Value = serde_json::from_str(&cargo(&["metadata", "--no-deps", "--format-version", "1", "--offline"])).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let mut wrong = Vec::new();
    for package in packages {
        let name = package["name"].as_str().expect("a name");
        let Some(allowed) = allowed.get(name) else {
            wrong.push(format!("{name}: a package that the order doesn't name"));
            continue;
        };
        for dependency in package["dependencies"].as_array().expect("dependencies") {
            let to = dependency["name"].as_str().expect("a name");
            if to.starts_with("shadewright") && !allowed.contains(&to) {
                wrong.push(format!("{name} -> {to}"));
            }
        }
    }
    assert_eq!(packages.len(), allowed.len(), "a package is gone");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Catches a GPU that creeps into the compiler or the modules through some dependency's feature.
#[test]
fn the_compiler_has_no_gpu() {
    for package in ["shadewright-compiler", "shadewright-evaluate", "shadewright-modules"] {
        let tree = cargo(&[
            "tree",
            "--package",
            package,
            "--edges",
            "normal,build",
            "--prefix",
            "none",
            "--offline",
        ]);
        assert!(tree.contains("naga v"), "the tree of {package} is not what it should be:\n{tree}");
        let gpu: Vec<&str> = tree
            .lines()
            .filter(|line| line.starts_with("wgpu") || line.starts_with("shadewright-runtime"))
            .collect();
        assert!(gpu.is_empty(), "{package} depends on {gpu:?}");
    }
}

/// Catches an example of somebody else's renderer that has more of ours in it than it says: the compiler alone where it links shaders
/// itself, nothing where its build script wrote them.
#[test]
fn a_users_renderer_has_little_or_nothing_of_ours() {
    let ours = |features: &[&str]| -> Vec<String> {
        let mut arguments = vec![
            "tree",
            "--package",
            "renderer",
            "--edges",
            "normal",
            "--prefix",
            "none",
            "--offline",
        ];
        arguments.extend(features);
        let tree = cargo(&arguments);
        assert!(tree.contains("wgpu v"), "{tree}");
        let names = tree.lines().filter_map(|line| line.split(' ').next());
        let names: BTreeSet<&str> = names.filter(|name| name.starts_with("shadewright")).collect();
        names.into_iter().map(str::to_owned).collect()
    };
    assert_eq!(ours(&[]), ["shadewright-compiler"]);
    assert_eq!(ours(&["--no-default-features"]), Vec::<String>::new());
}

/// Catches a compiler that reaches anything but its arguments and its `Library`.
#[test]
fn the_compiler_touches_nothing_outside() {
    let outside = [
        "std::fs",
        "std::env",
        "std::net",
        "std::process",
        "std::io::stdin",
        "File::open",
        "Instant::now",
        "SystemTime",
    ];
    let mut wrong = Vec::new();
    let sources = [
        files(&root().join("compiler/src"), ".rs"),
        files(&root().join("compiler/evaluate/src"), ".rs"),
    ]
    .concat();
    assert!(!sources.is_empty());
    for path in sources {
        for (number, line) in code(&path) {
            wrong.extend(
                outside
                    .iter()
                    .filter(|word| line.contains(*word))
                    .map(|word| format!("{}:{number}: {word}", path.display())),
            );
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Words that name a module or category and are also something else: where they may stand, and as what.
const HOMONYMS: &[(&str, &str, &str)] = &[
    ("compiler/src", "none", "in advice: no module fits"),
    ("compiler/src", "light", "a bind group"),
    ("compiler/src", "material", "a bind group"),
    ("compiler/src", "pass", "a bind group; the field of a resource's declaration"),
    ("compiler/src", "depth", "a kind of texture"),
    ("compiler/src", "visibility", "a field of wgpu's layouts"),
    ("compiler/src", "static", "a word of Rust"),
    ("compiler/src", "constant", "a kind of item"),
    ("runtime/src", "depth", "a kind of texture"),
    ("runtime/src", "display", "the scene's field, and the frame's image"),
    ("runtime/src", "forward", "a member of the interface's struct for views"),
    ("runtime/src", "perspective", "a member of the same"),
    ("runtime/src", "none", "in messages: nothing is there"),
    ("runtime/src", "merl", "a format of files"),
    ("runtime/src", "rgl", "a format of files"),
    ("runtime/src", "tube", "a field of a torus"),
    ("runtime/report/src", "hard", "a field of experiments"),
    ("runtime/report/src", "light", "a colour of the page's theme"),
    ("runtime/report/src", "diffuse", "a member of the interface's surface"),
    ("runtime/report/src", "normal", "a member of the same"),
    ("runtime/report/src", "masking", "a field of `*.proofs.ron`"),
    ("runtime/report/src", "albedo", "the heading of a column"),
];

/// Catches a compiler that knows a category or module by its name instead of by what it declares, and a runtime that knows a module.
#[test]
fn nobody_knows_a_module_by_name() {
    let catalog = Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}"));
    let modules: BTreeSet<String> = catalog
        .modules()
        .flat_map(|module| [module.name.clone(), format!("{}/{}", module.category, module.name)])
        .collect();
    let categories: BTreeSet<String> = catalog.categories().map(|category| category.name.clone()).collect();
    assert!(modules.contains("lambert") && modules.contains("brdf/lambert") && categories.contains("brdf"));
    let all: BTreeSet<String> = modules.union(&categories).cloned().collect();
    let mut wrong = Vec::new();
    // Scenes have lights and materials, so the runtime knows what these categories are for; the compiler knows none.
    for (folder, names) in [
        ("compiler/src", &all),
        ("compiler/evaluate/src", &all),
        ("runtime/src", &modules),
        ("runtime/report/src", &all),
    ] {
        for path in files(&root().join(folder), ".rs") {
            for (number, line) in code(&path) {
                for name in names {
                    let allowed = HOMONYMS.iter().any(|(place, word, _)| *place == folder && word == name);
                    if line.contains(&format!("\"{name}\"")) && !allowed {
                        wrong.push(format!("{}:{number}: \"{name}\"", path.display()));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// All `SW` codes in a text.
fn codes(text: &str) -> BTreeSet<String> {
    let found = text.match_indices("SW").filter_map(|(start, _)| text.get(start..start + 6));
    found
        .filter(|code| code[2..].bytes().all(|byte| byte.is_ascii_digit()))
        .map(str::to_owned)
        .collect()
}

/// Catches a code that the list of diagnostics misses, and a listed one that no source has.
#[test]
fn every_code_is_listed() {
    let listed = codes(&read(&root().join("spec/diagnostics.md")));
    let mut used = BTreeSet::new();
    for folder in SOURCES {
        for path in files(&root().join(folder), ".rs") {
            for (_, line) in code(&path) {
                used.extend(codes(&line));
            }
        }
    }
    assert!(!used.is_empty());
    assert_eq!(
        used.difference(&listed).collect::<Vec<_>>(),
        Vec::<&String>::new(),
        "not in spec/diagnostics.md"
    );
    assert_eq!(listed.difference(&used).collect::<Vec<_>>(), Vec::<&String>::new(), "in no source");
}

/// Catches a field of the declarations that the specification does not explain.
#[test]
fn the_specification_knows_every_field() {
    let catalog = Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}"));
    let mut fields = BTreeSet::new();
    let mut keys = |value: &Value| fields.extend(value.as_object().into_iter().flatten().map(|(key, _)| key.clone()));
    for category in catalog.categories() {
        keys(&serde_json::to_value(&category.manifest).expect("JSON"));
    }
    for module in catalog.modules() {
        let manifest = serde_json::to_value(&module.manifest).expect("JSON");
        keys(&manifest);
        for group in ["slots", "params", "instances", "resources"] {
            manifest[group].as_object().into_iter().flatten().for_each(|(_, item)| keys(item));
        }
    }
    assert!(fields.len() >= 25, "{fields:?}");
    let specification = read(&root().join("spec/modules.md"));
    let missing: Vec<&String> = fields
        .iter()
        .filter(|field| !specification.contains(&format!("`{field}`")))
        .collect();
    assert!(missing.is_empty(), "spec/modules.md does not explain {missing:?}");
}

/// Catches links between the documents that lead nowhere.
#[test]
fn links_between_documents_lead_somewhere() {
    let mut documents = files(&root().join("spec"), ".md");
    documents.extend(["README.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|name| root().join(name)));
    let mut wrong = Vec::new();
    for document in documents {
        let text = read(&document);
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for link in links.filter(|link| !link.starts_with("http") && !link.starts_with('#')) {
            let file = link.split('#').next().unwrap_or(link);
            if !document.parent().expect("a folder").join(file).exists() {
                wrong.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Catches a module's folder without its formula, its cases or its code.
#[test]
fn every_module_is_a_whole_folder() {
    let library = shadewright::modules::library();
    let mut seen = 0;
    for category in library.folders("") {
        for module in library.folders(&category) {
            seen += 1;
            for file in ["module.ron", "README.md", "cases.ron", &format!("{module}.wgsl")] {
                let path = format!("{category}/{module}/{file}");
                let text = library.read(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
                assert!(text.is_some_and(|text| !text.trim().is_empty()), "{path} is missing or empty");
            }
        }
    }
    assert!(seen >= 15, "only {seen} modules are embedded");
}

/// Catches a file that has grown into several ideas. Aimed at are half of these sizes.
#[test]
fn no_file_is_a_heap() {
    let mut wrong = Vec::new();
    for (folders, ending, most) in [
        (SOURCES, ".rs", 520),
        (&["compiler/tests", "modules/tests", "runtime/tests", "tests"][..], ".rs", 800),
        (&["modules"][..], ".wgsl", 250),
    ] {
        for path in folders.iter().flat_map(|folder| files(&root().join(folder), ending)) {
            let lines = read(&path).lines().count();
            if lines > most {
                wrong.push(format!("{}: {lines} lines, more than {most}", path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Catches a module that turns roughness, glossiness, alpha or an exponent into one another by itself: there would be two rules for one word.
#[test]
fn roughness_is_converted_in_one_place() {
    let place = root().join("modules/conversion/interface.wgsl");
    let forms = [
        "roughness * roughness",
        "roughness * params.",
        "sqrt(s.alpha)",
        "sqrt(alpha)",
        "sqrt(roughness)",
        "1.0 - glossiness",
        "1.0 - params.glossiness",
        "MIN_ALPHA",
        "(1.0 + alpha) / (alpha * alpha)",
        "(1.0 + a) / (a * a)",
    ];
    let conversions = |line: &str| forms.iter().any(|form| line.contains(form));
    let mut wrong = Vec::new();
    let mut seen = 0;
    for path in files(&root().join("modules"), ".wgsl").into_iter().filter(|path| *path != place) {
        let is_material = path.starts_with(root().join("modules/material"));
        for (index, line) in read(&path).lines().enumerate() {
            let line = line.split("//").next().unwrap_or_default();
            // A material gives widths by a function of that place, or one that has been given already.
            let width = is_material && ["alpha = ", "widths = "].iter().any(|text| line.contains(text));
            let given = ["alpha_of_", "widths_of_", "vec2f(s.alpha)", "= 1.0", "= vec2f(1.0)"]
                .iter()
                .any(|text| line.contains(text));
            seen += usize::from(width && given);
            if conversions(line) || (width && !given) {
                wrong.push(format!("{}:{}: {}", path.display(), index + 1, line.trim()));
            }
        }
    }
    assert!(seen >= 6, "{seen}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
