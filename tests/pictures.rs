//! Pictures from file to light: a rectangle, given a picture, shines as it says.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use common::catalog;
use serde_json::{Value as Json, json};
use shadewright::compiler::Recipe;
use shadewright::runtime::image::{Hdr, encode_exr, encode_png};
use shadewright::runtime::probe::Probe;
use shadewright::runtime::scene::SceneFile;

/// Catches a file of a module in a slot of a light that does not reach it, channels that are swapped, and a flux that the picture changes.
#[test]
fn a_named_picture_shines() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("colour.exr");
    let picture = Hdr {
        width: 2,
        height: 1,
        texels: vec![[2.0, 0.5, 0.0, 1.0]; 2],
        comment: String::new(),
    };
    std::fs::write(&file, encode_exr(&picture).unwrap()).unwrap();
    let text = format!(
        "(module: \"light/rectangle\", fill: {{
            \"area\": (module: \"split\", fill: {{\"diffuse\": \"form-factor\", \"specular\": \"none\"}}),
            \"picture\": (module: \"image\", files: {{\"image\": {file:?}}}),
        }})"
    );
    let recipe = Recipe::parse("test", &text).unwrap_or_else(|report| panic!("{report}"));
    let probe = Probe::new(catalog(), &recipe, "light").unwrap_or_else(|error| panic!("{error}"));
    let row = |much: &str, number: f64| {
        json!({
            "s": {"normal": [0, 0, 1], "diffuse": [1, 1, 1]}, "v": [0, 0, 1],
            "instances": [{"position": [0, 0, 1], "direction": [0, 0, -1], "right": [1, 0, 0], much: number}],
        })
    };
    let rows: Vec<Json> = vec![row("luminance", 1.0), row("flux", std::f64::consts::PI)];
    let said = probe.answer_on_cpu::<f64>(&probe.table(&rows).unwrap()).unwrap();
    // Lambert 1760, 1 x 1 m at 1 m; the picture's luminance is 0.2126 * 2 + 0.7152 * 0.5.
    let factor = 0.239_456_470_5;
    let mean = 0.7828;
    for (row, full) in [factor, factor / mean].into_iter().enumerate() {
        for (channel, of) in [2.0, 0.5, 0.0].into_iter().enumerate() {
            let got = said["results"][row][channel].as_f64().expect("a finite number");
            assert!(
                (got - of * full).abs() < 1e-6,
                "row {row}, channel {channel}: {got}, not {}",
                of * full
            );
        }
    }
}

/// Catches a bad picture that is taken, or refused without the place in the scene where it is named.
#[test]
fn bad_pictures_are_located() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("long.png"), encode_png(4097, 1, &[9; 4 * 4097]).unwrap()).unwrap();
    std::fs::write(folder.path().join("good.png"), encode_png(3, 2, &[9; 24]).unwrap()).unwrap();
    let frame = |file: &str| {
        let scene = format!(
            "(pass: \"forward\", camera: (eye: (0, 0, 1), target: (0, 0, 0)), meshes: {{\"m\": Sphere(radius: 1)}},\n\
             materials: {{\"m\": {{}}}}, objects: [(mesh: \"m\", material: \"m\")],\n\
             lights: [(module: \"rectangle\", fill: {{\"picture\": (module: \"image\", files: {{\"image\": \"{file}\"}})}})])"
        );
        let parsed = SceneFile::parse("a.scene.ron", &scene, folder.path()).unwrap_or_else(|report| panic!("{report}"));
        parsed.frame(catalog(), None).map(|_| ())
    };
    frame("good.png").unwrap_or_else(|report| panic!("{report}"));
    let text: String = frame("long.png")
        .unwrap_err()
        .render()
        .lines()
        .map(|line| format!("{}\n", line.trim_end()))
        .collect();
    assert_eq!(
        text,
        "error[SW0907]: the file `long.png` cannot be used
  --> a.scene.ron:3:85
  |
3 | lights: [(module: \"rectangle\", fill: {\"picture\": (module: \"image\", files: {\"image\": \"long.png\"})})])
  |                                                                                     ^^^^^^^^^^ 4097 x 1 texels, more than 4096 a side or 4194304 in all
"
    );
}
