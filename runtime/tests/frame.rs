//! Frames of the standard library, from recipes to pixels.

#![allow(clippy::unwrap_used)]

use std::sync::{Arc, LazyLock};

use glam::{Mat4, Vec3};
use indexmap::IndexMap;
use shadewright_compiler::manifest::{Filling, Node, Value};
use shadewright_compiler::{Catalog, Recipe};
use shadewright_modules::{Folder, Overlay};
use shadewright_runtime::frame::{Bounds, Camera, Draw, Frame, Lights, Material, Mesh, Renderer, Settings, Texture};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::SceneFile;

static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap());
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::load(shadewright_modules::library()).unwrap()));

const SIDE: u32 = 64;
/// Half of what the camera sees, m.
const HALF: f32 = 4.0;

fn recipe(text: &str) -> Node {
    Recipe::parse("test", text).unwrap().root
}

fn material(text: &str) -> Material {
    Material {
        recipe: Arc::new(recipe(text)),
        settings: Settings::default(),
    }
}

fn numbers(fields: &[(&str, Value)]) -> IndexMap<String, Value> {
    fields.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect()
}

fn vector(v: Vec3) -> Value {
    Value::List(v.to_array().map(f64::from).to_vec())
}

/// The lights of the first material's list, in its order.
fn lights(of: &Material, instances: Vec<Vec<IndexMap<String, Value>>>) -> Vec<Lights> {
    let Some(Filling::Many(nodes)) = of.recipe.fill.get("lights") else {
        panic!("no list of lights")
    };
    assert_eq!(nodes.len(), instances.len());
    let pairs = nodes.iter().cloned().zip(instances);
    pairs.map(|(node, instances)| Lights { node, instances }).collect()
}

/// A horizontal square that faces up, `half` to each side, with u along x and v along z.
fn square(half: f32) -> Arc<Mesh> {
    let corner = |x: f32, z: f32| [x * half, 0.0, z * half];
    Arc::new(Mesh {
        positions: vec![corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, -1.0)],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        uvs: vec![[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
    })
}

fn draw(mesh: &Arc<Mesh>, at: Vec3) -> Draw {
    Draw {
        mesh: Arc::clone(mesh),
        material: 0,
        model: Mat4::from_translation(at),
        bounds: Bounds::of(mesh.positions.iter().map(|p| Vec3::from_array(*p))).unwrap(),
        visible: true,
        alpha_blend: false,
        double_sided: false,
        casts_shadow: true,
    }
}

/// Seen straight from above: x to the right, z down.
fn frame(material: Material, lights: Vec<Lights>, draws: Vec<Draw>) -> Frame {
    Frame {
        camera: Camera {
            view: glam::camera::rh::view::look_at_mat4(Vec3::new(0.0, 10.0, 0.0), Vec3::ZERO, Vec3::NEG_Z),
            projection: glam::camera::rh::proj::directx::orthographic(-HALF, HALF, -HALF, HALF, 0.1, 100.0),
        },
        size: [SIDE, SIDE],
        time: 0.0,
        background: Vec3::ZERO,
        materials: vec![material],
        draws,
        lights,
        display: None,
    }
}

fn hdr(frame: &Frame) -> Vec<[f32; 4]> {
    hdr_with(&CATALOG, frame)
}

fn hdr_with(catalog: &Arc<Catalog>, frame: &Frame) -> Vec<[f32; 4]> {
    let mut renderer = Renderer::new(&GPU, Arc::clone(catalog));
    let image = renderer.render(frame).unwrap().read_hdr(&GPU).unwrap();
    assert!(image.iter().flatten().all(|v| v.is_finite()), "NaN or infinite");
    image
}

/// Centre of a texel on the ground.
fn place(column: u32, row: u32) -> Vec3 {
    let at = |i: u32| ((i as f32 + 0.5) / SIDE as f32 * 2.0 - 1.0) * HALF;
    Vec3::new(at(column), 0.0, at(row))
}

fn texel(image: &[[f32; 4]], x: f32, z: f32) -> [f32; 4] {
    let at = |v: f32| ((v / HALF + 1.0) * 0.5 * SIDE as f32) as usize;
    image[at(z) * SIDE as usize + at(x)]
}

const LIT: &str = r#"(module: "forward", fill: {"brdf": "lambert", "lights": ["point"]})"#;
const SHADOWED: &str = r#"(module: "forward", fill: {"brdf": "lambert", "lights": [
    (module: "point", fill: {"visibility": "cube-map"}),
    (module: "directional", fill: {"visibility": (module: "perspective", fill: {"filtering": "pcf"})}),
]})"#;

fn point(position: Vec3, candela: f64) -> IndexMap<String, Value> {
    numbers(&[("position", vector(position)), ("intensity", Value::Number(candela))])
}

fn sun(direction: Vec3, lux: f64) -> IndexMap<String, Value> {
    numbers(&[("direction", vector(direction)), ("illuminance", Value::Number(lux))])
}

/// Catches a wrong unit, a lost factor of pi, parameters or lights that do not arrive: the plane is known in closed form.
#[test]
fn lambert_plane_under_a_point_light_is_the_closed_form() {
    let mut material = material(LIT);
    let albedo = [0.5, 0.25, 0.125];
    let values = numbers(&[("base_color", Value::List(albedo.to_vec())), ("reflectance", Value::Number(0.0))]);
    material.settings.params.insert("main.material".into(), values);
    let position = Vec3::new(0.5, 2.0, -0.25);
    let lights = lights(&material, vec![vec![point(position, 750.0)]]);
    let image = hdr(&frame(material, lights, vec![draw(&square(5.0), Vec3::ZERO)]));
    for row in 0..SIDE {
        for column in 0..SIDE {
            let to_light = (position - place(column, row)).as_dvec3();
            let illuminance = 750.0 * to_light.y / to_light.length().powi(3);
            for (channel, albedo) in albedo.iter().enumerate() {
                let expected = albedo / std::f64::consts::PI * illuminance;
                let found = f64::from(image[(row * SIDE + column) as usize][channel]);
                assert!(
                    (found / expected - 1.0).abs() < 1e-4,
                    "{column} {row} {channel}: {found}, not {expected}"
                );
            }
        }
    }
}

/// Catches normals that are carried by the model matrix itself: a stretched object is not lit by its stretched normal.
#[test]
fn normals_of_a_stretched_object_are_perpendicular_to_it() {
    let material = material(r#"(module: "forward", fill: {"brdf": "lambert", "lights": ["directional"]})"#);
    let lights = lights(&material, vec![vec![sun(Vec3::NEG_Y, 100.0)]]);
    let model = Mat4::from_scale(Vec3::new(1.0, 3.0, 1.0)) * Mat4::from_rotation_z(0.5);
    let normal = model.transform_vector3(Vec3::Z).cross(model.transform_vector3(Vec3::X)).normalize();
    let tilted = Draw {
        model,
        ..draw(&square(2.0), Vec3::ZERO)
    };
    let found = texel(&hdr(&frame(material, lights, vec![tilted])), 0.1, 0.1)[0];
    let expected = 0.8 / std::f32::consts::PI * 100.0 * normal.y;
    assert!((found / expected - 1.0).abs() < 1e-4, "{found}, not {expected}");
}

/// Share of a square tile's edge distance at which a ground point's ray toward a light passes the tile's plane: below 1 it hits.
fn passes_tile(ground: Vec3, toward: Vec3, tile: Vec3, half: f32) -> f32 {
    let at = ground + toward * (tile.y / toward.y) - tile;
    at.x.abs().max(at.z.abs()) / half
}

/// Catches shadows that are missing, mirrored, in the wrong layer, cast by what does not cast, or that fall everywhere:
/// what each light gives to each texel of the ground is known.
#[test]
fn shadows_fall_where_geometry_says() {
    let material = material(SHADOWED);
    let lamps = [
        (Vec3::new(0.0, 3.0, 0.0), 900.0),
        (Vec3::new(0.0, 3.0, 3.5), 500.0),
        (Vec3::new(-2.0, 4.0, 3.0), 200.0),
    ];
    let suns = [(Vec3::new(-1.0, -1.0, 0.0), 50.0), (Vec3::new(0.0, -1.0, -1.2), 70.0)];
    let kinds = vec![
        lamps.map(|(at, cd)| point(at, cd)).to_vec(),
        suns.map(|(to, lux)| sun(to, lux)).to_vec(),
    ];
    let lights = lights(&material, kinds);
    let (tile, half) = (Vec3::new(1.0, 1.5, 0.5), 0.5);
    let draws = vec![draw(&square(6.0), Vec3::ZERO), draw(&square(half), tile)];
    let mut scene = frame(material, lights, draws);
    for casts in [true, false] {
        scene.draws[1].casts_shadow = casts;
        let image = hdr(&scene);
        let (mut compared, mut dark) = (0, [0; 5]);
        for (index, texel) in image.iter().enumerate() {
            let ground = place(index as u32 % SIDE, index as u32 / SIDE);
            let lamp = lamps.map(|(at, cd)| (at - ground, cd / f64::from((at - ground).length_squared())));
            let all = [lamp[0], lamp[1], lamp[2], (-suns[0].0, suns[0].1), (-suns[1].0, suns[1].1)];
            let edges = all.map(|(toward, _)| passes_tile(ground, toward, tile, half));
            // Texels of edges are neither lit nor dark, and the tile hides some of the ground.
            if edges.iter().any(|e| (0.8..1.2).contains(e)) || passes_tile(ground, Vec3::Y, tile, half) < 1.2 {
                continue;
            }
            let lit = edges.map(|e| e > 1.0 || !casts);
            let parts = all.map(|(toward, lux)| lux * f64::from(toward.y / toward.length()));
            let sum: f64 = parts.iter().zip(lit).filter(|(_, lit)| *lit).map(|(part, _)| part).sum();
            let expected = 0.8 / std::f64::consts::PI * sum;
            let found = f64::from(texel[0]);
            assert!(
                (found / expected - 1.0).abs() < 1e-3,
                "{ground}: {found}, not {expected}, lit by {lit:?}"
            );
            compared += 1;
            for (count, lit) in dark.iter_mut().zip(lit) {
                *count += usize::from(!lit);
            }
        }
        assert!(
            compared > 2000 && dark.iter().all(|n| (*n > 20) == casts),
            "{compared} texels, {dark:?} in shadow"
        );
    }
}

/// Catches two kinds of lights that share a shadow map because their visibility modules are equal: index 0 of one would
/// look into the views of the other. The second kind is a copy of the first under another name, found by its folder alone.
#[test]
fn equal_visibility_below_two_kinds_of_light_has_a_map_each() {
    let folder = tempfile::tempdir().unwrap();
    let bulb = folder.path().join("light/bulb");
    std::fs::create_dir_all(&bulb).unwrap();
    for (from, to) in [("module.ron", "module.ron"), ("point.wgsl", "bulb.wgsl")] {
        let text = shadewright_modules::library()
            .read(&format!("light/point/{from}"))
            .unwrap()
            .unwrap();
        std::fs::write(bulb.join(to), text).unwrap();
    }
    let library = Overlay(vec![Arc::new(Folder::new(folder.path())), shadewright_modules::library()]);
    let catalog = Arc::new(Catalog::load(Arc::new(library)).unwrap());
    let material = material(
        r#"(module: "forward", fill: {"brdf": "lambert", "lights": [
            (module: "point", fill: {"visibility": "cube-map"}), (module: "bulb", fill: {"visibility": "cube-map"}),
        ]})"#,
    );
    let (lamp, bulb) = (Vec3::new(0.0, 3.0, 0.0), Vec3::new(3.0, 3.0, 0.0));
    let lights = lights(&material, vec![vec![point(lamp, 900.0)], vec![point(bulb, 500.0)]]);
    let tile = draw(&square(0.5), Vec3::new(1.0, 1.5, 0.0));
    let image = hdr_with(&catalog, &frame(material, lights, vec![draw(&square(6.0), Vec3::ZERO), tile]));
    let lux = |from: Vec3, cd: f32, at: Vec3| cd * from.y / (from - at).length().powi(3);
    for (column, lit_by_lamp, lit_by_bulb) in [(48, false, true), (24, true, false), (10, true, true)] {
        let ground = place(column, 32);
        let sum = f32::from(u8::from(lit_by_lamp)) * lux(lamp, 900.0, ground) + f32::from(u8::from(lit_by_bulb)) * lux(bulb, 500.0, ground);
        let (found, expected) = (image[(32 * SIDE + column) as usize][0], 0.8 / std::f32::consts::PI * sum);
        assert!((found / expected - 1.0).abs() < 1e-3, "{ground}: {found}, not {expected}");
    }
}

/// Catches an exposure that reads nothing or another buffer than its passes wrote, and an image that is encoded twice.
#[test]
fn log_average_exposes_the_mean_to_the_key() {
    let mut material = material(r#""forward""#);
    let values = numbers(&[("emission", Value::Number(300.0)), ("base_color", vector(Vec3::ZERO))]);
    material.settings.params.insert("main.material".into(), values);
    let mut scene = frame(material, vec![], vec![draw(&square(5.0), Vec3::ZERO)]);
    let post = r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": "log-average", "curve": "reinhard"})]})"#;
    scene.display = Some(Material {
        recipe: Arc::new(recipe(post)),
        settings: Settings::default(),
    });
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    for _ in 0..2 {
        let targets = renderer.render(&scene).unwrap();
        assert!(targets.read_hdr(&GPU).unwrap().iter().all(|t| t[..3] == [300.0; 3]));
        let image = targets.read_display(&GPU).unwrap().unwrap();
        assert_eq!(image[..4], image[image.len() - 4..], "even");
        let encoded = f64::from(image[0]) / 255.0;
        let linear = ((encoded + 0.055) / 1.055).powf(2.4);
        // Reinhard's curve of the key, in its plain or its extended form: .18 / 1.18 = .1525 and a little more.
        assert!((0.15..0.16).contains(&linear), "{linear}");
        scene.draws[0].model = Mat4::from_translation(Vec3::new(0.0, 0.5, 0.0));
    }
}

/// Catches a texture that does not reach its module, is not decoded, or is upside down.
#[test]
fn textures_belong_to_their_place() {
    let text = r#"(module: "forward", fill: {"material": (module: "metalness", fill: {"emission_map": "color-texture"})})"#;
    let mut material = material(text);
    material
        .settings
        .params
        .insert("main.material".into(), numbers(&[("emission", Value::Number(2.0))]));
    let halves = Texture {
        width: 2,
        height: 2,
        rgba: [[255, 0, 0, 255], [255, 0, 0, 255], [0, 188, 0, 255], [0, 188, 0, 255]].concat(),
    };
    let named = IndexMap::from([("image".to_owned(), Arc::new(halves))]);
    material.settings.textures.insert("main.material.emission_map".into(), named);
    let image = hdr(&frame(material, vec![], vec![draw(&square(4.0), Vec3::ZERO)]));
    let (top, bottom) = (texel(&image, 0.0, -2.0), texel(&image, 0.0, 2.0));
    // These texels lie a 32nd of a texture's texel beside its centre, so the other half shows a little.
    assert!((top[0] - 2.0).abs() < 0.04 && top[1] < 0.04, "{top:?}");
    assert!((bottom[1] - 2.0 * 0.502_886_5).abs() < 0.04 && bottom[0] < 0.04, "{bottom:?}");
}

/// Catches an example that does not draw, and NaN or infinity in what it draws.
#[test]
fn examples_draw() {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
    let mut drawn = 0;
    for entry in std::fs::read_dir(scenes).unwrap() {
        let path = entry.unwrap().path();
        if path.to_str().is_some_and(|p| p.ends_with(".scene.ron")) {
            let scene = SceneFile::read(&path).unwrap_or_else(|e| panic!("{e}"));
            let frame = scene.frame(&CATALOG, Some([96, 64])).unwrap_or_else(|e| panic!("{e}"));
            let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
            let targets = renderer.render(&frame).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
            let image = targets.read_hdr(&GPU).unwrap();
            assert!(image.iter().flatten().all(|v| v.is_finite()), "{}: NaN or infinite", path.display());
            let lit = image.iter().filter(|t| t[..3].iter().any(|c| *c > 0.0)).count();
            assert!(lit > image.len() / 10, "{}: {lit} lit texels", path.display());
            let display = targets.read_display(&GPU).unwrap().unwrap();
            assert!(display.chunks(4).any(|t| t[1] > 64), "{}: dark", path.display());
            drawn += 1;
        }
    }
    assert!(drawn > 0);
}

/// Catches lights that are linked without being given, which would read an empty buffer.
#[test]
fn lights_that_the_frame_lacks_are_an_error() {
    let scene = frame(material(LIT), vec![], vec![draw(&square(1.0), Vec3::ZERO)]);
    let error = Renderer::new(&GPU, Arc::clone(&CATALOG)).render(&scene).unwrap_err().to_string();
    assert_eq!(error, "lights: the recipe has `point`, the frame has none of that kind");
}
