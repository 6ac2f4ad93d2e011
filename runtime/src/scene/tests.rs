use std::path::Path;
use std::sync::Arc;

use shadewright_compiler::manifest::{Filling, Node, Value, parse_recipe};
use shadewright_compiler::{Catalog, Report};

use super::*;
use crate::frame::Frame;
use crate::image::encode_png;

fn catalog() -> Catalog {
    Catalog::load(shadewright_modules::library()).unwrap()
}

fn read(text: &str) -> Result<Frame, Report> {
    SceneFile::parse("a.scene.ron", text, Path::new("/nonexistent"))?.frame(&catalog(), None)
}

/// A scene of one sphere; `lights`, `object` and `materials` are what is said beyond that.
fn scene(lights: &str, object: &str) -> String {
    format!(
        r#"(
    camera: (eye: (0, 0, 5), target: (0, 0, 0)),
    pass: "forward",
    meshes: {{"ball": Sphere(radius: 1)}},
    materials: {{"a": {{"material": (module: "metalness", params: {{"roughness": 0.3}})}}, "b": {{"material": "metalness"}}}},
    lights: [{lights}],
    objects: [(mesh: "ball", material: "a"{object}), (mesh: "ball", material: "b"{object})],
)"#
    )
}

const SHADOWED: &str = r#"(module: "point", visibility: (module: "cube-map", fill: {"filtering": "pcf"}))"#;
const PLAIN: &str = r#"(module: "point", fields: {"intensity": "800 lm"})"#;

fn light_nodes(node: &Node) -> Vec<Node> {
    match node.fill.get("lights") {
        Some(Filling::Many(nodes)) => nodes.clone(),
        other => panic!("{other:?}"),
    }
}

/// Catches shadow modules in a scene that casts no shadow, for any of the three reasons.
#[test]
fn without_shadows_there_is_no_shadow_module() {
    let with = read(&scene(SHADOWED, "")).unwrap();
    let text = format!("{:?}", with.materials[0].recipe);
    assert!(text.contains("cube-map") && text.contains("pcf"), "{text}");
    let off = SHADOWED.replace("point\",", "point\", casts_shadow: false,");
    for text in [scene(PLAIN, ""), scene(&off, ""), scene(SHADOWED, ", casts_shadow: false")] {
        let frame = read(&text).unwrap();
        for material in &frame.materials {
            assert_eq!(light_nodes(&material.recipe), [Node::new("point")]);
        }
        assert_eq!(frame.lights.len(), 1);
    }
}

/// Catches a light kind for each light, kinds that are no longer told apart, and instances that lose their order.
#[test]
fn lights_of_one_kind_share_a_node() {
    let far = r#"(module: "point", fields: {"intensity": 5})"#;
    let sun = r#"(module: "directional")"#;
    let frame = read(&scene(&format!("{PLAIN}, {SHADOWED}, {sun}, {far}"), "")).unwrap();
    let modules: Vec<&str> = frame.lights.iter().map(|l| l.node.module.as_str()).collect();
    assert_eq!(modules, ["point", "point", "directional"]);
    assert_eq!(frame.lights.iter().map(|l| l.instances.len()).collect::<Vec<_>>(), [2, 1, 1]);
    assert_eq!(frame.lights[0].instances[0]["intensity"], Value::Text("800 lm".to_owned()));
    assert_eq!(frame.lights[0].instances[1]["intensity"], Value::Number(5.0));
    let nodes: Vec<Node> = frame.lights.iter().map(|l| l.node.clone()).collect();
    assert_eq!(light_nodes(&frame.materials[0].recipe), nodes);
    assert!(read(&scene("", "")).unwrap().lights.is_empty());
}

/// Catches a recipe for each material, or objects that cannot tell their parameters apart.
#[test]
fn equal_recipes_are_shared() {
    let frame = read(&scene(PLAIN, "")).unwrap();
    assert_eq!((frame.draws.len(), frame.materials.len()), (2, 2));
    assert!(Arc::ptr_eq(&frame.materials[0].recipe, &frame.materials[1].recipe));
    assert!(Arc::ptr_eq(&frame.draws[0].mesh, &frame.draws[1].mesh));
    assert_eq!(frame.materials[0].settings.params["main.material"]["roughness"], Value::Number(0.3));
    assert!(frame.materials[1].settings.params.is_empty());
    // Nothing is named that the scene does not say.
    let root = &frame.materials[0].recipe;
    assert_eq!(root.fill.keys().collect::<Vec<_>>(), ["material", "lights"]);
    assert_eq!(root.fill["material"], Filling::One(Node::new("metalness")));
}

/// Catches lights on what receives none, and a turned normal where only front faces are drawn.
#[test]
fn flags_reach_the_recipe() {
    let frame = read(&scene(SHADOWED, ", receives_light: false")).unwrap();
    assert!(light_nodes(&frame.materials[0].recipe).is_empty());
    assert!(frame.materials[0].recipe.freeze.is_empty());
    let frame = read(&scene(PLAIN, ", double_sided: true, alpha_blend: true, visible: false")).unwrap();
    assert_eq!(frame.materials[0].recipe.freeze["double_sided"], Value::Bool(true));
    let draw = &frame.draws[0];
    assert!(draw.double_sided && draw.alpha_blend && !draw.visible && draw.casts_shadow);
    // Neither seen nor casting: not there.
    assert!(
        read(&scene(PLAIN, ", visible: false, casts_shadow: false"))
            .unwrap()
            .draws
            .is_empty()
    );
}

/// Catches a constant parameter that is set as a uniform and never arrives, and settings under the wrong place.
#[test]
fn parameters_find_their_places() {
    let light =
        r#"(module: "point", visibility: (module: "cube-map", params: {"resolution": 512, "bias": 0.01}, fill: {"filtering": "hard"}))"#;
    let frame = read(&scene(&format!("{PLAIN}, {light}"), "")).unwrap();
    let Filling::One(map) = &frame.lights[1].node.fill["visibility"] else {
        panic!()
    };
    assert_eq!(map.freeze["resolution"], Value::Number(512.0));
    assert_eq!(map.freeze.len(), 1);
    let params = &frame.materials[0].settings.params;
    assert_eq!(params["main.lights[1].visibility"]["bias"], Value::Number(0.01));
    assert_eq!(params.len(), 2);
}

/// Catches maps in the shader that nothing uses, two pictures that become one, and one picture that becomes two.
#[test]
fn maps_only_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    for (name, grey) in [("a.png", 10), ("b.png", 20)] {
        std::fs::write(folder.path().join(name), encode_png(1, 1, &[grey, grey, grey, 255]).unwrap()).unwrap();
    }
    let derive = |fill: &str| {
        let text = scene(PLAIN, "").replace("params: {\"roughness\": 0.3}", &format!("fill: {{{fill}}}"));
        let file = SceneFile::parse("a.scene.ron", &text, folder.path()).unwrap();
        file.frame(&catalog(), None).unwrap()
    };
    let map = |file: &str| format!("(module: \"color-texture\", textures: {{\"image\": \"{file}\"}})");

    let one = derive(&format!("\"base_color_map\": {}", map("a.png")));
    let Filling::One(material) = &one.materials[0].recipe.fill["material"] else {
        panic!()
    };
    assert_eq!(material.fill.keys().collect::<Vec<_>>(), ["base_color_map"]);
    assert_eq!(
        one.materials[0].settings.textures["main.material.base_color_map"]["image"].rgba,
        [10, 10, 10, 255]
    );
    assert!(!format!("{:?}", one.materials[1].recipe).contains("texture"));
    assert!(!Arc::ptr_eq(&one.materials[0].recipe, &one.materials[1].recipe));

    let two = derive(&format!("\"base_color_map\": {}, \"emission_map\": {}", map("a.png"), map("b.png")));
    let Filling::One(material) = &two.materials[0].recipe.fill["material"] else {
        panic!()
    };
    assert_ne!(material.fill["base_color_map"], material.fill["emission_map"]);
    let same = derive(&format!("\"base_color_map\": {}, \"emission_map\": {}", map("a.png"), map("a.png")));
    let Filling::One(material) = &same.materials[0].recipe.fill["material"] else {
        panic!()
    };
    assert_eq!(material.fill["base_color_map"], material.fill["emission_map"]);
}

/// Catches two lights of one kind whose shadow settings differ being linked into one.
#[test]
fn equal_kinds_with_other_settings_are_kept_apart() {
    let with = |bias: f32| format!(r#"(module: "point", visibility: (module: "cube-map", params: {{"bias": {bias}}}))"#);
    let frame = read(&scene(&format!("{}, {}, {}", with(0.01), with(0.02), with(0.01)), "")).unwrap();
    assert_eq!(frame.lights.iter().map(|l| l.instances.len()).collect::<Vec<_>>(), [2, 1]);
    assert_ne!(frame.lights[0].node, frame.lights[1].node);
    for material in &frame.materials {
        let nodes: Vec<Node> = frame.lights.iter().map(|l| l.node.clone()).collect();
        assert_eq!(light_nodes(&material.recipe), nodes);
    }
}

/// Catches an error without place, with the wrong code, or that points elsewhere.
#[test]
fn errors_point_into_the_scene() {
    let good = scene(SHADOWED, "");
    assert!(read(&good).is_ok());
    let cases = [
        // Text that is replaced, by what, code, what the error points at.
        ("\"forward\"", "\"foward\"", "SW0201", "\"foward\""),
        ("\"forward\"", "\"metalness\"", "SW0202", "\"metalness\""),
        ("\"metalness\", params", "\"pcf\", params", "SW0202", "\"pcf\""),
        ("\"roughness\": 0.3", "\"roughnes\": 0.3", "SW0301", "\"roughnes\""),
        ("\"roughness\": 0.3", "\"roughness\": 3", "SW0302", "3"),
        ("\"roughness\": 0.3", "\"roughness\": (1, 2, 3)", "SW0303", "(1, 2, 3)"),
        (
            "\"point\", ",
            "\"point\", fields: {\"intensity\": \"5 lx\"}, ",
            "SW0304",
            "\"5 lx\"",
        ),
        ("\"point\", ", "\"point\", fields: {\"bias\": 5}, ", "SW0301", "\"bias\""),
        ("{\"filtering\": \"pcf\"}", "{\"filter\": \"pcf\"}", "SW0204", "\"pcf\""),
        (
            "{\"filtering\": \"pcf\"}",
            "{\"filtering\": [\"pcf\", \"hard\"]}",
            "SW0207",
            "[\"pcf\", \"hard\"]",
        ),
        (
            "visibility: (module: \"cube-map\"",
            "visibility: (module: \"ggx\"",
            "SW0202",
            "\"ggx\"",
        ),
        (
            "{\"material\": (",
            "{\"materials\": (",
            "SW0204",
            "(module: \"metalness\", params: {\"roughness\": 0.3})",
        ),
        ("Sphere(radius: 1)", "Sphere(radius: -1)", "SW0901", "Sphere(radius: -1)"),
        (
            "Sphere(radius: 1)",
            "Gltf(file: \"none.glb\")",
            "SW0903",
            "Gltf(file: \"none.glb\")",
        ),
        (
            "mesh: \"ball\", material: \"a\"",
            "mesh: \"bal\", material: \"a\"",
            "SW0902",
            "\"bal\"",
        ),
        (
            "mesh: \"ball\", material: \"a\"",
            "mesh: \"ball\", material: \"c\"",
            "SW0902",
            "\"c\"",
        ),
        ("material: \"a\"", "material: \"a\", scale: (1, 0, 1)", "SW0901", "(1, 0, 1)"),
        ("target: (0, 0, 0)", "target: (0, 0, 5)", "SW0901", "(0, 0, 5)"),
        ("target: (0, 0, 0)", "target: (0, 0, 0), fov: 180", "SW0901", "180"),
        ("target: (0, 0, 0)", "target: (0, 0, 0), near: 200", "SW0901", "200"),
        ("pass: \"forward\"", "pass: \"forward\", size: (0, 4)", "SW0901", "(0, 4)"),
        (
            "pass: \"forward\"",
            "pass: \"forward\", background: (0, -1, 0)",
            "SW0901",
            "(0, -1, 0)",
        ),
        ("pass: \"forward\"", "pass: \"forward\", post: []", "SW0901", "[]"),
        ("pass: \"forward\"", "pass: \"forward\", pas: 3", "SW0102", "pas"),
        (
            "(module: \"metalness\", params",
            "(module: \"metalness\", textures: {\"image\": \"a.png\"}, params",
            "SW0902",
            "\"a.png\"",
        ),
        (
            "\"material\": \"metalness\"",
            "\"material\": (module: \"metalness\", fill: {\"normal_map\": (module: \"normal-map\", textures: {\"image\": \"a.png\"})})",
            "SW0903",
            "\"a.png\"",
        ),
    ];
    for (from, to, code, at) in cases {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good, "{from}");
        let report = read(&text).unwrap_err();
        let found = &report.diagnostics[0];
        let label = &found.labels[0];
        assert_eq!((found.code, &label.file.text[label.span.clone()]), (code, at), "{to}\n{report}");
        assert_eq!(label.file.name, "a.scene.ron");
    }
    // All errors at once, not only the first.
    let text = good
        .replace("radius: 1", "radius: 0")
        .replace("target: (0, 0, 0)", "target: (0, 0, 5)");
    assert_eq!(read(&text).unwrap_err().diagnostics.len(), 2);
}

/// Catches lost advice in what a person reads.
#[test]
fn a_whole_error() {
    let report = read(&scene(r#"(module: "directional", fields: {"direction": (0, 0, 0)})"#, "")).unwrap_err();
    assert_eq!(
        report.render().trim_end(),
        r#"error[SW0901]: the light has no direction
  --> a.scene.ron:6:60
  |
6 |     lights: [(module: "directional", fields: {"direction": (0, 0, 0)})],
  |                                                            ^^^^^^^^^ all components are 0"#
    );
}

fn compile(catalog: &Catalog, node: &Node) -> shadewright_compiler::Program {
    catalog.compile(&node.clone().into(), "main").unwrap_or_else(|e| panic!("{e}"))
}

/// Catches shadow bindings or functions in the linked shader of a scene without shadows, and derived recipes that do not link.
#[test]
fn derived_recipes_link_without_what_is_not_there() {
    let catalog = catalog();
    let shader = |text: &str| {
        let frame = read(text).unwrap();
        let program = compile(&catalog, &frame.materials[0].recipe);
        let bindings: Vec<String> = program.reflection().bindings.iter().map(|b| format!("{:?}", b.fill)).collect();
        // A comment of an interface may speak of shadows.
        let code: Vec<&str> = program.wgsl().lines().filter(|line| !line.trim_start().starts_with("//")).collect();
        (bindings.join("\n"), code.join("\n"), program.reflection().passes.len())
    };
    let (bindings, wgsl, passes) = shader(&scene(SHADOWED, ""));
    assert!(
        bindings.contains("shadow_map") && wgsl.contains("shadow_compare") && passes == 1,
        "{bindings}"
    );
    let off = SHADOWED.replace("point\",", "point\", casts_shadow: false,");
    let (bindings, wgsl, passes) = shader(&scene(&off, ""));
    assert!(
        !bindings.contains("shadow") && !wgsl.contains("shadow") && passes == 0,
        "{bindings}\n{wgsl}"
    );
    let (bindings, wgsl, _) = shader(&scene(SHADOWED, ", receives_light: false"));
    assert!(!bindings.contains("shadow") && !wgsl.contains("instances"), "{wgsl}");
}

/// Catches a change that does not arrive, or one that is not checked.
#[test]
fn values_can_be_changed() {
    let file = SceneFile::parse("a.scene.ron", &scene(PLAIN, ""), Path::new("")).unwrap();
    let set = file.set("lights[0].fields.intensity", "900 lm").unwrap();
    let frame = set.frame(&catalog(), Some([8, 4])).unwrap();
    assert_eq!(frame.lights[0].instances[0]["intensity"], Value::Text("900 lm".to_owned()));
    assert_eq!(frame.size, [8, 4]);
    assert_eq!(file.set("lights[3].module", "point").unwrap_err().diagnostics[0].code, "SW0906");
    assert_eq!(file.set("lights[0].modul", "point").unwrap_err().diagnostics[0].code, "SW0102");
}

/// Catches bitangents that are not mirrored with the object, and a turned winding, which the renderer's turned front face would undo.
#[test]
fn mirrored_objects_keep_their_bitangents() {
    let frame = read(&scene(PLAIN, ", scale: (-1, 1, 1), translate: (1, 2, 3), rotate: (0, 90, 0)")).unwrap();
    let draw = &frame.draws[0];
    assert!(Arc::ptr_eq(&draw.mesh, &frame.draws[1].mesh));
    let corners = [0, 1, 2].map(|k| glam::Vec3::from(draw.mesh.positions[draw.mesh.indices[k] as usize]));
    let moved = corners.map(|p| draw.model.transform_point3(p));
    let normal = (moved[1] - moved[0]).cross(moved[2] - moved[0]);
    assert!(normal.dot(moved[0] - draw.model.transform_point3(glam::Vec3::ZERO)) < 0.0);
    // A vertex of the equator. The bitangent s cross(n, t) turns with the picture: down it, against v, on the mirrored side, too.
    let (n, t) = (glam::Vec3::from(draw.mesh.normals[1043]), draw.mesh.tangents[1043]);
    let normal = (draw.model.inverse().transpose()).transform_vector3(n);
    let bitangent = normal.cross(draw.model.transform_vector3(glam::Vec3::from_slice(&t))) * t[3];
    assert!(bitangent.y > 0.0, "{bitangent}");
    // -x becomes +z by a quarter turn about y, and the mirror makes it +x's.
    assert!((draw.model.transform_point3(glam::Vec3::X) - glam::Vec3::new(1.0, 2.0, 4.0)).length() < 1e-6);
}

/// Catches roles, slots and kinds that glTF has and modules represent, but that get lost between the two.
#[test]
fn whole_gltf_files() {
    let folder = tempfile::tempdir().unwrap();
    let derive = |bytes: Vec<u8>, more: &str| {
        std::fs::write(folder.path().join("a.glb"), bytes).unwrap();
        let text = format!(r#"(pass: "forward", size: (4, 2), gltf: [(file: "a.glb", translate: (0, 1, 0){more})])"#);
        SceneFile::parse("a.scene.ron", &text, folder.path())
            .unwrap()
            .frame(&catalog(), None)
    };
    let plain = crate::mesh::gltf::tests::sample_with(|d| {
        d["materials"][0]["alphaMode"] = "BLEND".into();
    });
    let frame = derive(plain.clone(), "").unwrap();
    assert_eq!((frame.draws.len(), frame.lights.len()), (2, 2));
    assert!(frame.draws[0].alpha_blend && frame.draws[0].double_sided && !frame.draws[1].alpha_blend);
    let params = &frame.materials[0].settings.params;
    assert_eq!(params["main.material"]["roughness"], Value::Number(0.5));
    assert_eq!(params["main.material"]["opacity"], Value::Number(0.75));
    assert_eq!(params["main.material"]["emission"], Value::Number(100.0));
    assert_eq!(params["main.material.normal_map"]["scale"], Value::Number(0.5));
    assert_eq!(
        frame.materials[0].settings.textures["main.material.base_color_map"]["image"].width,
        2
    );
    let text = format!("{:?}", frame.materials[0].recipe);
    assert!(!text.contains("emission_map") && !text.contains("visibility"), "{text}");
    // The second primitive has glTF's default material: no maps.
    assert!(!format!("{:?}", frame.materials[1].recipe).contains("texture"));
    let lamp = frame.lights.iter().find(|l| l.node.module == "point").unwrap();
    assert_eq!(lamp.instances[0]["position"], Value::List(vec![0.0, 5.0, 0.0]));
    assert_eq!(lamp.instances[0]["intensity"], Value::Text("5 cd".to_owned()));
    // The camera: at (1, 3, 3), looking down.
    assert!((frame.camera.eye() - glam::Vec3::new(1.0, 3.0, 3.0)).length() < 1e-5);
    assert!((frame.camera.forward() - glam::Vec3::NEG_Y).length() < 1e-5);

    let shadowed = derive(plain, r#", visibility: {"gltf:light/point": "cube-map"}"#).unwrap();
    assert!(format!("{:?}", shadowed.lights).contains("cube-map"));

    let said = |change: fn(&mut serde_json::Value)| derive(crate::mesh::gltf::tests::sample_with(change), "").unwrap_err();
    let mask = said(|_| {});
    assert_eq!(mask.diagnostics[0].code, "SW0904");
    assert!(mask.diagnostics[0].message.contains("gltf:alphaCutoff"), "{mask}");
    let spot = |outer: f64| {
        let sample = crate::mesh::gltf::tests::sample_with(|d| {
            d["materials"][0]["alphaMode"] = "OPAQUE".into();
            let cone = serde_json::json!({"innerConeAngle": 0.25, "outerConeAngle": outer});
            d["extensions"]["KHR_lights_punctual"]["lights"][0] = serde_json::json!({"type": "spot", "intensity": 7, "spot": cone});
        });
        derive(sample, r#", visibility: {"gltf:light/spot": "perspective"}"#)
    };
    let frame = spot(0.5).unwrap();
    let beam = frame.lights.iter().find(|l| l.node.module == "spot").unwrap();
    assert_eq!(beam.instances[0]["inner"], Value::Number(0.25));
    assert_eq!(beam.instances[0]["outer"], Value::Number(0.5));
    assert_eq!(beam.instances[0]["intensity"], Value::Text("7 cd".to_owned()));
    assert!(beam.instances[0].contains_key("position") && beam.instances[0].contains_key("direction"));
    assert!(format!("{:?}", beam.node).contains("perspective"));
    assert_eq!(spot(4.0).unwrap_err().diagnostics[0].code, "SW0302");
    assert_eq!(derive(b"no file".to_vec(), "").unwrap_err().diagnostics[0].code, "SW0903");
}

/// Catches example scenes that do not derive, and recipes beside them that say something else than the scene does.
#[test]
fn the_examples_fit_together() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let catalog = catalog();
    let derive = |name: &str| {
        let file = SceneFile::read(&examples.join("scenes").join(name)).unwrap_or_else(|e| panic!("{e}"));
        file.frame(&catalog, None).unwrap_or_else(|e| panic!("{e}"))
    };
    let recipe = |name: &str| {
        let text = std::fs::read_to_string(examples.join("recipes").join(name)).unwrap();
        parse_recipe(name, &text).unwrap_or_else(|e| panic!("{e}")).value
    };
    let first = derive("first.scene.ron");
    let forward = recipe("forward.recipe.ron");
    assert!(
        first.materials.iter().any(|m| *m.recipe == forward),
        "{:#?}",
        first.materials[0].recipe
    );
    assert_eq!(*first.display.as_ref().unwrap().recipe, recipe("display.recipe.ron"));
    assert_eq!(first.lights.len(), 3);
    let linked = first
        .materials
        .iter()
        .chain(&first.display)
        .map(|m| compile(&catalog, &m.recipe).hash());
    assert_eq!(
        linked.collect::<std::collections::HashSet<_>>().len(),
        3,
        "one-sided, two-sided, display"
    );
    let shadowed = first.lights.iter().filter(|l| l.node.fill.contains_key("visibility")).count();
    assert_eq!(shadowed, 2);
    for name in ["lambert-plane.scene.ron", "ggx-sphere.scene.ron"] {
        let frame = derive(name);
        assert_eq!((frame.draws.len(), frame.lights.len(), frame.size), (1, 1, [128, 128]), "{name}");
    }
    for name in ["unshadowed.recipe.ron", "depth.recipe.ron", "auto-exposure.recipe.ron"] {
        compile(&catalog, &recipe(name));
    }
}

/// Catches panics and hangs on damaged text.
#[test]
fn damage_never_panics() {
    let catalog = catalog();
    let good = scene(SHADOWED, "").replace("radius: 1", "radius: 1, segments: 3, rings: 2");
    let try_it = |text: &str| {
        if let Ok(file) = SceneFile::parse("a.scene.ron", text, Path::new("/nonexistent")) {
            // A larger mesh is only slow.
            if !file.scene().meshes.values().any(|m| format!("{m:?}").len() > 60) {
                let _ = file.frame(&catalog, None);
            }
        }
    };
    for cut in (0..good.len()).filter(|&i| good.is_char_boundary(i)) {
        try_it(&good[..cut]);
    }
    for at in (0..good.len()).step_by(5) {
        for byte in [b'(', b'}', b'"', b'9', b'-', b' '] {
            let mut bytes = good.clone().into_bytes();
            bytes[at] = byte;
            try_it(&String::from_utf8_lossy(&bytes));
        }
    }
}

/// Catches a name that several categories have and that is not taken for what fits the slot.
#[test]
fn a_slot_says_which_module_a_name_means() {
    let light = r#"(module: "sphere", fill: {"area": (module: "split", fill: {"diffuse": "representative-point", "specular": (module: "representative-point", params: {"widening": 0.5})})})"#;
    let frame = read(&scene(light, "")).unwrap_or_else(|report| panic!("{report}"));
    let settings = &frame.materials[0].settings.params;
    let widened = settings.values().filter(|params| params.contains_key("widening")).count();
    assert_eq!(widened, 1, "{settings:?}");
}
