//! The command `sheet`: one scene with every choice of a space, as one picture, and beside the true one.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use image::RgbImage;
use support::{bad, good, names};

const SCENE: &str = "examples/scenes/sphere.scene.ron";
const SIZE: &str = "48x40";
/// Free space, and the height of a name's strip.
const GAP: u32 = 4;
const STRIP: u32 = 24;

fn picture(path: &Path) -> RgbImage {
    image::open(path).expect("a picture").to_rgb8()
}

/// Catches tiles that show another choice than their place says, an axis that is left out or turned round, `--set` that comes too late, and a
/// scene that is not drawn as `render` draws it.
#[test]
fn each_tile_is_what_render_draws() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let sheet = path("sheet.png");
    let roughness = "materials.ball.material.params.roughness";
    let ran = good(&[
        "sheet",
        SCENE,
        "--each",
        r#"materials.ball.brdf=(one_of: ["ward", (module: "diffuse", fill: {"diffuse": "eon"}), "lambert"])"#,
        "--each",
        &format!("{roughness}=[0.2, 0.9]"),
        "--set",
        "lights[key].fields.illuminance=3000",
        "--size",
        SIZE,
        "-o",
        &sheet,
    ]);
    assert_eq!(ran.text(), "6 pictures\n");
    let sheet = picture(Path::new(&sheet));
    assert_eq!([sheet.width(), sheet.height()], [2 * (48 + GAP) + GAP, 3 * (40 + STRIP) + GAP]);
    for (row, brdf) in ["ward", r#"(module: "diffuse", fill: {"diffuse": "eon"})"#, "lambert"]
        .iter()
        .enumerate()
    {
        for (column, value) in ["0.2", "0.9"].iter().enumerate() {
            let single = path("single.png");
            let [brdf, value] = [format!("materials.ball.brdf={brdf}"), format!("{roughness}={value}")];
            let key = "lights[key].fields.illuminance=3000";
            good(&[
                "render", SCENE, "--set", &brdf, "--set", &value, "--set", key, "--size", SIZE, "-o", &single,
            ]);
            let single = picture(Path::new(&single));
            let [x, y] = [GAP + column as u32 * (48 + GAP), GAP + row as u32 * (40 + STRIP)];
            for (at_x, at_y, pixel) in single.enumerate_pixels() {
                assert_eq!(sheet.get_pixel(x + at_x, y + at_y), pixel, "{brdf} {value} at {at_x}, {at_y}");
            }
        }
    }
}

/// Catches a truth that stands in the wrong column or is drawn with the choice, an error of another pair, and a choice that is not the truth without one.
#[test]
fn a_sheet_against_the_truth_has_three_columns() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("UTF-8").to_owned();
    let sheet = path("sheet.png");
    let ran = good(&[
        "sheet",
        SCENE,
        "--each",
        r#"materials.ball.brdf=["lambert", "ward"]"#,
        "--against",
        r#"(module: "brdf/ward")"#,
        "--size",
        SIZE,
        "-o",
        &sheet,
    ]);
    let lines: Vec<String> = ran.text().lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), 2, "{lines:?}");
    assert!(lines[0].starts_with("lambert: RMS ") && !lines[0].contains("RMS 0 %"), "{lines:?}");
    assert_eq!(lines[1], "ward: RMS 0 %, largest 0 %");
    let sheet = picture(Path::new(&sheet));
    assert_eq!([sheet.width(), sheet.height()], [3 * (48 + GAP) + GAP, 2 * (40 + STRIP) + GAP]);
    let tile = |column: u32, row: u32| {
        let [x, y] = [GAP + column * (48 + GAP), GAP + row * (40 + STRIP)];
        image::imageops::crop_imm(&sheet, x, y, 48, 40).to_image()
    };
    assert_eq!(tile(1, 0), tile(1, 1));
    assert_eq!(tile(0, 1), tile(1, 1));
    assert_ne!(tile(0, 0), tile(1, 0));
    assert!(tile(2, 1).pixels().all(|pixel| pixel.0 == [0; 3]), "no error");
    assert!(tile(2, 0).pixels().any(|pixel| pixel.0 != [0; 3]), "an error");
}

/// Catches the list of models that loses one: a BRDF or a diffuse part that the library has and the contact sheet of all models doesn't show.
#[test]
fn the_space_of_models_has_every_model() {
    let ran = good(&["permutations", "examples/spaces/models.space.ron"]);
    let listed = |category: &str| {
        let json = good(&["--format", "json", "list", "--category", category]).json();
        let modules = json["categories"][0]["modules"].as_array().expect("a list");
        let names = modules.iter().map(|module| module["name"].as_str().expect("a name").to_owned());
        names.collect::<Vec<_>>()
    };
    let [brdfs, diffuse] = [listed("brdf"), listed("diffuse")];
    assert!(brdfs.len() > 10 && diffuse.len() > 4, "{brdfs:?} {diffuse:?}");
    for name in brdfs.iter().filter(|name| *name != "diffuse").chain(&diffuse) {
        let ends = |line: &str| line.ends_with(&format!("={name}")) || line.ends_with(&format!("/{name}"));
        assert!(ran.text().lines().any(ends), "no `{name}` in\n{}", ran.text());
    }
}

/// Catches a sheet that takes the machine's memory, an error without its place, and a file that is there after one.
#[test]
fn what_cannot_be_shown_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.png");
    let file = file.to_str().expect("UTF-8");
    let refused = |each: &str, status, words: &[&str]| bad(&["sheet", SCENE, "--each", each, "-o", file], status, words);
    refused("materials.ball.brdf", 2, &["should be PATH=CHOICES"]);
    refused("materials.ball.brdf=[", 2, &["the list cannot be read"]);
    refused("materials.ball.brdf=[]", 1, &["nothing to choose from"]);
    refused("materials.moon.brdf=[\"ward\"]", 1, &["SW0906", "leads nowhere"]);
    refused(
        "materials.ball.brdf=\"wart\"",
        1,
        &["SW0201", "there is no module `wart`", "--> space:1:1"],
    );
    refused(
        "materials.ball.brdf=[\"wart\"]",
        1,
        &["SW0201", "there is no module `wart`", "sphere.scene.ron:10"],
    );
    refused("size[0]=[10, -1]", 1, &["sphere.scene.ron"]);
    // A pass is no BRDF.
    refused("materials.ball.brdf=\"display\"", 1, &["sphere.scene.ron:10"]);
    let many = "materials.ball.brdf=(fits: Open, of: \"material\")";
    refused(many, 1, &["are more than a sheet holds, 1024"]);
    let brdf = "materials.ball.brdf=[\"ward\"]";
    let large = ["sheet", SCENE, "--each", brdf, "--size", "16000x16000", "-o", file];
    bad(&large, 1, &["pixels is larger than", "--size"]);
    bad(&["sheet", SCENE, "--each", brdf, "-o", "a.exr"], 2, &["ends in .png"]);
    assert_eq!(names(folder.path()), Vec::<String>::new());
}
