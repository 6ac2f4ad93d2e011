//! The commands that compute on a GPU: probe and render.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use serde_json::Value;
use support::{Ran, bad, finish, good, names, run_with_input, shadewright};

/// Runs the command where no driver answers: no Vulkan driver is found, and wgpu looks for no other.
fn without_driver(arguments: &[&str]) -> Ran {
    let mut command = shadewright();
    for variable in ["VK_ICD_FILENAMES", "VK_DRIVER_FILES", "VK_ADD_DRIVER_FILES"] {
        command.env(variable, "/nonexistent");
    }
    finish(command.env("WGPU_BACKEND", "vulkan").args(arguments))
}

/// A file in a folder, with this text; its path.
fn file(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("written");
    path.to_str().expect("UTF-8").to_owned()
}

fn floats(value: &Value) -> Vec<f64> {
    let list = value.as_array().unwrap_or_else(|| panic!("no list: {value}"));
    list.iter().map(|item| item.as_f64().expect("a number")).collect()
}

const STRAIGHT: &str = r#"[{"s": {"diffuse": [1, 0.5, 0.25]}, "v": [0, 0, 1], "l": [0, 0, 1]}, {"v": [0, 0, 1], "l": [0, 0, 1]}]"#;

/// Catches rows that change places, defaults of struct members that do not arrive, and numbers that don't bring back the same f32.
#[test]
fn probe_gives_results_in_order() {
    let ran = run_with_input(&["probe", "lambert", "brdf", "--inputs", "-"], STRAIGHT);
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
    let json = ran.json();
    assert_eq!(json["function"], "brdf");
    assert!(json["device"].as_str().is_some_and(|device| !device.is_empty()));
    let inv_pi = std::f64::consts::FRAC_1_PI;
    for (row, expected) in [[inv_pi, inv_pi / 2.0, inv_pi / 4.0], [inv_pi / 2.0; 3]].iter().enumerate() {
        for (value, expected) in floats(&json["results"][row]).iter().zip(expected) {
            assert!((value - expected).abs() < 1e-7, "row {row}: {value} instead of {expected}");
        }
    }
    assert!(
        ran.text().contains("0.31830987\n") || ran.text().contains("0.31830987,"),
        "{}",
        ran.text()
    );
}

/// Catches a subtree's fillings or a row's parameters that are ignored.
#[test]
fn probe_takes_trees_and_parameters() {
    let folder = tempfile::tempdir().expect("a folder");
    let inputs = file(
        folder.path(),
        "in.json",
        r#"[{"params": {"ev100": 3}}, {"params": {"ev100": 4}}, {}]"#,
    );
    let json = good(&["probe", "manual", "exposure", "--inputs", &inputs]).json();
    let factors = floats(&json["results"]);
    assert!((factors[0] / factors[1] - 2.0).abs() < 1e-5, "{factors:?}");
    assert!((factors[1] / factors[2] - 256.0).abs() < 1e-2, "{factors:?}");

    let inputs = file(
        folder.path(),
        "glossy.json",
        r#"[{"s": {"alpha": 0.25}, "v": [0, 0, 1], "l": [0, 0, 1]}]"#,
    );
    let recipe = r#"(module: "microfacet", fill: {"ndf": "ggx"})"#;
    let json = good(&["probe", recipe, "brdf", "--inputs", &inputs]).json();
    // D = 1 / (pi alpha^2), V = 1/4, F = 0.04, and the diffuse base, at most 0.5 / pi.
    let specular = 0.04 / (4.0 * std::f64::consts::PI * 0.0625);
    for value in floats(&json["results"][0]) {
        assert!(value > specular && value < specular + 0.16, "{value}, of which specular {specular}");
    }
}

/// Catches tables in CSV that say something else than the same in JSON.
#[test]
fn probe_reads_csv() {
    let folder = tempfile::tempdir().expect("a folder");
    let csv = "s.diffuse,v,l\n\"[1, 0.5, 0.25]\",\"[0, 0, 1]\",\"[0, 0, 1]\"\n,\"[0, 0, 1]\",\"[0, 0, 1]\"\n";
    let csv = file(folder.path(), "in.csv", csv);
    let json = file(folder.path(), "in.json", STRAIGHT);
    let of = |inputs: &str| good(&["probe", "lambert", "brdf", "--inputs", inputs]).text().to_owned();
    assert_eq!(of(&csv), of(&json));
}

/// Catches bad rows that are taken for others, and errors without their place.
#[test]
fn probe_refuses_bad_rows() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = file(folder.path(), "out.json", "old");
    let cases = [
        ("not json", "should be a JSON list"),
        ("{}", "should be a JSON list"),
        ("[3]", "[0]"),
        (r#"[{"v": [0, 0, 1], "l": [0, 0, 1], "k": 1}]"#, "`k`"),
        (r#"[{"v": [0, 0, 1]}]"#, "`l`"),
        (r#"[{"v": [0, 0], "l": [0, 0, 1]}]"#, "[0].v"),
        (r#"[{"v": [0, 0, 1], "l": [0, 0, 1], "s": {"alfa": 1}}]"#, "alfa"),
    ];
    for (text, words) in cases {
        let inputs = file(folder.path(), "in.json", text);
        bad(&["probe", "lambert", "brdf", "--inputs", &inputs, "-o", &out], 1, &[words]);
    }
    let inputs = file(folder.path(), "in.json", STRAIGHT);
    bad(&["probe", "lambert", "brdff", "--inputs", &inputs], 1, &["SW0213", "brdf"]);
    bad(&["probe", "lambrt", "brdf", "--inputs", &inputs], 1, &["SW0201"]);
    bad(&["probe", "lambert", "brdf", "--inputs", "absent.json"], 1, &["absent.json"]);
    bad(&["probe", "-", "brdf", "--inputs", "-"], 2, &["standard input"]);
    bad(&["probe", "lambert", "brdf"], 2, &["--inputs"]);
    assert_eq!(std::fs::read_to_string(&out).unwrap(), "old");
    good(&["probe", "lambert", "brdf", "--inputs", &inputs, "-o", &out]);
    assert_eq!(
        serde_json::from_str::<Value>(&std::fs::read_to_string(&out).unwrap()).unwrap()["function"],
        "brdf"
    );
    assert_eq!(names(folder.path()), ["in.json", "out.json"]);
}

/// Catches a missing driver that panics, is taken for bad input, or whose message doesn't say what to install.
#[test]
fn without_a_driver_is_status_3() {
    let folder = tempfile::tempdir().expect("a folder");
    let inputs = file(folder.path(), "in.json", STRAIGHT);
    let ran = without_driver(&["probe", "lambert", "brdf", "--inputs", &inputs]);
    assert_eq!(ran.status, 3, "{}", ran.err);
    assert!(ran.err.contains("mesa-vulkan-drivers"), "{}", ran.err);
    let ran = without_driver(&["probe", "lambert", "brdf", "--inputs", &inputs, "--format", "json"]);
    assert_eq!(serde_json::from_str::<Value>(&ran.err).expect("JSON")["status"], 3);
    // Bad input is still bad input.
    let ran = without_driver(&["probe", "lambrt", "brdf", "--inputs", &inputs]);
    assert_eq!(ran.status, 1, "{}", ran.err);

    let scene = file(folder.path(), "a.scene.ron", SCENE);
    let picture = file(folder.path(), "a.png", "old");
    let ran = without_driver(&["render", &scene, "-o", &picture]);
    assert_eq!(ran.status, 3, "{}", ran.err);
    assert_eq!(std::fs::read_to_string(&picture).unwrap(), "old");
    // What needs no GPU asks for none.
    assert_eq!(without_driver(&["check", &scene]).status, 0);
    assert_eq!(without_driver(&["emit", support::MATTE]).status, 0);
}

/// A matte plane that fills the view, straight below a distant light: it reflects albedo / pi times the illuminance.
const SCENE: &str = r#"(
    camera: (eye: (0.0, 2.0, 0.0), target: (0.0, 0.0, 0.0), up: (0.0, 0.0, -1.0), fov: 30.0),
    size: (24, 16),
    pass: "forward",
    display: "display",
    post: [(module: "tonemap", fill: {"exposure": (module: "manual", params: {"ev100": 9.0})})],
    meshes: {"ground": Plane(size: (10.0, 10.0))},
    materials: {
        "paper": {"material": (module: "metalness", params: {"base_color": (0.5, 0.5, 0.5), "reflectance": 0.0}), "brdf": "lambert"},
    },
    lights: [(name: "sun", module: "directional", fields: {"direction": (0.0, -1.0, 0.0), "illuminance": 1000.0})],
    objects: [(mesh: "ground", material: "paper")],
)
"#;

/// Radiance of the plane, cd/m2.
const PLANE: f32 = 0.5 * 1000.0 * std::f32::consts::FRAC_1_PI;

/// Size and all pixels of an EXR file.
fn exr(path: &str) -> (usize, usize, Vec<[f32; 3]>) {
    let image = exr::prelude::read_first_rgba_layer_from_file(
        path,
        |size, _| (size.0, size.1, vec![[0.0; 3]; size.0 * size.1]),
        |image, at, (r, g, b, _): (f32, f32, f32, f32)| image.2[at.y() * image.0 + at.x()] = [r, g, b],
    );
    image.expect("an EXR file").layer_data.channel_data.pixels
}

/// Catches an EXR that is not the linear frame in cd/m2, a PNG that is, and sizes that turn or are ignored.
#[test]
fn render_writes_png_and_exr() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(folder.path(), "a.scene.ron", SCENE);
    let (png, hdr) = (file(folder.path(), "a.png", "old"), folder.path().join("a.exr"));
    let hdr = hdr.to_str().unwrap();
    assert_eq!(good(&["render", &scene, "-o", &png]).text(), "");
    let picture = image::open(&png).expect("a PNG file").to_rgb8();
    assert_eq!(picture.dimensions(), (24, 16));
    assert!(
        picture.pixels().all(|p| p.0.iter().all(|c| (60..220).contains(c))),
        "{:?}",
        picture.get_pixel(12, 8)
    );

    good(&["render", &scene, "-o", hdr, "--size", "10x20", "--view", "beauty"]);
    let (width, height, pixels) = exr(hdr);
    assert_eq!((width, height), (10, 20));
    for pixel in pixels {
        assert!(pixel.iter().all(|c| (c / PLANE - 1.0).abs() < 1e-4), "{pixel:?} instead of {PLANE}");
    }
    assert_eq!(names(folder.path()), ["a.exr", "a.png", "a.scene.ron"]);
}

/// Catches a `--set` that changes nothing or another value, and a scene from standard input that is not read.
#[test]
fn set_changes_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(folder.path(), "a.scene.ron", SCENE);
    let hdr = folder.path().join("a.exr");
    let hdr = hdr.to_str().unwrap();
    let sets = ["--set", "lights[sun].fields.illuminance=2000", "--set", "size=(8, 8)"];
    good(&[&["render", &scene, "-o", hdr][..], &sets[..]].concat());
    let (width, height, pixels) = exr(hdr);
    assert_eq!((width, height), (8, 8));
    assert!((pixels[20][1] / (2.0 * PLANE) - 1.0).abs() < 1e-4, "{:?}", pixels[20]);
    let ran = run_with_input(&["render", "-", "-o", hdr, "--size", "4x4"], SCENE);
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
    assert!((exr(hdr).2[5][1] / PLANE - 1.0).abs() < 1e-4);
    bad(
        &["render", &scene, "-o", hdr, "--set", "lights[moon].fields.illuminance=1"],
        1,
        &["leads nowhere"],
    );
    bad(&["render", &scene, "-o", hdr, "--set", "size"], 2, &["PATH=VALUE"]);
}

/// Catches scenes that are wrong and drawn, and failures that spoil the picture that was there.
#[test]
fn bad_scenes_draw_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let good_scene = file(folder.path(), "good.scene.ron", SCENE);
    let picture = file(folder.path(), "a.png", "old");
    let wrong = [
        (SCENE.replace("\"lambert\"", "\"lambrt\""), "SW0201"),
        (SCENE.replace("size: (24", "sice: (24"), "SW0102"),
        (SCENE.replace("material: \"paper\"", "material: \"papyrus\""), "papyrus"),
        (SCENE.replace("illuminance\": 1000.0", "illuminance\": -1.0"), "SW0302"),
        ("(".to_owned(), "SW0101"),
    ];
    for (text, words) in wrong {
        let scene = file(folder.path(), "bad.scene.ron", &text);
        bad(&["render", &scene, "-o", &picture], 1, &[words]);
        let checked = support::run(&["check", &scene]);
        assert_eq!(checked.status, 1, "{words}: {}{}", checked.text(), checked.err);
        assert!(checked.err.contains(words), "no `{words}` in\n{}", checked.err);
    }
    for size in ["0x4", "4", "x", "4x4x4", "-1x4", "1000000x1000000"] {
        let ran = support::run(&["render", &good_scene, "-o", &picture, &format!("--size={size}")]);
        assert!(ran.status == 1 || ran.status == 2, "{size}: {} {}", ran.status, ran.err);
    }
    bad(&["render", &good_scene], 2, &["-o"]);
    bad(&["render", &good_scene, "-o", "a.gif"], 2, &["a.gif"]);
    bad(&["render", "absent.scene.ron", "-o", &picture], 1, &["absent.scene.ron"]);
    bad(&["render", &good_scene, "-o", "/nonexistent/a.png"], 1, &["/nonexistent/a.png"]);
    assert_eq!(std::fs::read_to_string(&picture).unwrap(), "old");
    assert_eq!(names(folder.path()), ["a.png", "bad.scene.ron", "good.scene.ron"]);
}

/// Catches a list of needs that opens a device, that depends on the number of threads, or whose rows cannot be compiled.
#[test]
fn needs_are_listed_without_a_driver() {
    let scene = "examples/scenes/first.scene.ron";
    let json = without_driver(&["render", scene, "--needs", "--format", "json"]);
    assert_eq!((json.status, json.err.as_str()), (0, ""));
    let rows = json.json();
    let rows = rows.as_array().expect("a list");
    let stages: Vec<&str> = rows.iter().map(|row| row["stage"].as_str().expect("a stage")).collect();
    for stage in ["shadow_map", "scene", "display"] {
        assert!(stages.contains(&stage), "no {stage} in {stages:?}");
    }
    let display = &rows[stages.iter().position(|s| *s == "display").expect("a display pass")];
    assert_eq!(display["state"]["render"]["color"], "rgba8unorm");
    for row in rows {
        let [recipe, pass] = ["recipe", "pass"].map(|field| row[field].as_str().expect("a string"));
        assert_eq!(
            good(&["emit", recipe, "--pass", pass, "--format", "json"]).json()["hash"],
            row["hash"]
        );
    }
    let text = without_driver(&["render", scene, "--needs"]);
    let last = text.text().trim_end().lines().last().expect("lines").to_owned();
    assert!(last.starts_with(&format!("{} needs, ", rows.len())), "{last}");
    let one = finish(shadewright().env("RAYON_NUM_THREADS", "1").args(["render", scene, "--needs"]));
    assert_eq!(one.text(), text.text());
    bad(&["render", scene], 2, &["-o <FILE>"]);
    bad(&["render", scene, "--needs", "-o", "a.png"], 2, &["--needs"]);
}

/// Catches a pass that is left out, shares that are not of the whole, a picture that is not drawn or is another one, and a software driver
/// that passes for a GPU.
#[test]
fn timings_are_told_for_each_pass() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = file(folder.path(), "a.scene.ron", SCENE);
    let [plain, timed] = ["plain.png", "timed.png"].map(|name| folder.path().join(name));
    good(&["render", &scene, "-o", plain.to_str().unwrap()]);
    let json = good(&["render", &scene, "--timings=3", "-o", timed.to_str().unwrap(), "--format", "json"]).json();
    assert_eq!(std::fs::read(&plain).unwrap(), std::fs::read(&timed).unwrap());
    assert_eq!((&json["frames"], &json["size"]), (&3.into(), &serde_json::json!([24, 16])));
    let passes = json["passes"].as_array().expect("a list");
    let names: Vec<&str> = passes.iter().map(|pass| pass["name"].as_str().expect("a name")).collect();
    assert_eq!(names, ["scene (forward)", "display (display)"]);
    let number = |of: &Value, name: &str| of[name].as_f64().unwrap_or_else(|| panic!("{of} has no {name}"));
    for times in passes.iter().chain([&json["frame"]]) {
        let [p10, median, p90] = ["p10", "median", "p90"].map(|name| number(times, name));
        assert!(0.0 < p10 && p10 <= median && median <= p90 && p90 < 1e10, "{times}");
    }
    let shares: f64 = passes.iter().map(|pass| number(pass, "share")).sum();
    assert!((shares - 1.0).abs() < 1e-9, "{json}");
    assert!(number(&json["cpu"][0], "link") > number(&json["cpu"][1], "link"), "{json}");

    let text = good(&["render", &scene, "--timings"]);
    let text = text.text();
    assert!(text.contains(", 24x16, 8 frames after the first\n"), "{text}");
    assert!(text.contains("\nscene (forward) ") && text.contains("\nall passes "), "{text}");
    let software = "This device is a CPU that runs a driver in software: these are not a GPU's times";
    assert_eq!(text.contains(software), json["is_software"] == true, "{text}");
    bad(&["render", &scene, "--timings=0"], 2, &["1..=1000"]);
    bad(&["render", &scene, "--timings=many"], 2, &["many"]);
    bad(&["render", &scene, "--timings", "--needs"], 2, &["--needs"]);
}
