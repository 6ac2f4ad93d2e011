//! Measured luminaires from file to shader: the light module, given files, shines as they say.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use std::f64::consts::PI;
use std::path::Path;

use common::catalog;
use glam::DVec3;
use serde_json::{Value as Json, json};
use shadewright::compiler::Recipe;
use shadewright::modules::oracles::quadrature::{direction, nodes};
use shadewright::runtime::data::photometry::Photometry;
use shadewright::runtime::probe::Probe;
use shadewright::runtime::scene::SceneFile;

/// An IES file: what is said before the angles, the angles, and intensities by vertical and horizontal angle.
fn ies(kind: u32, vertical: &[i32], horizontal: &[i32], of: impl Fn(f64, f64) -> f64) -> String {
    let list = |angles: &[i32]| angles.iter().map(i32::to_string).collect::<Vec<_>>().join(" ");
    let mut text = format!(
        "IESNA:LM-63-2002\n[TEST] made by formula\nTILT=NONE\n1 -1 1 {} {} {kind} 2 0 0 0\n1 1 1\n{}\n{}\n",
        vertical.len(),
        horizontal.len(),
        list(vertical),
        list(horizontal)
    );
    for h in horizontal {
        let row: Vec<String> = vertical.iter().map(|v| of(f64::from(*v), f64::from(*h)).to_string()).collect();
        text += &(row.join(" ") + "\n");
    }
    text
}

/// Intensities that a luminaire of this file, looking along -z with x across, has in these directions: a white surface 1 m away, perpendicular
/// to the rays, divided by what it makes of 1 cd.
fn intensities(file: &Path, directions: &[DVec3]) -> Vec<f64> {
    let text = format!("(module: \"light/photometric\", files: {{\"profile\": {file:?}}})");
    let recipe = Recipe::parse("test", &text).unwrap_or_else(|report| panic!("{report}"));
    let probe = Probe::new(catalog(), &recipe, "light").unwrap_or_else(|error| panic!("{error}"));
    let rows: Vec<Json> = directions
        .iter()
        .map(|d| {
            let back = (-*d).to_array();
            let light = json!([{"position": [0, 0, 0], "direction": [0, 0, -1], "across": [1, 0, 0]}]);
            json!({"s": {"position": d.to_array(), "normal": back}, "v": back, "instances": light})
        })
        .collect();
    let table = probe.table(&rows).unwrap_or_else(|error| panic!("{error}"));
    let said = probe.answer_on_cpu::<f32>(&table).unwrap_or_else(|error| panic!("{error}"));
    let results = said["results"].as_array().unwrap();
    results
        .iter()
        .map(|result| result[0].as_f64().expect("a finite number") * PI)
        .collect()
}

/// Catches a solid angle, a pole or a seam that is wrong in the shader, and a reader and a shader that do not mean the same: what the shader sends into
/// all directions is the file's flux, to 0.1 %. The files are a downlight (IES), a wall washer (EULUMDAT) and the module's own example.
#[test]
fn the_shader_sends_the_files_flux() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for name in [
        "examples/scenes/downlight.ies",
        "examples/scenes/washer.ldt",
        "modules/light/photometric/sample.ies",
    ] {
        let file = root.join(name);
        let read = Photometry::read(&std::fs::read(&file).unwrap()).unwrap();
        // The module's -z is the pole; below the plane of the luminaire is all that these files have.
        let (mut around, mut weights) = (Vec::new(), Vec::new());
        for (theta, wt) in nodes(0.0, PI, 12) {
            for (phi, wp) in nodes(0.0, 2.0 * PI, 4) {
                let d = direction(theta, phi);
                around.push(DVec3::new(d.x, d.y, -d.z));
                weights.push(wt * wp * theta.sin());
            }
        }
        let sum: f64 = intensities(&file, &around).iter().zip(weights).map(|(i, w)| i * w).sum();
        println!("{name}: {:.2} lm by the file, {sum:.2} lm by the shader", read.flux());
        assert!((sum / read.flux() - 1.0).abs() < 1e-3, "{name}: {sum} lm, not {}", read.flux());
    }
}

/// Catches a cosine that is sampled where it should be interpolated, and a last step that is left out: 1000 cos cd, written every 5 degrees, are 3139.5974 lm by
/// the file and by the shader, which is pi 1000 lm to 0.1 %.
#[test]
fn a_cosine_keeps_its_flux() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cosine.ies");
    let steps: Vec<i32> = (0..=18).map(|k| 5 * k).collect();
    let cosine = |v: f64, _| 1000.0 * v.to_radians().cos();
    std::fs::write(&file, ies(1, &steps, &[0], cosine)).unwrap();
    let read = Photometry::read(&std::fs::read(&file).unwrap()).unwrap();
    let (mut around, mut weights) = (Vec::new(), Vec::new());
    for step in &steps[..18] {
        let from = f64::from(*step).to_radians();
        for (theta, w) in nodes(from, from + 5_f64.to_radians(), 1) {
            let d = direction(theta, 0.3);
            around.push(DVec3::new(d.x, d.y, -d.z));
            weights.push(w * 2.0 * PI * theta.sin());
        }
    }
    let sum: f64 = intensities(&file, &around).iter().zip(weights).map(|(i, w)| i * w).sum();
    println!(
        "1000 cos cd: {:.4} lm by the file, {sum:.4} lm by the shader, {:.4} lm without steps",
        read.flux(),
        1000.0 * PI
    );
    assert!((read.flux() / 3139.5974 - 1.0).abs() < 1e-6, "{}", read.flux());
    assert!((sum / 3139.5974 - 1.0).abs() < 1e-5, "{sum}");
    assert!((sum / (1000.0 * PI) - 1.0).abs() < 1e-3, "{sum}");
}

/// Catches axes of a type that are swapped or mirrored: a beam 20 degrees up and 30 to the right is there, and nowhere else.
#[test]
fn beams_go_where_their_type_says() {
    let folder = tempfile::tempdir().unwrap();
    let both: Vec<i32> = (-9..=9).map(|i| i * 10).collect();
    let (v, h) = (20f64.to_radians(), 30f64.to_radians());
    // Type A turns by H about the vertical first, type B by V about the horizontal.
    let a = DVec3::new(v.cos() * h.sin(), v.sin(), -v.cos() * h.cos());
    let b = DVec3::new(h.sin(), h.cos() * v.sin(), -h.cos() * v.cos());
    for (kind, beam) in [(3, a), (2, b)] {
        for (horizontal, left) in [(&both[..], 0.0), (&both[9..], 7.0)] {
            let file = folder.path().join("beam.ies");
            std::fs::write(
                &file,
                ies(kind, &both, horizontal, |v, h| if (v, h) == (20.0, 30.0) { 7.0 } else { 0.0 }),
            )
            .unwrap();
            let mirrored = |x: f64, y: f64, z: f64| beam * DVec3::new(x, y, z);
            let found = intensities(
                &file,
                &[beam, mirrored(-1.0, 1.0, 1.0), mirrored(1.0, -1.0, 1.0), mirrored(1.0, 1.0, -1.0)],
            );
            for (found, expected) in found.iter().zip([7.0, left, 0.0, 0.0]) {
                assert!((found - expected).abs() < 1e-4, "type {kind}: {found}, not {expected}");
            }
        }
    }
    // Type C: C 0 is across, C 90 up; and no light above what was measured.
    let file = folder.path().join("c.ies");
    std::fs::write(&file, ies(1, &[0, 30, 60, 90], &[0, 90, 180, 270], |v, c| v + c + 1.0)).unwrap();
    let at = |gamma: f64, c: f64| {
        let d = direction(gamma.to_radians(), c.to_radians());
        DVec3::new(d.x, d.y, -d.z)
    };
    let found = intensities(
        &file,
        &[at(30.0, 0.0), at(30.0, 90.0), at(60.0, 225.0), at(45.0, 315.0), at(91.0, 0.0)],
    );
    for (found, expected) in found.iter().zip([31.0, 121.0, 286.0, 181.0, 0.0]) {
        assert!((found - expected).abs() < 1e-3, "{found}, not {expected}");
    }
}

/// Catches a bad file that is taken, or refused without its line: the scene's place and the file's line are both in the error.
#[test]
fn bad_files_are_located() {
    let folder = tempfile::tempdir().unwrap();
    let good = ies(1, &[0, 45, 90], &[0], |v, _| v);
    std::fs::write(folder.path().join("bad.ies"), good.replace("0 45 90\n0\n", "0 90 45\n0\n")).unwrap();
    std::fs::write(folder.path().join("tilt.ies"), good.replace("TILT=NONE", "TILT=INCLUDE")).unwrap();
    let said = |file: &str| {
        let scene = format!(
            "(pass: \"forward\", camera: (eye: (0, 0, 1), target: (0, 0, 0)), meshes: {{\"m\": Sphere(radius: 1)}},\n\
             materials: {{\"m\": {{}}}}, objects: [(mesh: \"m\", material: \"m\")],\n\
             lights: [(module: \"photometric\", files: {{\"profile\": \"{file}\"}})])"
        );
        let parsed = SceneFile::parse("a.scene.ron", &scene, folder.path()).unwrap_or_else(|report| panic!("{report}"));
        let report = parsed.frame(catalog(), None).map(|_| ()).unwrap_err();
        report
            .render()
            .lines()
            .map(|line| format!("{}\n", line.trim_end()))
            .collect::<String>()
    };
    assert_eq!(
        said("bad.ies"),
        "error[SW0907]: the file `bad.ies` cannot be used
  --> a.scene.ron:3:53
  |
3 | lights: [(module: \"photometric\", files: {\"profile\": \"bad.ies\"})])
  |                                                     ^^^^^^^^^ line 6: a vertical angle is 45, but the one before is 90
"
    );
    assert!(said("tilt.ies").contains("line 3: `TILT=INCLUDE`: only `TILT=NONE` is taken"));
    assert!(said("gone.ies").contains("error[SW0907]"));
}
