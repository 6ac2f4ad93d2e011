mod diagnostics;

use std::collections::BTreeMap;
use std::sync::Arc;

use proptest::prelude::*;
use shadewright_compiler::diagnostics::SourceFile;
use shadewright_compiler::{Catalog, Library, Recipe};

use super::Wesl;
use crate::{Overlay, library as library_of_modules};

/// A library in memory.
#[derive(Clone, Default)]
struct Texts(BTreeMap<String, String>);

impl Texts {
    fn with(mut self, path: &str, text: &str) -> Self {
        self.0.insert(path.to_owned(), text.to_owned());
        self
    }
}

impl Library for Texts {
    fn folders(&self, folder: &str) -> Vec<String> {
        let prefix = if folder.is_empty() { String::new() } else { format!("{folder}/") };
        let below = self.0.keys().filter_map(|path| path.strip_prefix(&prefix)?.split_once('/'));
        let mut names: Vec<String> = below.map(|(name, _)| name.to_owned()).collect();
        names.dedup();
        names
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        Ok(self.0.get(path).cloned())
    }
}

const ROOT: &str = "brdf/grain/grain.wesl";

const GRAIN: &str = "\
// Grain.
import package::shared::noise::{hash, Cell, LIMIT as MOST};
import super::tools;

/// What it is for.
struct Own {
    cell: Cell, // the place
    @if(debug) seen: u32,
    last: f32,
}

@if(fine)
/// Fine.
fn step() -> f32 { return 0.25; }
/// Coarse.
@else
fn step() -> f32 { return 0.5; }

/// albedo, a function of the slot's and a parameter: none of them is declared here.
fn brdf(s: Surface, v: vec3f, l: vec3f, @if(debug) extra: f32) -> vec3f {
    let noise = hash(Cell(s.place, MOST)) * tools::twice(params.k); // twice
    @if(fine) {
        let x = 1.0;
        if x > 0.5 { return vec3f(noise); } else { return s.diffuse; }
    }
    // not so fine
    @else return vec3f(0.1, step(), 1e-3) * noise;
}
";

const NOISE: &str = "\
enable f16;
const LIMIT = 3u;
/// A cell.
struct Cell { at: vec2f, limit: u32 }
fn unused() {}
/* helper */
fn mix_up(a: f32) -> f32 { return fract(a * 43758.5453); }

/// One number of a cell.
/// Between 0 and 1.
fn hash(c: Cell) -> f32 {
    let noise_mix = c.at.x;
    return mix_up(noise_mix + f32(c.limit));
}
";

fn grain() -> Texts {
    Texts::default()
        .with("brdf/grain/grain.wesl", GRAIN)
        .with("brdf/grain/tools.wesl", "fn twice(a: f32) -> f32 { return a + a; }\n")
        .with("brdf/grain/wesl.ron", "(features: {\"debug\": false, \"fine\": true})")
        .with("shared/noise.wgsl", NOISE)
}

fn resolved(library: Texts) -> Result<Arc<SourceFile>, String> {
    let file = Wesl(library).file("brdf/grain/grain.wgsl").map_err(|report| report.render())?;
    Ok(file.unwrap())
}

const FINE: &str = "\
enable f16;
// Grain.

/// What it is for.
struct Own {
    cell: NoiseCell, // the place
    last: f32,
}

/// Fine.
fn step() -> f32 { return 0.25; }

/// albedo, a function of the slot's and a parameter: none of them is declared here.
fn brdf(s: Surface, v: vec3f, l: vec3f, ) -> vec3f {
    let noise = noise_hash(NoiseCell(s.place, NOISE_LIMIT)) * tools_twice(params.k); // twice
    {
        let x = 1.0;
        if x > 0.5 { return vec3f(noise); } else { return s.diffuse; }
    }
}


fn tools_twice(a: f32) -> f32 { return a + a; }

const NOISE_LIMIT = 3u;

/// A cell.
struct NoiseCell { at: vec2f, limit: u32 }

fn noise_mix_up(a: f32) -> f32 { return fract(a * 43758.5453); }

/// One number of a cell.
/// Between 0 and 1.
fn noise_hash(c: NoiseCell) -> f32 {
    let noise_mix = c.at.x;
    return noise_mix_up(noise_mix + f32(c.limit));
}
";

/// Catches a comment, a name or a formatting that is lost, a condition that is decided wrongly, and an import that is left out.
#[test]
fn the_authors_words_stay() {
    assert_eq!(resolved(grain()).unwrap().text, FINE);
    let coarse = grain().with("brdf/grain/wesl.ron", "(features: {\"debug\": true, \"fine\": false})");
    let text = resolved(coarse).unwrap().text.clone();
    for part in [
        "    cell: NoiseCell, // the place\n    seen: u32,\n",
        "/// Coarse.\nfn step() -> f32 { return 0.5; }",
        "l: vec3f, extra: f32)",
        "    // not so fine\n    return vec3f(0.1, step(), 1e-3) * noise;\n}",
    ] {
        assert!(text.contains(part), "{part}\n\n{text}");
    }
    for part in ["Fine", "@if", "@else", "let x"] {
        assert!(!text.contains(part), "{part}\n\n{text}");
    }
}

/// Catches a module without imports that is changed, and a library whose other files are.
#[test]
fn what_is_plain_wgsl_stays_as_it_is() {
    let plain =
        "// A.\n\nfn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f { return own(params.k); } // b\n\n\n/* c */ var<private> x: f32; ;\n";
    let library = Wesl(grain().with("brdf/grain/grain.wesl", plain));
    let text = library.read("brdf/grain/grain.wgsl").unwrap().unwrap();
    assert_eq!(text, plain.replace(" ;\n", " \n") + "\n");
    assert_eq!(library.read("shared/noise.wgsl"), Ok(Some(NOISE.to_owned())));
    assert_eq!(library.read("brdf/other/other.wgsl"), Ok(None));
    assert_eq!(library.folders("brdf"), ["grain"]);
}

/// Catches an imported name that is captured by a local of the same name, or given to two declarations.
#[test]
fn imported_names_are_nobody_elses() {
    let text = |root: &str| {
        let library = grain()
            .with("brdf/grain/grain.wesl", root)
            .with("brdf/grain/noise.wesl", "fn hash() -> f32 { return 7.0; }");
        resolved(library).unwrap().text.clone()
    };
    let captured = text("import super::noise::hash; fn f() -> f32 { let noise_hash = 1.0; return hash() + noise_hash; }");
    assert!(
        captured.contains("let noise_hash = 1.0; return brdf_grain_noise_hash() + noise_hash;"),
        "{captured}"
    );
    let twice = text("import package::shared::noise::LIMIT; fn f() -> f32 { return super::noise::hash() + f32(LIMIT); }");
    assert!(
        twice.contains("return brdf_grain_noise_hash() + f32(SHARED_NOISE_LIMIT);"),
        "{twice}"
    );
    let both = text("import package::shared::noise::hash; fn f() -> f32 { return super::noise::hash(); }");
    assert!(both.contains("noise_hash()"), "{both}");
}

/// Catches a byte whose place is another one in the author's file.
#[test]
fn places_are_the_authors() {
    let made = resolved(grain()).unwrap();
    for (part, file, line, column) in [
        ("cell: NoiseCell", "brdf/grain/grain.wesl", 7, 5),
        ("return s.diffuse", "brdf/grain/grain.wesl", 24, 52),
        ("(noise_mix + ", "shared/noise.wgsl", 13, 18),
        ("twice(a: f32)", "brdf/grain/tools.wesl", 1, 4),
        ("f16", "shared/noise.wgsl", 1, 8),
    ] {
        let at = made.text.find(part).unwrap_or_else(|| panic!("{part}"));
        let (origin, span) = made.origin(at..at + 1);
        let place = origin.position(span.start);
        assert_eq!((origin.name.as_str(), place.line, place.column), (file, line, column), "{part}");
    }
}

/// Catches syntax that wesl writes in other words than the author, so that comments and places of its declaration would be lost: every file
/// of the standard library, and what none of them has.
#[test]
fn no_syntax_is_taken_in_other_words() {
    let all = "import super::tools::twice;
diagnostic(off, derivative_uniformity);
alias V = vec3<f32>; // alias
override o: u32 = 3u; // override
const_assert 1 < 2; // assert
var<storage, read> a: array<atomic<u32>>; // storage
var<private> p: mat2x2<f32> = mat2x2<f32>(1f, 0.5, 1e-3, 0x1p4); // private
@diagnostic(off, derivative_uniformity) @compute @workgroup_size(8, o)
fn f(@builtin(global_invocation_id) id: vec3<u32>, @builtin(local_invocation_index) i: u32) { // compute
    var x = twice(1.0); // var
    let q = &x;
    *q += 1.0; x++; x -= -x; _ = ~i; // assign
    switch i { case 0, 1u: { x = twice(x); } case 2: { } default { x = 2.0; } } // switch
    switch (i) { case 3, default: { x = twice(x); } } // switch
    for (var j = 0; j < 3; j++) { if (j == 1) { continue; } else if j == 2 { break; } else { x = 0.0; } } // for
    while x < 2.0 { x = x * 2.0; } // while
    loop { if !((x > 1.0 && x < 4.0) || x == 0.0) { break; } continuing { x = twice(x); break if x >= 3.0; } } // loop
    const k = array<i32, 2>(1, 2); // const
    if any(vec2<bool>(true, false)) { return; } // return
    x = select(1.0, bitcast<f32>(((i << 2u) >> 1u) | (i & 3u) | (1u ^ 2u)), (a[0u].b.c % 2u) != 0u); // shifts
    @if(fine) discard; // discard
    @if(fine) x = 1.0; @elif(debug) x = 2.0; @elif(fine && !debug) x = 3.0; @else x = 4.0; // chain
}
fn g() -> @location(0) @interpolate(flat, either) vec4<f32> { { return vec4<f32>(twice(0.5)); } } // location
struct S { @align(16) @size(32) x: f32, @builtin(position) @invariant y: vec4<f32> } // struct
";
    let made = resolved(grain().with(ROOT, all)).unwrap();
    let comments = |text: &str| text.matches(" // ").count();
    assert_eq!(comments(&made.text), comments(all), "{}", made.text);
    assert!(made.text.contains("1f, 0.5, 1e-3, 0x1p4"), "{}", made.text);

    let mut seen = 0;
    for (path, text) in crate::Embedded.files().filter(|(path, _)| path.ends_with(".wgsl")) {
        // Each function calls something imported, so that none is left as it is.
        let calling = format!(
            "import super::tools::twice;\n{}",
            text.replace(") -> f32 {\n", ") -> f32 {\n    _ = twice(1.0);\n")
        );
        let made = resolved(grain().with(ROOT, &calling)).unwrap_or_else(|error| panic!("{path}\n{error}"));
        let expected = calling
            .replace("import super::tools::twice;\n", "")
            .replace("twice(", "tools_twice(");
        assert!(made.text.starts_with(&expected), "{path}\n{}", made.text);
        seen += calling.matches("_ = twice").count();
    }
    assert!(seen > 20, "{seen}");
}

/// Catches a reload that keeps a module whose imported file was edited.
#[test]
fn an_edit_of_an_imported_file_is_seen() {
    #[derive(Clone)]
    struct Edited(Arc<std::sync::Mutex<Texts>>);
    impl Library for Edited {
        fn folders(&self, folder: &str) -> Vec<String> {
            self.0.lock().unwrap().folders(folder)
        }
        fn read(&self, path: &str) -> Result<Option<String>, String> {
            self.0.lock().unwrap().read(path)
        }
    }
    let edited = Edited(Arc::new(std::sync::Mutex::new(dusty_texts(DUST))));
    let both = Overlay(vec![Arc::new(Wesl(edited.clone())), library_of_modules()]);
    let catalog = Catalog::load(Arc::new(both)).unwrap_or_else(|report| panic!("{report}"));
    let recipe = Recipe::parse("r", "(module: \"dusty\")").unwrap();
    let program = |catalog: &Catalog| catalog.compile_probe(&recipe, "brdf").unwrap_or_else(|report| panic!("{report}"));
    let before = program(&catalog);
    for (change, same) in [(format!("\n{DUST}"), true), (DUST.replace("0.0", "0.5"), false)] {
        let text = dusty_texts(&change);
        *edited.0.lock().unwrap() = text;
        let again = catalog.reload().unwrap();
        let after = program(&again);
        // The first edit moves a line alone: nothing else changes, but the place does.
        assert_eq!(after.hash() == before.hash(), same);
        assert_ne!(after.wgsl(), before.wgsl());
        // The module, and the compiler's own of the probe.
        assert_eq!(again.parsed(), 2);
    }
}

/// A module in WESL over the standard library.
fn dusty_texts(helper: &str) -> Texts {
    Texts::default()
        .with(
            "brdf/dusty/module.ron",
            "(summary: \"Dust\", uses: [\"math\"], params: {\"k\": (type: F32, unit: \"1\", default: 1.4, range: (1.0, 4.0), doc: \"k\")})",
        )
        .with(
            "brdf/dusty/dusty.wesl",
            "import package::shared::dust::falloff;\n\n/// Minnaert.\nfn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return s.diffuse * INV_PI * falloff(dot(s.normal, l), params.k);\n}\n",
        )
        .with("shared/dust.wesl", helper)
}

fn dusty(helper: &str) -> Catalog {
    let both = Overlay(vec![Arc::new(Wesl(dusty_texts(helper))), library_of_modules()]);
    Catalog::load(Arc::new(both)).unwrap_or_else(|report| panic!("{report}"))
}

const DUST: &str = "\n/// cos^(k - 1).\nfn falloff(cosine: f32, k: f32) -> f32 {\n    return pow(max(cosine, 0.0), k - 1.0);\n}\n";

/// Catches a module in WESL that cannot be linked as any other, and a place in the shader that names the wrong file.
#[test]
fn a_module_in_wesl_is_linked_as_any_other() {
    let recipe = Recipe::parse("r", "(module: \"forward\", fill: {\"brdf\": \"dusty\", \"lights\": [\"point\"]})").unwrap();
    let program = dusty(DUST).compile(&recipe, "main").unwrap_or_else(|report| panic!("{report}"));
    let text = program.wgsl();
    assert!(
        text.contains("// brdf/dusty/dusty.wesl:4 at main.brdf\n/// Minnaert.\nfn dusty_brdf("),
        "{text}"
    );
    assert!(
        text.contains("// shared/dust.wesl:3 at main.brdf\n/// cos^(k - 1).\nfn dusty_dust_falloff("),
        "{text}"
    );
    let place = program
        .reflection()
        .functions
        .iter()
        .find(|f| f.name == "dusty_dust_falloff")
        .unwrap();
    assert_eq!((place.file.as_str(), place.line), ("shared/dust.wesl", 3));
}

/// Catches an error in an imported file that is told at the module's.
#[test]
fn an_error_in_an_imported_file_is_told_there() {
    let recipe = Recipe::parse("r", "(module: \"dusty\")").unwrap();
    let wrong = DUST.replace("k - 1.0", "k - true");
    let report = dusty(&wrong).compile_probe(&recipe, "brdf").unwrap_err().render();
    assert!(report.starts_with("error[SW0402]"), "{report}");
    assert!(report.contains("--> shared/dust.wesl:4:34\n"), "{report}");
    assert!(report.contains("return pow(max(cosine, 0.0), k - true);"), "{report}");
}

/// Catches imports that lead in a circle, or a file that imports itself, and a text too deep for wesl's stack.
#[test]
fn circles_and_depths_end() {
    let circle = grain()
        .with(
            ROOT,
            "import super::tools::a; fn b() { a(); } fn c() { package::brdf::grain::grain::b(); }",
        )
        .with("brdf/grain/tools.wesl", "import super::grain::b; fn a() { b(); a(); }");
    let text = resolved(circle).unwrap().text.clone();
    assert!(
        text.contains("fn tools_a() { b(); tools_a(); }") && text.contains("fn c() { b(); }"),
        "{text}"
    );
    let deep = format!("fn f() -> f32 {{ return {}1.0; }}", "1.0 + ".repeat(1000));
    assert!(resolved(grain().with(ROOT, &deep)).is_ok());
    let deeper = format!("fn f() -> f32 {{ return {}1.0{}; }}", "(".repeat(200), ")".repeat(200));
    assert!(resolved(grain().with(ROOT, &deeper)).unwrap_err().starts_with("error[SW0702]"));
}

/// Catches an order, or a choice among several errors, that comes from wesl's hash maps.
#[test]
fn equal_input_gives_equal_bytes() {
    let root: String = (0..8)
        .map(|i| format!("fn f{i}() -> f32 {{ return super::t{i}::g(); }}\n"))
        .collect();
    let library = |body: &str| {
        let add = |library: Texts, i: i32| library.with(&format!("brdf/grain/t{i}.wesl"), &body.replace('I', &i.to_string()));
        (0..8).fold(grain().with(ROOT, &root), add)
    };
    let good = library("fn g() -> f32 { return I.0; }");
    let text = resolved(good.clone()).unwrap().text.clone();
    assert!(text.find("fn t1_g()") < text.find("fn t5_g()"), "{text}");
    let bad = library("fn h() -> f32 { return I.0; }");
    let error = resolved(bad.clone()).unwrap_err();
    assert!(error.contains("`package::brdf::grain::t0` has no declaration `g`"), "{error}");
    for _ in 0..8 {
        assert_eq!(resolved(good.clone()).unwrap().text, text);
        assert_eq!(resolved(bad.clone()).unwrap_err(), error);
    }
}

/// What a file loses and gets while it is being written.
fn mutated(text: &'static str) -> impl Strategy<Value = String> {
    let pieces = prop::sample::select(vec![
        "",
        "@if(fine)",
        "@else",
        "@elif(debug)",
        "@",
        "(",
        ")",
        "{",
        "}",
        ";",
        ",",
        "::",
        "<",
        ">>",
        "import super::tools;",
        "fn f() {}",
        "é字",
        "/*",
        "//",
        "#",
        "hash",
        "noise_hash",
        "const_assert true;",
        "@publish",
        "package::shared::noise::",
        "enable f16;",
        "\r\n",
        "\0",
    ]);
    let edit = (0..=text.len(), 0usize..12, pieces);
    prop::collection::vec(edit, 0..4).prop_map(|edits| {
        let mut text = text.to_owned();
        for (at, length, piece) in edits {
            let start = text.floor_char_boundary(at.min(text.len()));
            let end = text.floor_char_boundary((start + length).min(text.len())).max(start);
            text.replace_range(start..end, piece);
        }
        text
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Catches a panic of wesl or of ours, a text that differs from run to run, and a copied part that is not the author's text.
    #[test]
    fn no_text_panics(root in mutated(GRAIN), noise in mutated(NOISE), fine in any::<bool>()) {
        let features = format!("(features: {{\"fine\": {fine}, \"debug\": false}})");
        let library = grain().with(ROOT, &root).with("shared/noise.wgsl", &noise).with("brdf/grain/wesl.ron", &features);
        let made = resolved(library.clone());
        prop_assert_eq!(&made, &resolved(library));
        match made {
            Err(report) => prop_assert!(report.starts_with("error[SW04") || report.starts_with("error[SW070"), "{}", report),
            Ok(made) => {
                for at in (0..made.text.len()).filter(|&at| made.text.is_char_boundary(at)) {
                    let (file, span) = made.origin(at..at + 1);
                    prop_assert!(span.end <= file.text.len() + 1, "{} {:?}", file.name, span);
                }
            }
        }
    }
}
