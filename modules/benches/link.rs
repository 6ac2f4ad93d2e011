//! What a permutation costs, step by step, for the forward recipe of the first scene: `cargo bench -p shadewright-modules`.
//!
//! All steps run in one process, interleaved by nothing: compare the ratios, not the times.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use divan::{Bencher, black_box};
use shadewright_compiler::naga::{compact, front, valid};
use shadewright_compiler::{Catalog, LinkPlan, Program, Recipe, Target, emit, hash, reflect, validate};

const RECIPE: &str = include_str!("../../examples/recipes/forward.recipe.ron");

fn main() {
    let (_, _, program) = prepared();
    let module = program.validated().module();
    let expressions: usize = module.functions.iter().map(|(_, f)| f.expressions.len()).sum::<usize>()
        + module.entry_points.iter().map(|e| e.function.expressions.len()).sum::<usize>();
    let instances = program.reflection().instances.len();
    let functions = program.reflection().functions.len();
    let lines = program.wgsl().lines().count();
    // The deterministic side of the figures.
    println!("forward.recipe.ron: {instances} module instances, {functions} functions, {expressions} expressions, {lines} lines");
    divan::main();
}

fn prepared() -> (Catalog, Recipe, Program) {
    let catalog = Catalog::load(shadewright_modules::library()).unwrap();
    let recipe = Recipe::parse("forward.recipe.ron", RECIPE).unwrap();
    let program = catalog.compile(&recipe, "main").unwrap();
    (catalog, recipe, program)
}

fn plan() -> LinkPlan {
    let (catalog, recipe, _) = prepared();
    catalog.plan(&recipe, "main").unwrap()
}

/// Load all manifests of the library, nothing parsed.
#[divan::bench]
fn a_load_manifests() {
    black_box(Catalog::load(shadewright_modules::library()).unwrap());
}

/// From nothing to a validated module: manifests, parsing what the recipe reaches, linking.
#[divan::bench]
fn b_cold_start() {
    black_box(prepared());
}

/// Resolve the tree and plan: reachability, liveness, bindings, names.
#[divan::bench]
fn c_plan(bencher: Bencher) {
    let (catalog, recipe, _) = prepared();
    bencher.bench(|| catalog.plan(black_box(&recipe), "main").unwrap());
}

/// Write the plan as IR.
#[divan::bench]
fn d_link_ir(bencher: Bencher) {
    let plan = plan();
    bencher.bench(|| black_box(&plan).link().unwrap());
}

/// Write the plan as source.
#[divan::bench]
fn e_write_source(bencher: Bencher) {
    let plan = plan();
    bencher.bench(|| black_box(&plan).source().unwrap());
}

/// The canonical hash of the linked module.
#[divan::bench]
fn f_hash(bencher: Bencher) {
    let module = plan().link().unwrap();
    bencher.bench(|| hash::structural_hash(black_box(&module)));
}

/// naga's compaction of the linked module, which the linker does without.
#[divan::bench]
fn g_compact(bencher: Bencher) {
    let module = plan().link().unwrap();
    bencher.with_inputs(|| module.clone()).bench_values(|mut module| {
        compact::compact(&mut module, compact::KeepUnused::No);
        module
    });
}

/// naga's validation with all checks: the floor that everyone pays.
#[divan::bench]
fn h_validate(bencher: Bencher) {
    let module = plan().link().unwrap();
    bencher
        .with_inputs(|| module.clone())
        .bench_values(|module| validate::validate(module).unwrap());
}

/// Reflection's JSON.
#[divan::bench]
fn i_reflection_json(bencher: Bencher) {
    let (_, _, program) = prepared();
    let reflection: &reflect::Reflection = program.reflection();
    bencher.bench(|| serde_json::to_string(black_box(reflection)).unwrap());
}

/// The whole of it with everything parsed: plan, link, hash, validate, reflect.
#[divan::bench]
fn j_compile(bencher: Bencher) {
    let (catalog, recipe, _) = prepared();
    bencher.bench(|| catalog.compile(black_box(&recipe), "main").unwrap());
}

/// naga's writers.
#[divan::bench(args = [Target::WgslFromIr, Target::SpirV, Target::Hlsl, Target::Msl])]
fn k_emit(bencher: Bencher, target: Target) {
    let (_, _, program) = prepared();
    bencher.bench(|| emit(black_box(program.validated()), target, None).unwrap());
}

/// What the text costs whoever is given text: naga's parser on the source form.
#[divan::bench]
fn l_parse_source(bencher: Bencher) {
    let (_, _, program) = prepared();
    bencher.bench(|| front::wgsl::parse_str(black_box(program.wgsl())).unwrap());
}

/// The same, validated.
#[divan::bench]
fn m_parse_and_validate_source(bencher: Bencher) {
    let (_, _, program) = prepared();
    bencher.bench(|| {
        let module = front::wgsl::parse_str(black_box(program.wgsl())).unwrap();
        valid::Validator::new(valid::ValidationFlags::all(), valid::Capabilities::all())
            .validate(&module)
            .unwrap()
    });
}
