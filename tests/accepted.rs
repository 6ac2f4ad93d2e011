//! What others say of what is emitted: naga's front end, `tint` (the WGSL compiler of a browser) and `spirv-val` (the validator of the
//! SPIR-V tools) where they are installed.
//!
//! naga alone is not enough, because it wrote or read everything itself, and because it is laxer than browsers are: the last
//! tests here show two modules that it takes and a browser does not.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;
mod verdict;

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use indexmap::IndexMap;
use shadewright::compiler::manifest::ResourceKind;
use shadewright::compiler::reflect::{BindingType, Fill, Stage};
use shadewright::compiler::{Catalog, Program, Recipe, Target, emit};
use shadewright::runtime::scene::SceneFile;
use support::{finish, good, shadewright};
use verdict::{naga_takes, spirv_val, tint};

static CATALOG: LazyLock<Catalog> =
    LazyLock::new(|| Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}")));

/// Files of a folder of examples whose names end like this, sorted.
fn examples(folder: &str, ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples").join(folder);
    let entries = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = entries.filter(|path| path.to_str().is_some_and(|p| p.ends_with(ending))).collect();
    files.sort();
    files
}

/// The recipes that draw a scene and show it.
fn derived(file: &SceneFile) -> Vec<Recipe> {
    let frame = file.frame(&CATALOG, Some([8, 8])).unwrap_or_else(|report| panic!("{report}"));
    let materials = frame.materials.iter().chain(&frame.display);
    materials.map(|material| (*material.recipe).clone().into()).collect()
}

/// A recipe's own pass and those that its modules declare.
fn passes(recipe: &Recipe) -> Vec<Program> {
    let compile = |pass: &str| CATALOG.compile(recipe, pass).unwrap_or_else(|report| panic!("{report}"));
    let main = compile("main");
    let own: Vec<String> = main
        .reflection()
        .passes
        .iter()
        .map(|p| format!("{}.{}", p.instance, p.name))
        .collect();
    std::iter::once(main).chain(own.iter().map(|pass| compile(pass))).collect()
}

/// Every pass of every example recipe and of every recipe that an example scene derives, by its name and text, with where it is from.
static PROGRAMS: LazyLock<Vec<(String, Program)>> = LazyLock::new(|| {
    let mut all: IndexMap<(String, String), (String, Program)> = IndexMap::new();
    let mut add = |name: &Path, recipe: &Recipe| {
        let name = name.file_name().expect("a name").to_string_lossy().into_owned();
        for program in passes(recipe) {
            let name = format!("{name}, pass {}", program.reflection().pass);
            all.entry((program.reflection().pass.clone(), program.wgsl().to_owned()))
                .or_insert((name, program));
        }
    };
    for path in examples("recipes", ".recipe.ron") {
        let text = std::fs::read_to_string(&path).expect("a recipe");
        add(&path, &Recipe::parse("example", &text).unwrap_or_else(|report| panic!("{report}")));
    }
    for path in examples("scenes", ".scene.ron") {
        let file = SceneFile::read(&path).unwrap_or_else(|report| panic!("{report}"));
        derived(&file).iter().for_each(|recipe| add(&path, recipe));
    }
    all.into_values().collect()
});

/// Catches a source form that is no WGSL: an item that is missing, written twice or bound twice, a reserved word, and a capability that WebGPU
/// has not by itself.
#[test]
fn naga_accepts_all_source() {
    for (name, program) in PROGRAMS.iter() {
        naga_takes(program.wgsl()).unwrap_or_else(|error| panic!("{name}\n{error}"));
    }
    let passes = PROGRAMS.iter().filter(|(_, p)| p.reflection().pass != "main").count();
    println!("{} programs, {passes} of them modules' own passes", PROGRAMS.len());
    assert!(PROGRAMS.len() >= 8 && passes >= 3, "{} {passes}", PROGRAMS.len());
}

/// Catches WGSL that only naga takes.
#[test]
fn tint_accepts_all_source() {
    for (name, program) in PROGRAMS.iter() {
        match tint(program.wgsl()) {
            None => return,
            Some(verdict) => verdict.unwrap_or_else(|error| panic!("{name}\n{error}\n{}", program.wgsl())),
        }
    }
    println!("tint accepts {} programs", PROGRAMS.len());
}

/// Catches SPIR-V that breaks Vulkan's rules.
#[test]
fn spirv_val_accepts_all_spirv() {
    for (name, program) in PROGRAMS.iter() {
        let spirv = emit(program.validated(), Target::SpirV, None).unwrap_or_else(|report| panic!("{name}\n{report}"));
        match spirv_val(&spirv) {
            None => return,
            Some(verdict) => verdict.unwrap_or_else(|error| panic!("{name}\n{error}")),
        }
    }
    println!("spirv-val accepts {} programs", PROGRAMS.len());
}

/// Catches a writer that fails or writes nothing. What a language cannot express at all is refused by a code of its own, and counted.
#[test]
fn all_other_languages_are_written() {
    for target in [Target::Hlsl, Target::Msl, Target::Glsl, Target::WgslFromIr] {
        let (mut written, mut refused) = (0, Vec::new());
        for (name, program) in PROGRAMS.iter() {
            for entry in &program.reflection().entry_points {
                match emit(program.validated(), target, Some(&entry.name)) {
                    Ok(text) => {
                        let text = String::from_utf8(text).expect("UTF-8");
                        // GLSL's entry points are all called main.
                        let expected = if target == Target::Glsl { "void main()" } else { &entry.name };
                        assert!(text.contains(expected), "{name}: {} without {expected}\n{text}", target.name());
                        written += 1;
                    }
                    Err(report) => {
                        assert_eq!(report.diagnostics[0].code, "SW0601", "{name}: {report}");
                        refused.push(format!("{name}, {}: {report}", entry.name));
                    }
                }
            }
        }
        println!("{}: {written} entry points, {} refused {refused:?}", target.name(), refused.len());
        assert!(written >= 15, "{}: {written}", target.name());
    }
}

/// What the command emits for this recipe, run in a directory with a number of threads, and to a file there.
fn emitted(recipe: &str, directory: &Path, threads: &str) -> (Vec<u8>, Vec<u8>) {
    let run = |more: &[&str]| {
        let mut command = shadewright();
        command
            .current_dir(directory)
            .env("RAYON_NUM_THREADS", threads)
            .args(["emit", recipe])
            .args(more);
        let ran = finish(&mut command);
        assert_eq!((ran.status, ran.err.as_str()), (0, ""), "{recipe}");
        ran.out
    };
    (
        run(&["--reflect", "reflection.json"]),
        std::fs::read(directory.join("reflection.json")).expect("reflection"),
    )
}

/// Catches an order that comes from a hash map, a thread, a directory, or a path that is written into the shader.
#[test]
fn emission_is_the_same_bytes_anywhere() {
    let (here, there) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    for path in examples("recipes", ".recipe.ron") {
        let recipe = path.to_str().expect("UTF-8");
        let first = emitted(recipe, here.path(), "1");
        assert!(first.0.len() > 100, "{recipe}");
        for (directory, threads) in [(here.path(), "1"), (there.path(), "1"), (there.path(), "4")] {
            let again = emitted(recipe, directory, threads);
            assert!(again == first, "{recipe} with {threads} threads in {}", directory.display());
        }
        // In this process, whose hash seeds are others, too.
        let parsed =
            Recipe::parse("example", &std::fs::read_to_string(&path).expect("a recipe")).unwrap_or_else(|report| panic!("{report}"));
        let program = CATALOG.compile(&parsed, "main").unwrap_or_else(|report| panic!("{report}"));
        assert!(program.wgsl().as_bytes() == first.0, "{recipe}");
    }
    let forward = examples("recipes", "forward.recipe.ron");
    let spirv = || good(&["emit", forward[0].to_str().expect("UTF-8"), "--target", "spirv"]).out;
    assert!(spirv() == spirv());
}

/// Whether a program's reflection or text has anything of shadows, and what.
fn shadows(program: &Program) -> Vec<String> {
    let reflection = program.reflection();
    let mut found: Vec<String> = reflection.passes.iter().map(|pass| format!("pass {}", pass.name)).collect();
    for binding in &reflection.bindings {
        let declared = matches!(
            &binding.fill,
            Fill::Resource {
                declared: ResourceKind::Depth { .. } | ResourceKind::Views { .. },
                ..
            }
        );
        let compares = matches!(binding.ty, BindingType::Sampler { comparison: true });
        let depth = matches!(&binding.ty, BindingType::Texture { sample, .. } if sample.contains("depth"));
        if declared || compares || depth || binding.name.contains("shadow") {
            found.push(format!("binding {}", binding.name));
        }
    }
    let by_module = |category: &str| CATALOG.fits(category);
    for function in &reflection.functions {
        let of_shadows = ["filtering", "visibility"]
            .iter()
            .any(|category| by_module(category).contains(&function.module));
        if (of_shadows && function.module != "none") || function.name.contains("shadow") {
            found.push(format!("function {}", function.name));
        }
    }
    for param in &reflection.params {
        if param.name == "normal_offset" || param.name == "bias" {
            found.push(format!("parameter {}.{}", param.instance, param.name));
        }
    }
    // A comment of an author may speak of shadows.
    let code = program
        .wgsl()
        .lines()
        .map(|line| line.split("//").next().unwrap_or(""))
        .collect::<String>();
    for word in ["shadow", "texture_depth", "sampler_comparison", "textureSampleCompare"] {
        if code.contains(word) {
            found.push(format!("the text has `{word}`"));
        }
    }
    found
}

/// Catches shadow code in a scene without shadows. The runtime's own test asks the same of a small scene; this is the one that is shown.
#[test]
fn without_shadows_the_first_scene_links_no_shadow_code() {
    let first = SceneFile::read(&examples("scenes", "first.scene.ron")[0]).unwrap_or_else(|report| panic!("{report}"));
    let lit = |recipe: &Recipe| {
        let program = CATALOG.compile(recipe, "main").unwrap_or_else(|report| panic!("{report}"));
        let lit = program.reflection().functions.iter().any(|f| f.module == "point");
        lit.then_some(program)
    };
    let with: Vec<Program> = derived(&first).iter().filter_map(lit).collect();
    assert!(with.len() >= 2, "one-sided and two-sided objects");
    for program in &with {
        let found = shadows(program);
        let has = |start: &str| found.iter().filter(|f| f.starts_with(start)).count();
        // Two kinds of maps: for each a map, a sampler and views.
        assert!(
            has("pass ") == 2 && has("binding ") >= 6 && has("function ") >= 6 && has("the text") == 4,
            "{found:?}"
        );
    }
    let off = ["window", "lamp"].iter().fold(first, |file, light| {
        let changed = file.set(&format!("lights[{light}].casts_shadow"), "false");
        changed.unwrap_or_else(|report| panic!("{report}"))
    });
    let without: Vec<Program> = derived(&off).iter().filter_map(lit).collect();
    assert_eq!(without.len(), with.len());
    for program in &without {
        assert_eq!(shadows(program), Vec::<String>::new());
        let stages: Vec<Stage> = program.reflection().entry_points.iter().map(|entry| entry.stage).collect();
        assert_eq!(stages, [Stage::Vertex, Stage::Fragment]);
    }
}

/// Why `tint` is asked: a barrier that only some invocations reach hangs a GPU, and a browser refuses it. naga takes it.
#[test]
fn tint_sees_a_barrier_that_not_all_reach() {
    let wgsl = "
        @group(0) @binding(0) var<storage, read_write> result: array<u32>;
        var<workgroup> sum: u32;
        @compute @workgroup_size(64)
        fn main(@builtin(local_invocation_index) lane: u32) {
            if lane < 3u {
                workgroupBarrier();
            }
            result[lane] = sum;
        }";
    naga_takes(wgsl).expect("naga does not mind");
    if let Some(verdict) = tint(wgsl) {
        let error = verdict.expect_err("a browser minds");
        assert!(error.contains("uniform control flow"), "{error}");
    }
}

/// Why `tint` is asked: of two pointers to one variable a compiler may assume that they are two, and a browser refuses them. naga takes them.
#[test]
fn tint_sees_aliased_pointers() {
    let wgsl = "
        @group(0) @binding(0) var<storage, read_write> result: array<u32>;
        fn add_twice(a: ptr<function, u32>, b: ptr<function, u32>) {
            *a += *b;
            *a += *b;
        }
        @compute @workgroup_size(1)
        fn main() {
            var x = 1u;
            add_twice(&x, &x);
            result[0] = x;
        }";
    naga_takes(wgsl).expect("naga does not mind");
    if let Some(verdict) = tint(wgsl) {
        let error = verdict.expect_err("a browser minds");
        assert!(error.contains("alias"), "{error}");
    }
}
