//! Maps of a material: constant images, so that every pixel of a lit plane has a closed form.

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;
use shadewright::runtime::frame::Frame;
use shadewright::runtime::scene::SceneFile;

use crate::view::{Picture, frame, hdr, vector};

/// Illuminance of the one light, from straight above unless a test turns it, lx.
const LUX: f64 = 100.0;

/// A floor seen from above, of base colour 1 but for the map in `slot`, whose image is one colour.
fn scene(folder: &Path, slot: &str, module: &str, texel: [u8; 3], light: &str) -> SceneFile {
    let path = folder.join("map.png");
    image::RgbImage::from_pixel(4, 4, image::Rgb(texel)).save(path).expect("written");
    let text = format!(
        r#"(
            camera: (eye: (0, 3, 0), target: (0, 0, 0), up: (0, 0, -1), fov: 40, near: 0.1, far: 10), size: (32, 32), pass: "forward",
            meshes: {{"floor": Plane(size: (4, 4))}},
            materials: {{
                "mapped": {{
                    "material": (
                        module: "metalness", params: {{"base_color": (1, 1, 1), "emission": 10.0}},
                        fill: {{"{slot}": (module: "{module}", textures: {{"image": "map.png"}})}},
                    ),
                    "brdf": "lambert",
                }},
            }},
            lights: [(name: "sun", module: "directional", fields: {{"direction": {light}, "illuminance": {LUX}}})],
            objects: [(mesh: "floor", material: "mapped")],
        )"#
    );
    SceneFile::parse("maps.scene.ron", &text, folder).unwrap_or_else(|e| panic!("{e}"))
}

fn shown(slot: &str, module: &str, texel: [u8; 3], light: &str) -> (Frame, Picture) {
    let folder = tempfile::tempdir().expect("a folder");
    let frame = frame(&scene(folder.path(), slot, module, texel, light));
    let picture = hdr(&frame);
    assert_eq!(picture.bad(), 0);
    (frame, picture)
}

/// Every channel of all pixels lies in its range, widened by what f32 rounds.
#[track_caller]
fn within(picture: &Picture, ranges: [(f64, f64); 3]) {
    for (column, row) in picture.pixels() {
        let texel = picture.at(column, row);
        for (found, (low, high)) in texel.iter().zip(ranges) {
            let found = f64::from(*found);
            let fits = found >= low * (1.0 - 1e-5) && found <= high * (1.0 + 1e-5);
            assert!(fits, "{column} {row}: {texel:?}, not between {low} and {high}");
        }
    }
}

#[track_caller]
fn all(picture: &Picture, expected: f64) {
    within(picture, [(expected, expected); 3]);
}

/// sRGB to linear, IEC 61966-2-1.
fn decoded(level: f64) -> f64 {
    let c = (level / 255.0).clamp(0.0, 1.0);
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// What a driver may make of a byte: the decoded value of half a step to either side. lavapipe decodes by a polynomial, 0.36 % off at 128.
fn decodings(byte: u8, radiance: impl Fn(f64) -> f64) -> (f64, f64) {
    let level = f64::from(byte);
    (radiance(decoded(level - 0.5)), radiance(decoded(level + 0.5)))
}

/// Catches an image that is taken for linear, channels that are swapped, and a map that does not reach the albedo.
#[test]
fn a_colour_texture_is_decoded_and_scales_the_base_colour() {
    let texel = [128, 64, 250];
    let (_, picture) = shown("base_color_map", "color-texture", texel, "(0, -1, 0)");
    within(&picture, texel.map(|c| decodings(c, |albedo| albedo / PI * LUX + 10.0)));
}

/// Catches an emission map that scales something else, or is not decoded.
#[test]
fn an_emission_map_scales_the_emission() {
    let texel = [255, 100, 30];
    let (_, picture) = shown("emission_map", "color-texture", texel, "(0, -1, 0)");
    within(&picture, texel.map(|c| decodings(c, |factor| LUX / PI + 10.0 * factor)));
}

/// Catches data that is decoded as sRGB, and metalness read from another channel than blue: a metal has no diffuse part.
#[test]
fn a_data_texture_is_linear_and_blue_is_metalness() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = scene(folder.path(), "metallic_roughness_map", "data-texture", [9, 200, 51], "(0, -1, 0)");
    let params = "{\"base_color\": (1, 1, 1), \"emission\": 10.0, \"metalness\": 1.0}";
    let file = file
        .set("materials.mapped.material.params", params)
        .unwrap_or_else(|e| panic!("{e}"));
    let picture = hdr(&frame(&file));
    all(&picture, (1.0 - 51.0 / 255.0) / PI * LUX + 10.0);
}

/// Catches a normal map whose axes are swapped or mirrored, one that is not expanded from [0, 1], and one that is decoded as sRGB:
/// the light comes from a side, so that each of the three components counts.
#[test]
fn a_normal_map_turns_the_normal_in_the_frame_of_the_mesh() {
    let light = DVec3::new(-0.6, -1.0, 0.35);
    let text = format!("({}, {}, {})", light.x, light.y, light.z);
    for texel in [[128, 128, 255], [190, 128, 230], [128, 70, 230], [60, 180, 200]] {
        let (frame, picture) = shown("normal_map", "normal-map", texel, &text);
        // The frame that the mesh's data spans: the bitangent is cross(normal, tangent) times w.
        let mesh = &frame.draws[0].mesh;
        let (n, t) = (vector(mesh.normals[0]), DVec3::from_slice(&mesh.tangents[0].map(f64::from)));
        assert_eq!((n, t), (DVec3::Y, DVec3::X));
        let b = n.cross(t) * f64::from(mesh.tangents[0][3]);
        let stored = DVec3::from_array(texel.map(|c| f64::from(c) / 255.0 * 2.0 - 1.0));
        let normal = (t * stored.x + b * stored.y + n * stored.z).normalize();
        let cosine = normal.dot(-light.normalize());
        all(&picture, LUX / PI * cosine.max(0.0) + 10.0);
    }
}

/// Catches a back face whose normal looks away from the viewer, and a normal map that is turned only in part there: the relief of the back is
/// that of the front seen from behind, so the whole normal is reversed.
#[test]
fn the_back_of_a_double_sided_object_has_the_normal_of_the_front_reversed() {
    let light = DVec3::new(-0.6, -1.0, 0.35);
    let text = format!("({}, {}, {})", light.x, light.y, light.z);
    for texel in [[128, 128, 255], [190, 128, 230], [128, 70, 230], [60, 180, 200]] {
        let folder = tempfile::tempdir().expect("a folder");
        let file = scene(folder.path(), "normal_map", "normal-map", texel, &text);
        let file = ["rotate", "double_sided"]
            .into_iter()
            .zip(["(180, 0, 0)", "true"])
            .fold(file, |file, (field, value)| {
                file.set(&format!("objects[0].{field}"), value).unwrap_or_else(|e| panic!("{e}"))
            });
        let frame = frame(&file);
        let mesh = &frame.draws[0].mesh;
        // Half a turn about x: the camera sees the back.
        let turned = |v: DVec3| DVec3::new(v.x, -v.y, -v.z);
        let (n, t) = (vector(mesh.normals[0]), DVec3::from_slice(&mesh.tangents[0].map(f64::from)));
        let b = n.cross(t) * f64::from(mesh.tangents[0][3]);
        let stored = DVec3::from_array(texel.map(|c| f64::from(c) / 255.0 * 2.0 - 1.0));
        let front = turned(t * stored.x + b * stored.y + n * stored.z).normalize();
        assert!(front.y < 0.0, "the camera is above");
        let cosine = (-front).dot(-light.normalize());
        assert!(cosine > 0.1, "{cosine}: the light would say nothing");
        all(&hdr(&frame), LUX / PI * cosine + 10.0);
    }
}
