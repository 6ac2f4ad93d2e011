use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use shadewright_compiler::{Catalog, Library};
use shadewright_runtime::scene::SceneFile;

use super::*;
use crate::document::{Document, State};
use crate::tree::rows;
use crate::work::links;

fn catalog() -> Catalog {
    Catalog::load(shadewright_modules::library()).unwrap()
}

fn scene(lights: &str, brdf: &str) -> SceneFile {
    let text = format!(
        r#"(
        camera: (eye: (0.0, 0.0, 6.0), target: (0.0, 0.0, 0.0)), pass: "forward",
        meshes: {{"ball": Sphere(radius: 1.0)}}, materials: {{"m": {{"material": "metalness", "brdf": {brdf}}}}},
        lights: [{lights}], objects: [(mesh: "ball", material: "m")],
    )"#
    );
    SceneFile::parse("test", &text, Path::new("")).unwrap()
}

/// Catches a slot that is left approximate, one that is replaced though nothing is said of it, a light that is taken for another, a metal that
/// stands for all materials, and a truth that cannot be linked.
#[test]
fn the_truth_of_a_scene_has_what_is_true_in_each_place() {
    let catalog = catalog();
    let truths = Truths::load(&catalog).unwrap();
    let lights = r#"(module: "rectangle"), (module: "sun", fill: {"disc": "widened-lobe"}), (module: "directional"), (module: "sphere", fill: {"area": "centre"})"#;
    let brdf = r#"(module: "microfacet", fill: {"masking": "hammon", "fresnel": "schlick"})"#;
    let scene = scene(lights, brdf);
    let made = reference(&scene, &catalog, &truths);
    let replaced: BTreeMap<&str, (&str, &str)> = made
        .replaced
        .iter()
        .map(|r| (r.path.as_str(), (r.from.as_str(), r.to.as_str())))
        .collect();
    let expected = BTreeMap::from([
        ("lights[0].fill.area", ("split", "reference")),
        ("lights[1].fill.disc", ("widened-lobe", "disc-reference")),
        ("lights[3].fill.area", ("centre", "reference")),
        ("materials.m.brdf.fill.diffuse", ("lambertian", "oren-nayar-full")),
        ("materials.m.brdf.fill.masking", ("hammon", "smith-ggx-correlated")),
    ]);
    assert_eq!(replaced, expected);
    assert_eq!(made.left, []);
    links(&catalog, &made.scene).unwrap();
    // Nothing is left to replace.
    for row in rows(&made.scene, &catalog, &[]).iter().filter(|row| row.is_choice()) {
        let truth = row.module.as_ref().and_then(|module| truths.of(module));
        assert!(truth.is_none(), "{} should be {}", row.path, truth.unwrap().module.name);
    }
    // All else is as it was.
    assert_eq!(made.scene.get("lights[2]"), scene.get("lights[2]"));
    assert_eq!(made.scene.get("camera"), scene.get("camera"));
}

/// Catches a truth that is put where its rules forbid it, and one that is kept from all places because it cannot stand in one.
#[test]
fn a_truth_that_is_not_legal_is_left_out_and_named() {
    // The reference of area lights must not stand in a tree with a certain distribution.
    let path = "area/reference/module.ron";
    let text = shadewright_modules::library().read(path).unwrap().unwrap();
    let rule = "(rules: [Excludes(tag: \"beckmann\", among: Tree, because: \"planted\")],";
    let library = Patched(path, text.replacen('(', rule, 1));
    let catalog = Catalog::load(Arc::new(library)).unwrap();
    let truths = Truths::load(&catalog).unwrap();
    let scene = scene(
        r#"(module: "rectangle"), (module: "sun", fill: {"disc": "widened-lobe"})"#,
        r#"(module: "microfacet", fill: {"ndf": "beckmann"})"#,
    );
    let made = reference(&scene, &catalog, &truths);
    let places = |path: &str| made.replaced.iter().any(|replaced| replaced.path == path);
    assert!(
        !places("lights[0].fill.area") && places("lights[1].fill.disc"),
        "{:?}",
        made.replaced
    );
    let [left] = made.left.as_slice() else { panic!("{:?}", made.left) };
    assert_eq!(
        (left.path.as_str(), left.module.as_str(), left.truth.as_str()),
        ("lights[0].fill.area", "split", "reference")
    );
    assert!(left.reason.contains("planted"), "{}", left.reason);
    links(&catalog, &made.scene).unwrap();
}

/// The standard library with one file changed.
struct Patched(&'static str, String);

impl Library for Patched {
    fn folders(&self, folder: &str) -> Vec<String> {
        shadewright_modules::library().folders(folder)
    }
    fn read(&self, path: &str) -> Result<Option<String>, String> {
        if path == self.0 {
            return Ok(Some(self.1.clone()));
        }
        shadewright_modules::library().read(path)
    }
    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        shadewright_modules::library().bytes(path)
    }
}

/// Catches a name that says nothing of what is different, or all of what is below it, and two of one name.
#[test]
fn pins_are_named_by_what_is_different() {
    let catalog = catalog();
    let mut document = Document::new(scene(r#"(module: "point")"#, "\"microfacet\""));
    let mut pins = Pins::default();
    let mut pin = |document: &Document| {
        let features = features(document.scene(), &rows(document.scene(), &catalog, &[]));
        let id = pins.add("start", document.state().clone(), features);
        pins.get(id).unwrap().name.clone()
    };
    let set = |document: &mut Document, path: &str, value: &str| document.edit("set", |draft| draft.set(&[], path, value)).unwrap();
    assert_eq!(pin(&document), "start");
    set(&mut document, "materials.m.brdf", "\"lambert\"");
    assert_eq!(pin(&document), "brdf lambert");
    set(&mut document, "lights[0].fields.intensity", "300.0");
    assert_eq!(pin(&document), "intensity 300.0");
    assert_eq!(pin(&document), "start again");
    set(&mut document, "camera.fov", "30.0");
    assert_eq!(pin(&document), "camera");
    set(&mut document, "camera.fov", "31.0");
    assert_eq!(pin(&document), "camera (2)");
}

/// Catches a way back that cannot be undone, that takes the file's name with it, or leaves what was switched off.
#[test]
fn going_back_to_a_pin_is_one_step() {
    let mut document = Document::new(scene(r#"(module: "point")"#, "\"microfacet\""));
    let pinned = State {
        name: "elsewhere".to_owned(),
        ..document.state().clone()
    };
    document.edit("off", |draft| draft.remove(&[], "lights", 0, true)).unwrap();
    let before = document.state().clone();
    document.replace("Go back", &pinned).unwrap();
    assert_eq!(document.state().text, pinned.text);
    assert_eq!((document.state().name.as_str(), document.state().parked.len()), ("test", 0));
    document.undo();
    assert_eq!(document.state(), &before);
    let broken = State {
        text: "(".into(),
        ..pinned
    };
    assert!(document.replace("Go back", &broken).is_err());
    assert_eq!(document.state(), &before);
}

/// Catches a camera that stays where the pin's was, or is left where the present scene's comes from a file.
#[test]
fn the_other_picture_is_seen_from_the_present_camera() {
    let (pin, present) = (
        scene("", "\"lambert\""),
        scene("", "\"microfacet\"").set("camera.fov", "77.0").unwrap(),
    );
    let seen = with_camera_of(&pin, present.get("camera")).unwrap();
    assert_eq!(seen.get("camera.fov"), Some("77.0"));
    assert_eq!(seen.get("materials.m.brdf"), Some("\"lambert\""));
    assert_eq!(with_camera_of(&pin, None).unwrap().get("camera"), None);
}

/// Catches rows and columns that are mixed up, a sign that is turned round, a scale that is not the range's, and a NaN that spoils the rest.
#[test]
fn a_heat_map_has_its_numbers() {
    let grey = |x: f32| [x, x, x, 1.0];
    let picture = |texels: [f32; 6]| Values {
        size: [3, 2],
        texels: texels.map(grey).to_vec(),
    };
    // The true mean is 2.
    let truth = picture([2.0, 2.0, 2.0, 2.0, 0.0, 4.0]);
    let found = picture([2.0, 3.0, 1.0, f32::NAN, 1.0, 4.0]);
    let truth_seen = picture([2.0; 6]);
    assert_eq!(found.at([0.5, 0.1]), Some(grey(3.0)));
    assert_eq!(found.at([0.4, 0.9]), Some(grey(1.0)));
    assert_eq!(found.at([1.0, 0.5]), None);
    let errors = Errors::of(&found, &truth).unwrap();
    let near = |a: Option<f64>, b: f64| assert!((a.unwrap() - b).abs() < 1e-6, "{a:?} {b}");
    near(errors.at([0.1, 0.1]), 0.0);
    near(errors.at([0.5, 0.1]), 0.25);
    near(errors.at([0.9, 0.1]), -0.25);
    near(errors.at([0.5, 0.9]), 0.5);
    assert!(errors.at([0.1, 0.9]).unwrap().is_nan());
    near(Some(errors.rms), ((2.0 * 0.0625 + 0.25) / 5.0_f64).sqrt());
    near(Some(errors.largest), 0.5);
    assert_eq!(errors.summary, "RMS 27.4 %, largest 50.0 %, 1 pixel not finite");
    let colours = |full: f64| errors.image(full).pixels.iter().map(|c| [c.r(), c.g(), c.b()]).collect::<Vec<_>>();
    assert_eq!(
        colours(0.25),
        [[0, 0, 0], [255, 85, 85], [85, 85, 255], [255, 0, 255], [255, 85, 85], [0, 0, 0]]
    );
    assert_eq!(colours(0.5)[1], [128, 42, 42]);
    assert!(
        Errors::of(
            &found,
            &Values {
                size: [2, 3],
                ..truth_seen
            }
        )
        .is_none()
    );
}

/// Catches a point that is beaten and stands there, or one that is as good as another and does not, and numbers that are none.
#[test]
fn the_frontier_is_what_nothing_beats() {
    let points = [
        [1.0, 5.0],
        [2.0, 3.0],
        [2.0, 4.0],
        [3.0, 3.0],
        [4.0, 0.0],
        [f64::NAN, 0.0],
        [0.5, 9.0],
        [2.0, 3.0],
    ];
    assert_eq!(frontier(&points), [6, 0, 1, 7, 4]);
    assert_eq!(frontier(&[]), [0; 0]);
}
