use std::collections::BTreeMap;
use std::sync::Arc;

use proptest::prelude::*;
use shadewright_compiler::diagnostics::{Report, SourceFile, codes};
use shadewright_compiler::{Catalog, Library, Recipe, upstream};

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

/// A module in WESL over the standard library.
fn dusty(helper: &str) -> Catalog {
    let library = Texts::default()
        .with(
            "brdf/dusty/module.ron",
            "(summary: \"Dust\", uses: [\"math\"], params: {\"k\": (type: F32, unit: \"1\", default: 1.4, range: (1.0, 4.0), doc: \"k\")})",
        )
        .with(
            "brdf/dusty/dusty.wesl",
            "import package::shared::dust::falloff;\n\n/// Minnaert.\nfn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return s.diffuse * INV_PI * falloff(dot(s.normal, l), params.k);\n}\n",
        )
        .with("shared/dust.wesl", helper);
    let both = Overlay(vec![Arc::new(Wesl(library)), library_of_modules()]);
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

fn refused(path: &str, text: &str, expected: &str) {
    let report = resolved(grain().with(path, text)).map(|file| file.text.clone()).unwrap_err();
    assert_eq!(report, expected.trim_start());
}

const ROOT: &str = "brdf/grain/grain.wesl";

/// Catches an error of wesl that loses its file or its place, and a text that changes by accident; so do the following.
#[test]
fn sw0416_wesl_syntax() {
    refused(
        ROOT,
        "fn f() {\n    let x 1;\n}\n",
        r#"
error[SW0416]: `1` does not fit here
  --> brdf/grain/grain.wesl:2:11
  |
2 |     let x 1;
  |           ^ not understood
  |
  = expected is `:` or `=`
"#,
    );
    refused(
        "shared/noise.wgsl",
        "fn f(",
        r#"
error[SW0416]: the file ends too early
  --> shared/noise.wgsl:1:6
  |
1 | fn f(
  |      ^ not understood
  |
  = expected is `@` or `)` or a name
"#,
    );
}

#[test]
fn sw0417_wesl_import() {
    refused(
        ROOT,
        "import super::nothing::f;\nfn g() { f(); }\n",
        r#"
error[SW0417]: the import `package::brdf::grain::nothing` leads nowhere
  --> brdf/grain/grain.wesl:1:15
  |
1 | import super::nothing::f;
  |               ^^^^^^^ not there
  |
  = looked for `brdf/grain/nothing.wesl` and `brdf/grain/nothing.wgsl` in the library's folder
"#,
    );
    refused(
        ROOT,
        "import package::shared::noise::{hush, Cell};\nfn g(c: Cell) -> f32 { return hush(c); }\n",
        r#"
error[SW0417]: `package::shared::noise` has no declaration `hush`
  --> brdf/grain/grain.wesl:1:33
  |
1 | import package::shared::noise::{hush, Cell};
  |                                 ^^^^ not there
  |
  = did you mean `hash`?
  = declarations of `shared/noise.wgsl`: LIMIT, Cell, unused, mix_up, hash
"#,
    );
    refused(
        ROOT,
        "import bevy::pbr::f;\nfn g() { f(); }\n",
        r#"
error[SW0417]: the import `bevy::pbr` leads nowhere
  --> brdf/grain/grain.wesl:1:14
  |
1 | import bevy::pbr::f;
  |              ^^^ not there
  |
  = a path begins with `package::`, the library's folder, or `super::`; other packages are not taken
"#,
    );
    refused(
        "brdf/grain/tools.wesl",
        "@publish import super::grain::twice;\n",
        r#"
error[SW0417]: an import that is passed on
  --> brdf/grain/tools.wesl:1:2
  |
1 | @publish import super::grain::twice;
  |  ^^^^^^^ not taken
  |
  = import from the file that has the declaration
"#,
    );
}

#[test]
fn sw0418_wesl_condition() {
    refused(
        ROOT,
        "@if(fine && slow)\nfn f() {}\n",
        r#"
error[SW0418]: there is no feature `slow`
  --> brdf/grain/grain.wesl:1:13
  |
1 | @if(fine && slow)
  |             ^^^^ asked for here
  |
  = declare it in the `wesl.ron` of the module's folder: `(features: {"slow": true})`
"#,
    );
    refused(
        ROOT,
        "fn f() {}\n@else\nfn g() {}\n",
        r#"
error[SW0418]: an @elif or @else attribute must be preceded by a @if or @elif on the previous node
  --> brdf/grain/grain.wesl:2:1
  |  
2 | / @else
3 | | fn g() {}
  | \---------^ here
"#,
    );
}

#[test]
fn sw0419_wesl_declaration() {
    refused(
        "brdf/grain/wesl.ron",
        "(\n    feature: {\"fine\": true},\n)\n",
        r#"
error[SW0419]: this declares no features
  --> brdf/grain/wesl.ron:2:5
  |
2 |     feature: {"fine": true},
  |     ^^^^^^^ Unexpected field named `feature` in `Declared`, expected `features` instead
  |
  = expected is `(features: {"name": true})`
"#,
    );
}

#[test]
fn sw0420_wesl_and_wgsl() {
    refused(
        "brdf/grain/grain.wgsl",
        "",
        r#"
error[SW0420]: `brdf/grain/grain.wgsl` and `brdf/grain/grain.wesl` are both there
 = a module's code is in one of them: remove the other
"#,
    );
}

#[test]
fn sw0707_wesl_panic() {
    let report = upstream::guarded_in("wesl", codes::WESL_PANIC, "resolving `a.wesl`", || panic!("planted")).map(|(): ()| ());
    let report = report.map_err(|diagnostic| Report::from(diagnostic).render());
    let expected = "\
error[SW0707]: wesl gave up while resolving `a.wesl`
 = planted
 = this is an error of wesl, which reads and writes shaders for us; a simpler formulation may avoid it
";
    assert_eq!(report.unwrap_err(), expected);
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
