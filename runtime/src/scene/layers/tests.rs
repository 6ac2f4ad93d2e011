use std::path::Path;
use std::sync::Arc;

use serde_json::{Value as Json, json};
use shadewright_compiler::manifest::{Filling, Node, Value};
use shadewright_compiler::{Catalog, Report};

use crate::frame::{Frame, Renderer};
use crate::gpu::testing::gpu;
use crate::mesh::gltf::tests::sample_with;
use crate::scene::SceneFile;

fn catalog() -> Arc<Catalog> {
    Arc::new(Catalog::load(shadewright_modules::library()).unwrap())
}

/// What each extension says of the sample's first material.
fn said(name: &str) -> Json {
    match name {
        "KHR_materials_ior" => json!({"ior": 1.25}),
        "KHR_materials_specular" => {
            json!({"specularFactor": 0.5, "specularColorFactor": [1.0, 0.5, 0.25], "specularTexture": {"index": 0}})
        }
        "KHR_materials_anisotropy" => json!({"anisotropyStrength": 0.75, "anisotropyRotation": 0.5}),
        "KHR_materials_sheen" => {
            json!({"sheenColorFactor": [0.5, 0.25, 0.125], "sheenRoughnessFactor": 0.375, "sheenColorTexture": {"index": 0}})
        }
        "KHR_materials_clearcoat" => json!({
            "clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25, "clearcoatNormalTexture": {"index": 0, "scale": 0.25},
        }),
        other => panic!("{other}"),
    }
}

const ALL: [&str; 5] = [
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_anisotropy",
    "KHR_materials_sheen",
    "KHR_materials_clearcoat",
];

/// The frame of a file whose first material has these extensions, which are required.
fn derived(extensions: &[(&str, Json)], pass: &str, more: &str) -> Result<Frame, Report> {
    derived_from(extensions, pass, more, |_| {})
}

/// The same of a file that is changed otherwise as well.
fn derived_from(extensions: &[(&str, Json)], pass: &str, more: &str, change: fn(&mut Json)) -> Result<Frame, Report> {
    let folder = tempfile::tempdir().unwrap();
    let file = sample_with(|document| {
        document["materials"][0]["alphaMode"] = "OPAQUE".into();
        change(document);
        for (name, said) in extensions {
            document["materials"][0]["extensions"][name] = said.clone();
            for list in ["extensionsUsed", "extensionsRequired"] {
                let mut names = document[list].as_array().cloned().unwrap_or_default();
                names.push((*name).into());
                document[list] = names.into();
            }
        }
    });
    std::fs::write(folder.path().join("a.glb"), file).unwrap();
    let text = format!(
        r#"(
            camera: (eye: (2, 3, 12), target: (2, 3, 3)), size: (32, 32), pass: {pass},
            lights: [(module: "directional", fields: {{"direction": (-0.3, -0.2, -1), "illuminance": 1000}})],
            gltf: [(file: "a.glb", lights: false{more})],
        )"#
    );
    SceneFile::parse("a.scene.ron", &text, folder.path())?.frame(&catalog(), None)
}

fn of(names: &[&'static str]) -> Vec<(&'static str, Json)> {
    names.iter().map(|name| (*name, said(name))).collect()
}

/// The linked code, without comments: those speak of what a module could do.
fn wgsl(node: &Node) -> String {
    let program = catalog().compile(&node.clone().into(), "main").unwrap_or_else(|e| panic!("{e}"));
    let code = program.wgsl().lines().filter(|line| !line.trim_start().starts_with("//"));
    code.collect::<Vec<_>>().join("\n")
}

/// Module and what fills the slot, by the path of slots.
fn at<'n>(node: &'n Node, path: &[&str]) -> &'n str {
    let mut node = node;
    for slot in path {
        node = match &node.fill[*slot] {
            Filling::One(one) => one,
            Filling::Many(_) => panic!("{slot}"),
        };
    }
    &node.module
}

/// Names of functions that only a layer brings, by its extension.
const FUNCTIONS: [(&str, &[&str]); 4] = [
    ("KHR_materials_specular", &["fn schlick_f90_fresnel("]),
    (
        "KHR_materials_anisotropy",
        &["fn ggx_anisotropic_distribution(", "fn smith_ggx_anisotropic_masking("],
    ),
    ("KHR_materials_sheen", &["fn fuzz_brdf("]),
    ("KHR_materials_clearcoat", &["fn coat_brdf("]),
];

/// Catches layers in a wrong order, a factor or a map that reaches another parameter, a coat's normal map with the base's scale, layers that
/// do not link, and pictures without them or with NaN.
#[test]
fn all_extensions_at_once() {
    let frame = derived(&of(&ALL), "\"forward\"", "").unwrap();
    let material = &frame.materials[0];
    let root = &material.recipe;
    assert_eq!(at(root, &["material"]), "metalness-layered");
    assert_eq!(at(root, &["brdf"]), "brdf/coat");
    assert_eq!(at(root, &["brdf", "base"]), "brdf/fuzz");
    let base = ["brdf", "base", "base"];
    assert_eq!(at(root, &base), "microfacet");
    assert_eq!(at(root, &[&base[..], &["fresnel"]].concat()), "fresnel/schlick-f90");
    assert_eq!(at(root, &[&base[..], &["ndf"]].concat()), "ndf/ggx-anisotropic");
    assert_eq!(at(root, &[&base[..], &["masking"]].concat()), "masking/smith-ggx-anisotropic");

    let params = &material.settings.params["main.material"];
    let list = |x: [f64; 3]| Value::List(x.to_vec());
    for (name, value) in [
        ("ior", Value::Number(1.25)),
        ("specular", Value::Number(0.5)),
        ("specular_color", list([1.0, 0.5, 0.25])),
        ("anisotropy", Value::Number(0.75)),
        ("anisotropy_rotation", Value::Number(0.5)),
        ("fuzz_color", list([0.5, 0.25, 0.125])),
        ("fuzz_roughness", Value::Number(0.375)),
        ("coat", Value::Number(0.75)),
        ("coat_roughness", Value::Number(0.25)),
        ("roughness", Value::Number(0.5)),
    ] {
        assert_eq!(params[name], value, "{name}");
    }
    assert_eq!(at(root, &["material", "specular_map"]), "data-texture");
    assert_eq!(at(root, &["material", "fuzz_color_map"]), "color-texture");
    let scale = |slot: &str| material.settings.params[&format!("main.material.{slot}")]["scale"].clone();
    assert_eq!(
        (scale("normal_map"), scale("coat_normal_map")),
        (Value::Number(0.5), Value::Number(0.25))
    );

    let text = wgsl(root);
    for (extension, functions) in FUNCTIONS {
        assert!(functions.iter().all(|f| text.contains(f)), "{extension}: {text}");
    }
    // Members of a uniform buffer, so that values can change.
    for member in ["ior: f32", "anisotropy_rotation: f32", "coat_roughness: f32", "fuzz_color: vec3f"] {
        assert!(text.contains(member), "{member}: {text}");
    }

    // The sample's picture is no normal map: it would turn all away from the light.
    let flat: fn(&mut Json) = |document| {
        document["materials"][0].as_object_mut().unwrap().remove("normalTexture");
    };
    let mut extensions = of(&ALL);
    extensions[4].1 = json!({"clearcoatFactor": 0.75, "clearcoatRoughnessFactor": 0.25});
    let mut renderer = Renderer::new(&gpu(), catalog());
    let mut draw = |extensions: &[(&str, Json)]| {
        let frame = derived_from(extensions, "\"forward\"", "", flat).unwrap();
        renderer.render(&frame).unwrap().read_hdr(&gpu()).unwrap()
    };
    let (layered, plain) = (draw(&extensions), draw(&[]));
    let light = |texels: &[[f32; 4]]| texels.iter().map(|t| t[0]).sum::<f32>();
    assert!(layered.iter().flatten().all(|x| x.is_finite()));
    assert!(
        light(&layered) > 0.0 && light(&layered) != light(&plain),
        "{} {}",
        light(&layered),
        light(&plain)
    );
}

/// Catches layers, materials or parameters that a material without the extension has in its shader.
#[test]
fn nothing_is_linked_that_the_material_has_not() {
    let with = |names: &[&'static str]| derived(&of(names), "\"forward\"", "").unwrap();
    let plain = with(&[]);
    assert_eq!(at(&plain.materials[0].recipe, &["material"]), "metalness");
    assert!(!plain.materials[0].recipe.fill.contains_key("brdf"));
    for (extension, _) in FUNCTIONS {
        let frame = with(&[extension]);
        let text = wgsl(&frame.materials[0].recipe);
        for (other, functions) in FUNCTIONS {
            for function in functions {
                assert_eq!(text.contains(function), other == extension, "{extension}: {function}\n{text}");
            }
        }
        // The other primitive has the default material.
        assert_eq!(frame.materials[1].recipe, plain.materials[1].recipe, "{extension}");
    }
    // The material module reads all; a shader without a coat has none of the coat's parameters.
    let sheen = wgsl(&with(&["KHR_materials_sheen"]).materials[0].recipe);
    assert!(
        sheen.contains("fuzz_roughness") && !sheen.contains("coat") && !sheen.contains("anisotropy"),
        "{sheen}"
    );
    // An index of refraction is a number: another module for the material, the same BRDF.
    let ior = with(&["KHR_materials_ior"]);
    assert_eq!(at(&ior.materials[0].recipe, &["material"]), "metalness-layered");
    assert!(!ior.materials[0].recipe.fill.contains_key("brdf"));
    // What says nothing is as if it were not there.
    for (name, nothing) in [
        ("KHR_materials_ior", json!({})),
        ("KHR_materials_specular", json!({"specularFactor": 1.0})),
        ("KHR_materials_anisotropy", json!({"anisotropyRotation": 1.0})),
        ("KHR_materials_sheen", json!({"sheenRoughnessFactor": 1.0})),
        ("KHR_materials_clearcoat", json!({"clearcoatRoughnessFactor": 1.0})),
    ] {
        let frame = derived(&[(name, nothing)], "\"forward\"", "").unwrap();
        assert_eq!(frame.materials[0].recipe, plain.materials[0].recipe, "{name}");
    }
}

/// Catches layers over what the scene itself has chosen, and layers that forget what the scene's pass has.
#[test]
fn what_the_scene_says_holds() {
    let all = of(&ALL);
    let frame = derived(&all, "\"forward\"", r#", fill: {"brdf": "lambert"}"#).unwrap();
    assert_eq!(at(&frame.materials[0].recipe, &["brdf"]), "lambert");
    let pass = r#"(module: "forward", fill: {"brdf": (module: "microfacet", fill: {"diffuse": "burley"})})"#;
    let frame = derived(&all, pass, "").unwrap();
    let base = ["brdf", "base", "base"];
    assert_eq!(at(&frame.materials[0].recipe, &[&base[..], &["diffuse"]].concat()), "burley");
    assert_eq!(
        at(&frame.materials[0].recipe, &[&base[..], &["fresnel"]].concat()),
        "fresnel/schlick-f90"
    );
    // Another module for a layer; what lies below has no slot of the right category, and is left alone.
    let frame = derived(
        &of(&["KHR_materials_sheen"]),
        "\"forward\"",
        r#", modules: {"gltf:KHR_materials_sheen": "brdf/coat"}"#,
    )
    .unwrap();
    assert_eq!(at(&frame.materials[0].recipe, &["brdf"]), "brdf/coat");
}

/// Catches an extension or a part of one that is left out without a word, and one that is misread.
#[test]
fn what_cannot_be_drawn_is_named() {
    let error = |name: &str, said: Json, more: &str| derived(&[(name, said)], "\"forward\"", more).unwrap_err();
    let required = error("KHR_materials_transmission", json!({}), "");
    assert!(
        required.diagnostics[0].code == "SW0904" && required.to_string().contains("KHR_materials_transmission"),
        "{required}"
    );
    let damaged = error("KHR_materials_sheen", json!({"sheenColorFactor": "red"}), "");
    assert!(damaged.diagnostics[0].code == "SW0903", "{damaged}");
    assert!(
        damaged.to_string().contains("materials[0].extensions.KHR_materials_sheen"),
        "{damaged}"
    );
    let nowhere = error(
        "KHR_materials_sheen",
        json!({"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 7}}),
        "",
    );
    assert!(nowhere.to_string().contains("textures[7]: there is no such texture"), "{nowhere}");
    let texture = error(
        "KHR_materials_anisotropy",
        json!({"anisotropyStrength": 1, "anisotropyTexture": {"index": 0}}),
        "",
    );
    assert!(texture.to_string().contains("has no slot for gltf:anisotropyTexture"), "{texture}");
    let chosen = error(
        "KHR_materials_clearcoat",
        said("KHR_materials_clearcoat"),
        r#", modules: {"gltf:material": "metalness"}"#,
    );
    assert!(
        chosen.to_string().contains("`metalness` has no parameter for gltf:clearcoatFactor"),
        "{chosen}"
    );
    let far = error("KHR_materials_ior", json!({"ior": -1}), "");
    assert!(far.to_string().contains("ior"), "{far}");
}

/// The file is read from the folder of the scene.
#[test]
fn a_missing_file_is_an_error() {
    let file = SceneFile::parse(
        "a.scene.ron",
        r#"(camera: (eye: (0, 0, 1), target: (0, 0, 0)), pass: "forward", gltf: [(file: "none.glb")])"#,
        Path::new("/nonexistent"),
    );
    let error = file.unwrap().frame(&catalog(), None).unwrap_err();
    assert_eq!(error.diagnostics[0].code, "SW0903");
}
