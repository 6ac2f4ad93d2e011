use std::path::Path;

use base64::Engine;
use serde_json::{Value as Json, json};
use shadewright_compiler::manifest::Value;

use super::*;

/// Two triangles with normals and texture coordinates, 4 vertices, u16 indices, and a 2 x 1 PNG.
pub(crate) fn blob() -> Vec<u8> {
    let mut bytes = Vec::new();
    for p in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]] {
        bytes.extend(p.iter().flat_map(|x| x.to_le_bytes()));
    }
    for _ in 0..4 {
        bytes.extend([0.0f32, 0.0, 2.0].iter().flat_map(|x| x.to_le_bytes()));
    }
    // Normalised bytes with padding to 4: a stride that is not the size.
    for uv in [[0u8, 255, 9, 9], [255, 255, 9, 9], [255, 0, 9, 9], [0, 0, 9, 9]] {
        bytes.extend(uv);
    }
    for i in [0u16, 1, 2, 0, 2, 3] {
        bytes.extend(i.to_le_bytes());
    }
    bytes.extend(crate::image::encode_png(2, 1, &[255, 0, 0, 255, 0, 255, 0, 128]).unwrap());
    while !bytes.len().is_multiple_of(4) {
        bytes.push(0);
    }
    bytes
}

fn document(blob_length: usize) -> Json {
    json!({
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_emissive_strength"],
        "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 5.0, "range": 20.0, "color": [1.0, 0.5, 0.25]},
            {"type": "directional", "intensity": 9.0, "name": "sun"},
        ]}},
        "buffers": [{"byteLength": blob_length}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 48},
            {"buffer": 0, "byteOffset": 96, "byteLength": 16, "byteStride": 4},
            {"buffer": 0, "byteOffset": 112, "byteLength": 12},
            {"buffer": 0, "byteOffset": 124, "byteLength": blob_length - 124},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC2", "normalized": true},
            {"bufferView": 3, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "textures": [{"source": 0}],
        "materials": [{
            "name": "paint",
            "pbrMetallicRoughness": {
                "baseColorFactor": [0.5, 0.25, 0.125, 0.75], "metallicFactor": 0.0, "roughnessFactor": 0.5,
                "baseColorTexture": {"index": 0},
            },
            "normalTexture": {"index": 0, "scale": 0.5},
            "emissiveFactor": [1.0, 0.5, 0.0],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100.0}},
            "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true,
        }],
        "meshes": [{"name": "quad", "primitives": [
            {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0},
            {"attributes": {"POSITION": 0}, "indices": 3},
        ]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "nodes": [
            {"name": "root", "translation": [1.0, 2.0, 3.0], "children": [1, 2]},
            {"mesh": 0, "scale": [2.0, 2.0, 2.0]},
            {"rotation": [-0.707_106_77, 0.0, 0.0, 0.707_106_77], "camera": 0, "extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"name": "lamp", "translation": [0.0, 4.0, 0.0], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "scenes": [{"nodes": [0, 3]}],
        "scene": 0,
    })
}

fn glb(document: &Json, blob: &[u8]) -> Vec<u8> {
    let mut text = serde_json::to_vec(document).unwrap();
    while !text.len().is_multiple_of(4) {
        text.push(b' ');
    }
    let mut out = b"glTF".to_vec();
    let length = 12 + 8 + text.len() + 8 + blob.len();
    out.extend([2u32, length as u32, text.len() as u32].iter().flat_map(|x| x.to_le_bytes()));
    out.extend(b"JSON");
    out.extend(text);
    out.extend((blob.len() as u32).to_le_bytes());
    out.extend(b"BIN\0");
    out.extend(blob);
    out
}

fn sample() -> Vec<u8> {
    sample_with(|_| {})
}

/// The sample as a `.glb`, its document changed.
pub(crate) fn sample_with(change: impl FnOnce(&mut Json)) -> Vec<u8> {
    let blob = blob();
    let mut document = document(blob.len());
    change(&mut document);
    glb(&document, &blob)
}

/// The document with one change, and what is said about it.
fn error_of(change: impl FnOnce(&mut Json)) -> String {
    parse(&sample_with(change), Path::new("")).unwrap_err().to_string()
}

/// Catches lost transforms, factors, textures, strides, and normals or tangents that are not made.
#[test]
fn reads_what_it_says() {
    let asset = parse(&sample(), Path::new("")).unwrap();
    assert_eq!(asset.objects.len(), 2);
    let object = &asset.objects[0];
    object.mesh.check().unwrap();
    assert_eq!(object.mesh.positions.len(), 4);
    assert_eq!(object.mesh.normals[0], [0.0, 0.0, 1.0]);
    assert_eq!(object.mesh.uvs, [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
    assert_eq!(object.mesh.tangents[0], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(object.model.transform_point3(glam::Vec3::X), glam::Vec3::new(3.0, 2.0, 3.0));
    let whole = asset.joined(Some("quad")).unwrap();
    assert_eq!(whole.positions.len(), 10);
    assert_eq!(whole.positions[1], [3.0, 2.0, 3.0]);
    assert_eq!(asset.joined(Some("cube")), Err(MeshError::NoSuchMesh("cube".to_owned())));
    // Without normals: flat, so nothing is shared, and glTF's default material.
    asset.objects[1].mesh.check().unwrap();
    assert_eq!(asset.objects[1].mesh.positions.len(), 6);
    assert_eq!(
        asset.materials[asset.objects[1].material].factors["gltf:metallicFactor"],
        Value::Number(1.0)
    );

    let paint = &asset.materials[0];
    assert_eq!(paint.factors["gltf:baseColorFactor"], Value::List(vec![0.5, 0.25, 0.125]));
    assert_eq!(paint.factors["gltf:baseColorFactor.a"], Value::Number(0.75));
    assert_eq!(paint.factors["gltf:emissiveFactor"], Value::List(vec![1.0, 0.5, 0.0]));
    assert_eq!(paint.factors["gltf:emissiveStrength"], Value::Number(100.0));
    assert_eq!(paint.maps["gltf:normalTexture"].factors["gltf:normalScale"], Value::Number(0.5));
    assert!(paint.layers.is_empty());
    assert_eq!((paint.alpha, paint.double_sided), (Alpha::Mask(0.25), true));
    assert_eq!(paint.maps["gltf:baseColorTexture"].texture.rgba, [255, 0, 0, 255, 0, 255, 0, 128]);
    assert!(Arc::ptr_eq(
        &paint.maps["gltf:baseColorTexture"].texture,
        &paint.maps["gltf:normalTexture"].texture
    ));

    assert_eq!(
        asset.cameras[0].perspective,
        Some(Perspective {
            fov: 0.5,
            near: 0.1,
            far: None
        })
    );
    let (sun, lamp) = (&asset.lights[0], &asset.lights[1]);
    assert_eq!((sun.name.as_str(), sun.kind), ("sun", "gltf:light/directional"));
    assert_eq!(sun.fields["gltf:intensity"], Value::Text("9 lx".to_owned()));
    let Value::List(direction) = &sun.fields["direction"] else {
        panic!()
    };
    assert!((direction[1] + 1.0).abs() < 1e-6, "{direction:?}");
    assert_eq!(lamp.kind, "gltf:light/point");
    assert_eq!(lamp.fields["gltf:intensity"], Value::Text("5 cd".to_owned()));
    assert_eq!(lamp.fields["position"], Value::List(vec![0.0, 4.0, 0.0]));
    assert_eq!(lamp.fields["range"], Value::Number(20.0));
    assert!(!lamp.fields.contains_key("direction"));
}

/// Catches data URIs and files beside the document that are not found, and paths that leave the folder's machine.
#[test]
fn buffers_from_anywhere() {
    let blob = blob();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("the buffer.bin"), &blob).unwrap();
    let with = |uri: &str| {
        let mut document = document(blob.len());
        document["buffers"][0]["uri"] = json!(uri);
        let path = folder.path().join("a.gltf");
        std::fs::write(&path, serde_json::to_vec(&document).unwrap()).unwrap();
        load(&path)
    };
    let encoded = base64::engine::general_purpose::STANDARD.encode(&blob);
    let embedded = with(&format!("data:application/octet-stream;base64,{encoded}")).unwrap();
    let beside = with("the%20buffer.bin").unwrap();
    assert_eq!(embedded.objects[0].mesh, beside.objects[0].mesh);
    assert!(matches!(with("missing.bin"), Err(GltfError::Unreadable { .. })));
    assert!(matches!(with("https://example.org/a.bin"), Err(GltfError::Unsupported { .. })));
    assert!(matches!(with("/etc/passwd"), Err(GltfError::Unsupported { .. })));
    assert!(matches!(with("data:text/plain,hello"), Err(GltfError::Unsupported { .. })));
    assert!(matches!(with("data:;base64,@@"), Err(GltfError::Damaged { .. })));
    assert!(matches!(with("a%2"), Err(GltfError::Damaged { .. })));
}

/// Catches features that would be left out of the picture without a word.
#[test]
fn what_is_not_taken_is_named() {
    assert_eq!(
        error_of(|d| d["extensionsRequired"] = json!(["KHR_draco_mesh_compression"])),
        "extensionsRequired: the extension KHR_draco_mesh_compression cannot be drawn"
    );
    assert_eq!(
        error_of(|d| d["meshes"][0]["primitives"][0]["mode"] = json!(1)),
        "meshes[0].primitives[0]: a primitive of Lines cannot be drawn"
    );
    assert_eq!(
        error_of(|d| d["meshes"][0]["primitives"][1]["targets"] = json!([{"POSITION": 0}])),
        "meshes[0].primitives[1]: a morph target cannot be drawn"
    );
    assert_eq!(
        error_of(|d| {
            d["skins"] = json!([{"joints": [0]}]);
            d["nodes"][1]["skin"] = json!(0);
        }),
        "nodes[1]: a skin cannot be drawn"
    );
    assert_eq!(
        error_of(|d| {
            d["accessors"][0]["sparse"] =
                json!({"count": 1, "indices": {"bufferView": 3, "componentType": 5123}, "values": {"bufferView": 0}});
        }),
        "accessors[0]: a sparse accessor cannot be drawn"
    );
    assert_eq!(
        error_of(|d| d["materials"][0]["normalTexture"]["texCoord"] = json!(1)),
        "materials[0].normalTexture: texture coordinate set 1 cannot be drawn"
    );
    assert_eq!(
        error_of(|d| d["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(1)),
        "meshes[0].primitives[0]: a vertex colour cannot be drawn"
    );
}

/// Catches reads past a buffer, cycles, and what the upstream reader unwraps.
#[test]
fn what_is_broken_is_located() {
    type Change = fn(&mut Json);
    let ends: [(&str, Change); 10] = [
        ("meshes[0].primitives[0]: an accessor that does not exist", |d| {
            d["accessors"] = json!([])
        }),
        ("accessors[0]: reaches past the end of its buffer", |d| {
            d["accessors"][0]["byteOffset"] = json!(4)
        }),
        ("accessors[3]: reaches past the end of its buffer", |d| {
            d["bufferViews"][3]["byteOffset"] = json!(4_000_000_000u32)
        }),
        ("nodes[0]: is the child of two nodes, or of itself", |d| {
            d["nodes"][1]["children"] = json!([0])
        }),
        ("images[0]: neither a URI nor a buffer view with its MIME type", |d| {
            d["images"] = json!([{"bufferView": 4}])
        }),
        ("cameras[0]: a camera without its numbers", |d| {
            d["cameras"] = json!([{"type": "orthographic"}])
        }),
        ("lights[0]: a spot light without its cone", |d| {
            d["extensions"]["KHR_lights_punctual"]["lights"][0]["type"] = json!("spot");
        }),
        ("meshes[0].primitives[0]: 4 indices, not a multiple of 3", |d| {
            d["accessors"][3]["count"] = json!(4)
        }),
        ("meshes[0].primitives[0]: index 3 of 3 vertices", |d| {
            for i in 0..3 {
                d["accessors"][i]["count"] = json!(3);
            }
        }),
        ("buffers[0]: 188 bytes where 1000000 are declared", |d| {
            d["buffers"][0]["byteLength"] = json!(1_000_000)
        }),
    ];
    for (expected, change) in ends {
        let said = error_of(change);
        let numbers_aside = |s: &str| s.replace(char::is_numeric, "");
        assert_eq!(numbers_aside(&said), numbers_aside(expected), "{said}");
    }
}

/// Catches panics and hangs: every truncation, and every byte changed three ways.
#[test]
fn damage_never_panics() {
    let good = sample();
    for cut in 0..good.len() {
        let _ = parse(&good[..cut], Path::new(""));
    }
    for at in 0..good.len() {
        for flip in [0x01, 0x20, 0xff] {
            let mut bad = good.clone();
            bad[at] ^= flip;
            let _ = parse(&bad, Path::new("/nonexistent"));
        }
    }
}
