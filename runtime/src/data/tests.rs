//! Files of data in probes and frames.

use std::fs;

use serde_json::{Value as Json, json};
use shadewright_compiler::program::Recipe;
use shadewright_compiler::{Catalog, Report};

use super::*;
use crate::gpu::RuntimeError;
use crate::gpu::pipeline::Pipelines;
use crate::gpu::testing::{catalog, gpu};
use crate::probe::Probe;

const INTERFACE: &str = "fn eval(i: u32) -> vec2f { return vec2f(0.0); }";
const SOURCE: &str = "
    var<storage> steps: array<f32, 3>;
    var<storage> measured: array<vec2f>;
    fn eval(i: u32) -> vec2f { return measured[i] * steps[i] + vec2f(f32(arrayLength(&measured))); }";

/// A module with a table of its own, and one that a recipe fills.
fn stepped(format: &str) -> std::sync::Arc<Catalog> {
    let manifest = format!(
        "(summary: \"tested\", resources: {{
            \"steps\": (kind: Data(file: \"steps.txt\")),
            \"measured\": (kind: Data(format: \"{format}\")),
        }})"
    );
    // In a library of texts a table is a text: these bytes are three numbers.
    let steps = "\0\0\0?\0\0\0@\0\0@@";
    catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        ("tested/interface.wgsl", INTERFACE),
        ("tested/stepped/module.ron", &manifest),
        ("tested/stepped/stepped.wgsl", SOURCE),
        ("tested/stepped/steps.txt", steps),
    ])
}

fn floats(list: &[f32]) -> Vec<u8> {
    list.iter().flat_map(|x| x.to_le_bytes()).collect()
}

fn probe(format: &str, file: &Path) -> Result<Probe, RuntimeError> {
    let text = format!("(module: \"stepped\", files: {{\"measured\": {file:?}}})");
    Probe::new(&stepped(format), &Recipe::parse("test.recipe.ron", &text)?, "eval")
}

/// Catches tables that do not reach a GPU or the evaluator, that are padded (their length would be another), or that two files share.
#[test]
fn tables_fill_buffers_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("measured.f32");
    fs::write(&file, floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])).unwrap();
    let probe = probe("f32", &file).unwrap();
    let rows: Vec<Json> = (0..3).map(|i| json!({"i": i})).collect();
    let table = probe.table(&rows).unwrap();
    let expected = json!([[3.5, 4.0], [9.0, 11.0], [18.0, 21.0]]);
    assert_eq!(probe.answer_on_cpu::<f32>(&table).unwrap()["results"], expected);
    assert_eq!(probe.answer_on_cpu::<f64>(&table).unwrap()["results"], expected);
    let gpu = gpu();
    assert_eq!(
        probe.answer(&Pipelines::new(&gpu, None), &gpu, &table).unwrap()["results"],
        expected
    );
    assert_eq!(probe.tables(), [&[0.5, 2.0, 3.0][..], &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]);
}

fn rendered(format: &str, file: &Path, folder: &Path) -> String {
    match probe(format, file) {
        Err(RuntimeError::Compile(report)) => report.render().replace(&folder.display().to_string(), "DIR"),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("taken"),
    }
}

/// The text without trailing spaces.
fn text(report: &str) -> String {
    report.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// Catches files that are taken as they are, and errors that do not say where the file was named.
#[test]
fn bad_files_are_located() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str, bytes: &[u8]| {
        fs::write(folder.path().join(name), bytes).unwrap();
        text(&rendered("f32", &folder.path().join(name), folder.path()))
    };
    let place = |name: &str, why: &str| {
        let full = format!("{:?}", folder.path().join(name));
        let line = format!("(module: \"stepped\", files: {{\"measured\": \"DIR/{name}\"}})");
        format!(
            "error[SW0907]: the file `DIR/{name}` cannot be used\n  --> test.recipe.ron:1:41\n  |\n1 | {line}\n  | {}{} {why}\n",
            " ".repeat(40),
            "^".repeat(full.len())
        )
    };
    assert_eq!(at("cut", &[0; 9]), place("cut", "9 bytes are no whole number of 32-bit floats"));
    assert_eq!(at("nan", &floats(&[0.0, f32::NAN])), place("nan", "number 1 is NaN"));
    assert_eq!(at("empty", &[]), place("empty", "it holds no number"));
    assert_eq!(
        at("odd", &floats(&[0.0; 5])),
        place("odd", "5 numbers, but an element of `array<vec2<f32>>` takes 2")
    );
    let gone = text(&rendered("f32", &folder.path().join("gone"), folder.path()));
    assert_eq!(gone, place("gone", "No such file or directory (os error 2)"));
    assert_eq!(
        text(&rendered("f31", Path::new("a"), folder.path())),
        "error[SW0908]: no decoder reads the format `f31`
  --> test.recipe.ron:1:41
  |
1 | (module: \"stepped\", files: {\"measured\": \"a\"})
  |                                         ^^^ `a` is to be read so
  |
  = did you mean `f32`?
  = formats: f32, merl, rgl, photometry, picture
"
    );
}

/// Catches a file that is not there and read as an empty or white one.
#[test]
fn a_file_must_be_named() {
    let recipe = Recipe::parse("test.recipe.ron", "(module: \"stepped\")").unwrap();
    let error = Probe::new(&stepped("f32"), &recipe, "eval").map(|_| ()).unwrap_err();
    let RuntimeError::Compile(report) = error else { panic!("{error}") };
    assert_eq!(
        text(&Report::render(&report)),
        "error[SW0215]: `stepped.measured` needs a file of the format `f32`
  --> test.recipe.ron:1:10
  |
1 | (module: \"stepped\")
  |          ^^^^^^^^^ none is named here
  |
  = name one: `files: {\"measured\": \"PATH\"}`
"
    );
}

/// A scene whose surfaces have a table, with what is said of the BRDF.
fn scene(brdf: &str) -> String {
    format!(
        "(
    camera: (eye: (0, 0, 5), target: (0, 0, 0)),
    pass: \"forward\",
    meshes: {{\"ball\": Sphere(radius: 1)}},
    materials: {{\"a\": {{\"brdf\": {brdf}}}}},
    lights: [(module: \"point\")],
    objects: [(mesh: \"ball\", material: \"a\")],
)"
    )
}

fn derive(brdf: &str, folder: &Path) -> Result<crate::frame::Frame, Report> {
    let catalog = catalog(&[
        (
            "brdf/tabled/module.ron",
            "(summary: \"tested\", resources: {\"measured\": (kind: Data(format: \"f32\"))})",
        ),
        (
            "brdf/tabled/tabled.wgsl",
            "var<storage> measured: array<f32>;\nfn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f { return vec3f(measured[0]); }",
        ),
    ]);
    crate::scene::SceneFile::parse("a.scene.ron", &scene(brdf), folder)?.frame(&catalog, None)
}

/// Catches files of a scene that do not reach the frame, and two files at two places that one of them gets.
#[test]
fn scenes_name_files() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("one.f32"), floats(&[1.0])).unwrap();
    let frame = derive("(module: \"tabled\", files: {\"measured\": \"one.f32\"})", folder.path()).unwrap();
    assert_eq!(*frame.materials[0].settings.data["main.brdf"]["measured"], [1.0]);
}

/// Catches a scene's files that are taken as they are.
#[test]
fn files_of_scenes_are_located() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("cut.f32"), [0; 6]).unwrap();
    let error = |brdf: &str| text(&derive(brdf, folder.path()).unwrap_err().render());
    assert_eq!(
        error("(module: \"tabled\", files: {\"measured\": \"cut.f32\"})"),
        "error[SW0907]: the file `cut.f32` cannot be used
  --> a.scene.ron:5:70
  |
5 |     materials: {\"a\": {\"brdf\": (module: \"tabled\", files: {\"measured\": \"cut.f32\"})}},
  |                                                                      ^^^^^^^^^ 6 bytes are no whole number of 32-bit floats
"
    );
    assert_eq!(
        error("(module: \"tabled\", files: {\"measurd\": \"cut.f32\"})"),
        "error[SW0214]: `tabled` takes no file `measurd`
  --> a.scene.ron:5:58
  |
5 |     materials: {\"a\": {\"brdf\": (module: \"tabled\", files: {\"measurd\": \"cut.f32\"})}},
  |                                                          ^^^^^^^^^ no such resource
  |
  = did you mean `measured`?
  = resources that take a file: measured

error[SW0215]: `tabled.measured` needs a file of the format `f32`
  --> a.scene.ron:5:40
  |
5 |     materials: {\"a\": {\"brdf\": (module: \"tabled\", files: {\"measurd\": \"cut.f32\"})}},
  |                                        ^^^^^^^^ none is named here
  |
  = name one: `files: {\"measured\": \"PATH\"}`
"
    );
}
