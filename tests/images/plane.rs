//! A matte plane under a point light: every pixel has a closed form.

use std::f64::consts::PI;

use glam::DVec3;
use shadewright::compiler::manifest::Value;
use shadewright::runtime::image::decode_exr;
use shadewright::runtime::scene::SceneFile;

use crate::support::good;
use crate::view::{Picture, Pinhole, example, picture, read, set};
use shadewright::modules::oracles::lights::{Point, point_illuminance};

const SCENE: &str = "lambert-plane.scene.ron";

/// The one light of the scene.
fn lamp(file: &SceneFile) -> Point {
    let fields = &file.scene().lights[0].fields;
    let Value::List(at) = &fields["position"] else {
        panic!("no position")
    };
    assert_eq!(fields["intensity"], Value::Text("100 cd".to_owned()));
    Point {
        position: DVec3::from_slice(at),
        intensity: 100.0,
        range: 0.0,
        size: 0.01,
    }
}

/// What the pixel must show; `None` where its ray misses the plane.
fn closed_form(file: &SceneFile, column: u32, row: u32) -> Option<f64> {
    let camera = Pinhole::of(file);
    let ray = camera.ray(column, row);
    let at = camera.eye - ray * (camera.eye.y / ray.y);
    let albedo = 0.5;
    (ray.y < 0.0 && at.x.abs().max(at.z.abs()) < 4.0).then(|| albedo / PI * point_illuminance(&lamp(file), at, DVec3::Y))
}

/// The largest relative error of a picture at these pixels, and how many of them show the plane.
fn error(file: &SceneFile, picture: &Picture, pixels: impl Iterator<Item = (u32, u32)>) -> (f64, usize) {
    let errors: Vec<f64> = pixels
        .filter_map(|(column, row)| {
            let expected = closed_form(file, column, row)?;
            let [r, g, b, a] = picture.at(column, row);
            assert!(r == g && g == b && a == 1.0, "{column} {row}: {:?}", picture.at(column, row));
            Some((f64::from(r) / expected - 1.0).abs())
        })
        .collect();
    (errors.iter().fold(0.0, |a, b| f64::max(a, *b)), errors.len())
}

/// Catches a wrong unit, a lost pi or cosine, a falloff that is no inverse square, a camera that is off by half a pixel, and rows or columns
/// that are mirrored (the light is off the axis): at all pixels, corners among them.
#[test]
fn all_pixels_are_the_closed_form() {
    let file = read(SCENE);
    let picture = picture(&file);
    let (error, count) = error(&file, &picture, picture.pixels());
    assert_eq!(count, 128 * 128);
    println!("plane from above: largest relative error {error:.2e} of {count} pixels");
    assert!(error < 1e-4, "{error}");
}

/// Catches what only shows far off the axis: an interpolation without perspective, a cosine that is clamped, a light that fades out. The plane
/// is seen and lit along itself, from the light's foot to 4 m beside it, where n.l is 0.05.
#[test]
fn grazing_pixels_are_the_closed_form() {
    let file = set(
        &read(SCENE),
        &[
            (
                "camera",
                "(eye: (-3.9, 0.25, 3.0), target: (0.5, 0.1, -0.5), fov: 50.0, near: 0.1, far: 20.0)",
            ),
            ("lights[lamp].fields.position", "(0.5, 0.2, -0.25)"),
            ("size", "(192, 96)"),
        ],
    );
    let picture = picture(&file);
    let (error, count) = error(&file, &picture, picture.pixels());
    println!("plane along itself: largest relative error {error:.2e} of {count} pixels");
    assert!(count > 4000, "{count}");
    assert!(error < 1e-4, "{error}");
}

/// Catches an EXR that is not the linear frame (exposed, encoded, half floats, turned upside down): the command's file, at 64 pixels that lie in
/// the picture's corners and in a grid between them.
#[test]
fn the_commands_exr_is_the_closed_form() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("plane.exr");
    good(&[
        "render",
        example(SCENE).to_str().expect("UTF-8"),
        "-o",
        path.to_str().expect("UTF-8"),
    ]);
    let image = decode_exr(&std::fs::read(&path).expect("written")).expect("an EXR");
    let picture = Picture {
        size: [image.width, image.height],
        texels: image.texels,
    };
    assert_eq!((picture.size, picture.bad()), ([128, 128], 0));
    let steps = [0, 1, 30, 49, 71, 93, 126, 127];
    let pixels = steps.iter().flat_map(|row| steps.iter().map(|column| (*column, *row)));
    let (error, count) = error(&read(SCENE), &picture, pixels);
    println!("plane in the EXR: largest relative error {error:.2e} of {count} pixels");
    assert_eq!(count, 64);
    assert!(error < 1e-4, "{error}");
}
