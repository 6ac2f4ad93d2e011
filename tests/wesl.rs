//! WESL both ways: a module written in it, and a permutation as a file that a program in it imports.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;
mod support;

use std::path::{Path, PathBuf};

use common::{catalog, gpu, probe};
use serde_json::json;
use shadewright::compiler::canonical::canonical_hash;
use shadewright::compiler::{Program, Recipe};
use shadewright::modules::cases;
use shadewright::runtime::wgpu;
use support::{bad, good, run};
use wesl::{CompileOptions, Feature, Features, ModulePath, NoMangler, VirtualResolver};

const FOLDER: &str = "examples/wesl";
const MOON: &str = r#"(module: "forward", fill: {"brdf": "minnaert", "lights": ["directional"]})"#;

fn path(text: &str) -> ModulePath {
    text.parse().expect("a path")
}

/// What wesl makes of a package: the root's text, all of it.
fn compiled(files: &[(&str, &str)], root: &str, mangle: bool) -> String {
    let mut resolver = VirtualResolver::new();
    for (name, text) in files {
        resolver.add_module(path(name), (*text).into());
    }
    let options = CompileOptions {
        validate: false,
        keep_root: true,
        features: Features {
            default: Feature::Error,
            ..Features::default()
        },
        ..CompileOptions::default()
    };
    let result = if mangle {
        wesl::compile(&path(root), &resolver, &wesl::EscapeMangler, &options)
    } else {
        wesl::compile(&path(root), &resolver, &NoMangler, &options)
    };
    result.unwrap_or_else(|error| panic!("{error}")).to_string()
}

fn program(recipe: &Path) -> Program {
    let text = std::fs::read_to_string(recipe).expect("a recipe");
    let recipe = Recipe::parse("example", &text).unwrap_or_else(|report| panic!("{report}"));
    catalog().compile(&recipe, "main").unwrap_or_else(|report| panic!("{report}"))
}

fn recipes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/recipes");
    let mut found: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.to_string_lossy().ends_with(".recipe.ron"));
    found.sort();
    found
}

/// Catches a command that does not see modules in WESL, or that shows them differently from others.
#[test]
fn the_command_takes_a_module_in_wesl() {
    assert_eq!(good(&["check", FOLDER]).text(), "ok     module brdf/minnaert\n");
    let ran = good(&["emit", MOON, "--modules", FOLDER]);
    let text = ran.text();
    for part in [
        "// shared/limb.wesl:14 at main.brdf\n/// Whether both directions are above the horizon.\nfn minnaert_limb_lit(at: MinnaertLimbCosines) -> bool {\n",
        "// brdf/minnaert/minnaert.wesl:5 at main.brdf\n/// albedo / pi",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    assert!(
        !text.contains("surge") && !text.contains("import") && !text.contains("@if"),
        "{text}"
    );
}

/// Catches a wrong place in an error that the command shows, and an exit status that is not that of a wrong input.
#[test]
fn the_command_tells_errors_in_wesl() {
    let folder = tempfile::tempdir().unwrap();
    let copy = |name: &str, change: fn(String) -> String| {
        let text = std::fs::read_to_string(Path::new(FOLDER).join(name)).unwrap();
        let to = folder.path().join(name);
        std::fs::create_dir_all(to.parent().unwrap()).unwrap();
        std::fs::write(to, change(text)).unwrap();
    };
    for name in ["brdf/minnaert/module.ron", "brdf/minnaert/minnaert.wesl", "brdf/minnaert/wesl.ron"] {
        copy(name, |text| text);
    }
    let modules = folder.path().to_str().unwrap();
    bad(
        &["emit", MOON, "--modules", modules],
        1,
        &["error[SW0417]", "brdf/minnaert/minnaert.wesl:1:25", "shared/limb.wesl"],
    );
    copy("shared/limb.wesl", |text| text.replace("at.l > 0.0", "at.l > 0u"));
    bad(&["emit", MOON, "--modules", modules], 1, &["error[SW0402]", "shared/limb.wesl:15:"]);
    // The switch is off, so what it needs may be wrong; on, it is looked at.
    copy("shared/limb.wesl", |text| text.replace("fn surge", "fn swell"));
    good(&["emit", MOON, "--modules", modules]);
    copy("brdf/minnaert/wesl.ron", |text| text.replace("false", "true"));
    bad(
        &["emit", MOON, "--modules", modules],
        1,
        &["error[SW0417]", "no declaration `surge`"],
    );
}

/// Catches WESL that is resolved to something that computes otherwise: the module's own table, on the device.
#[test]
fn a_module_in_wesl_computes_what_its_table_says() {
    let folder = tempfile::tempdir().unwrap();
    let table = std::fs::read_to_string(Path::new(FOLDER).join("brdf/minnaert/cases.ron")).unwrap();
    let cases = cases::parse(&table).unwrap();
    assert_eq!(cases.len(), 3);
    let inputs = folder.path().join("inputs.json");
    let rows: Vec<_> = cases
        .iter()
        .map(|case| {
            let mut row = serde_json::to_value(&case.inputs).unwrap();
            row["params"] = serde_json::to_value(&case.params).unwrap();
            row
        })
        .collect();
    std::fs::write(&inputs, json!(rows).to_string()).unwrap();
    let ran = run(&[
        "probe",
        "minnaert",
        "brdf",
        "--inputs",
        inputs.to_str().unwrap(),
        "--modules",
        FOLDER,
        "--format",
        "json",
    ]);
    assert_eq!(ran.status, 0, "{}", ran.err);
    let results = ran.json();
    for (case, result) in cases.iter().zip(results["results"].as_array().expect("results")) {
        let expected = serde_json::to_value(&case.expect).unwrap();
        for (got, expected) in result.as_array().unwrap().iter().zip(expected.as_array().unwrap()) {
            assert!(
                case.accepts(expected.as_f64().unwrap(), got.as_f64().unwrap()),
                "{got} {expected} {}",
                case.source
            );
        }
    }
}

/// Catches a permutation that is not one plain file: something to import, to decide, to specialise without being asked for, or to bind
/// that the reflection does not tell.
#[test]
fn a_permutation_is_one_plain_file() {
    for recipe in recipes() {
        let program = program(&recipe);
        let text = program.wgsl();
        let module = naga::front::wgsl::parse_str(text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(text)));
        let name = recipe.display();
        assert!(
            !text.contains("import ") && !text.contains("::") && !text.contains('#') && !text.contains("@if"),
            "{name}"
        );
        assert!(!text.contains("\nenable ") && !text.contains("\nrequires "), "{name}");
        assert_eq!(module.overrides.len(), program.reflection().overrides.len(), "{name}");
        let bound = module
            .global_variables
            .iter()
            .filter(|(_, variable)| variable.binding.is_some())
            .count();
        assert_eq!(bound, program.reflection().bindings.len(), "{name}");
        assert_eq!(module.entry_points.len(), program.reflection().entry_points.len(), "{name}");
    }
}

/// Catches an emitted file that wesl reads as another shader.
#[test]
fn wesl_reads_a_permutation_as_it_is() {
    let all = recipes();
    assert!(all.len() >= 5);
    for recipe in all {
        let program = program(&recipe);
        let again = compiled(&[("package::main", program.wgsl())], "package::main", false);
        let hash = canonical_hash("again.wgsl", &again).unwrap_or_else(|report| panic!("{}\n{report}", recipe.display()));
        assert_eq!(hash, program.hash(), "{}", recipe.display());
    }
}

/// A program in WESL that takes functions of a permutation and has buffers and an entry point of its own.
const RENDERER: &str = "
import package::shaders::copper::{microfacet_brdf, Surface};

@group(0) @binding(0) var<storage, read_write> results: array<vec4f>;

// A name that the permutation has, too: they are not one.
fn unit_or(v: vec3f) -> vec3f { return normalize(v); }

@compute @workgroup_size(16)
fn run(@builtin(global_invocation_id) id: vec3u) {
    let t = f32(id.x) / 16.0;
    var s: Surface;
    s.normal = vec3f(0.0, 0.0, 1.0);
    s.diffuse = vec3f(0.2, 0.1, 0.05);
    s.f0 = vec3f(0.95, 0.64, 0.54);
    s.alpha = 0.05 + t * t;
    results[id.x] = vec4f(microfacet_brdf(s, unit_or(vec3f(t, 0.0, 1.0)), unit_or(vec3f(-0.5, t, 0.5))), 1.0);
}
";

/// Catches functions of a permutation that mean something else in the program that imports them: against the module itself, probed.
#[test]
fn a_program_in_wesl_imports_a_permutation() {
    let copper = program(&Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/recipes/unshadowed.recipe.ron"));
    let files = [("package::main", RENDERER), ("package::shaders::copper", copper.wgsl())];
    let text = compiled(&files, "package::main", true);
    assert!(
        text.contains("fn run(") && text.contains("fn unit_or(v: vec3f)") && !text.contains("fragment"),
        "{text}"
    );

    let rows = (0..16).map(|i| {
        let t = f64::from(i) / 16.0;
        let unit = |v: [f64; 3]| v.map(|x| x / v.iter().map(|x| x * x).sum::<f64>().sqrt());
        let surface = json!({"normal": [0, 0, 1], "diffuse": [0.2, 0.1, 0.05], "f0": [0.95, 0.64, 0.54], "alpha": 0.05 + t * t});
        json!({"s": surface, "v": unit([t, 0.0, 1.0]), "l": unit([-0.5, t, 0.5])})
    });
    let expected = probe(r#"(module: "microfacet")"#, "brdf", rows.collect());
    let got = dispatched(&text, 16);
    for (i, row) in got.iter().enumerate() {
        for (channel, value) in row.iter().take(3).enumerate() {
            let expected = expected[i][channel].as_f64().expect("a number");
            assert!(
                expected > 0.0 && (f64::from(*value) - expected).abs() <= 1e-5 * expected,
                "row {i}: {value} {expected}"
            );
        }
    }
}

/// Runs the entry point `run` of a text on one workgroup: what it left in its only buffer.
fn dispatched(wgsl: &str, rows: usize) -> Vec<[f32; 4]> {
    let gpu = gpu();
    let device = gpu.device();
    let size = rows as u64 * 16;
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC;
    let buffer = gpu.buffer("results", usage, &[], size).expect("a buffer");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("run"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry {
            binding: 0,
            resource: buffer.as_entire_binding(),
        }],
    });
    let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = commands.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
    let bytes = gpu.read("results", commands, &buffer, size).expect("results");
    let numbers: Vec<f32> = bytes
        .chunks_exact(4)
        .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
        .collect();
    numbers.chunks_exact(4).map(|row| [row[0], row[1], row[2], row[3]]).collect()
}
