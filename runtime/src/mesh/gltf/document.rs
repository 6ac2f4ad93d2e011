//! The document: nodes, materials, cameras and lights.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use glam::{Mat4, Vec3};
use gltf::json;
use indexmap::IndexMap;
use shadewright_compiler::manifest::Value;

use super::{Alpha, Asset, Camera, GltfError, Light, MAX_NODES, Map, Material, Object, Perspective, Read};
use super::{damaged, extensions, files, geometry, unsupported};
use crate::frame::{Mesh, Texture};
use crate::image::decode_texture;

/// Extensions that are drawn as they say.
const TAKEN: [&str; 2] = ["KHR_lights_punctual", "KHR_materials_emissive_strength"];

pub(super) fn read(bytes: &[u8], folder: &Path, by: &mut Read) -> Result<Asset, GltfError> {
    // A header that says less than its own 12 bytes is more than the reader bears.
    if let Some(length) = bytes.strip_prefix(b"glTF").and_then(|b| b.get(4..8))
        && u32::from_le_bytes([length[0], length[1], length[2], length[3]]) < 12
    {
        return Err(damaged("the binary header", "a length of less than 12 bytes"));
    }
    let gltf::Gltf { document, blob } = gltf::Gltf::from_slice_without_validation(bytes).map_err(|e| damaged("the file", e))?;
    // Named before the validator refuses them without naming them.
    let taken = |extension: &str| TAKEN.contains(&extension) || extensions::READ.contains(&extension);
    for extension in document.extensions_required() {
        if !taken(extension) {
            return Err(unsupported("extensionsRequired", format!("the extension {extension}")));
        }
    }
    for extension in document.extensions_used() {
        if !taken(extension) {
            log::warn!("glTF: the optional extension {extension} is not drawn");
        }
    }
    check_alternatives(document.as_json())?;
    let mut root = document.into_json();
    // The validator knows those only that the crate reads.
    root.extensions_required.retain(|e| !extensions::READ.contains(&e.as_str()));
    let document = gltf::Document::from_json(root).map_err(|e| damaged("the file", e))?;

    let buffers = buffers(&document, blob, folder, by)?;
    let mut reader = Reader {
        document: &document,
        folder,
        by,
        buffers: &buffers,
        images: HashMap::new(),
        meshes: HashMap::new(),
        asset: Asset::default(),
    };
    reader.materials()?;
    reader.nodes()?;
    Ok(reader.asset)
}

/// What the validator indexes or the reader unwraps without a check of its own.
fn check_alternatives(root: &json::Root) -> Result<(), GltfError> {
    use json::validation::Checked;

    for (i, mesh) in root.meshes.iter().enumerate() {
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            if primitive
                .attributes
                .values()
                .any(|accessor| accessor.value() >= root.accessors.len())
            {
                return Err(damaged(format!("meshes[{i}].primitives[{k}]"), "an accessor that does not exist"));
            }
        }
    }
    for (i, image) in root.images.iter().enumerate() {
        let by_view = image.buffer_view.is_some() && image.mime_type.is_some();
        if !by_view && (image.buffer_view.is_some() || image.uri.is_none()) {
            return Err(damaged(
                format!("images[{i}]"),
                "neither a URI nor a buffer view with its MIME type",
            ));
        }
    }
    for (i, camera) in root.cameras.iter().enumerate() {
        let there = match camera.type_ {
            Checked::Valid(json::camera::Type::Perspective) => camera.perspective.is_some(),
            Checked::Valid(json::camera::Type::Orthographic) => camera.orthographic.is_some(),
            Checked::Invalid => false,
        };
        if !there {
            return Err(damaged(format!("cameras[{i}]"), "a camera without its numbers"));
        }
    }
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    for (i, light) in lights.iter().flat_map(|l| &l.lights).enumerate() {
        let place = format!("lights[{i}]");
        match light.type_ {
            Checked::Invalid => return Err(damaged(place, "a light of an unknown type")),
            Checked::Valid(json::extensions::scene::khr_lights_punctual::Type::Spot) if light.spot.is_none() => {
                return Err(damaged(place, "a spot light without its cone"));
            }
            Checked::Valid(_) => {}
        }
    }
    Ok(())
}

fn buffers(document: &gltf::Document, blob: Option<Vec<u8>>, folder: &Path, by: &mut Read) -> Result<Vec<Vec<u8>>, GltfError> {
    let mut blob = blob;
    let mut all = Vec::new();
    for buffer in document.buffers() {
        let place = format!("buffers[{}]", buffer.index());
        let data = match buffer.source() {
            gltf::buffer::Source::Bin => blob.take().ok_or_else(|| damaged(place.clone(), "the file has no binary chunk"))?,
            gltf::buffer::Source::Uri(uri) => files::resolve(uri, folder, &place, by)?,
        };
        if data.len() < buffer.length() {
            return Err(damaged(
                place,
                format!("{} bytes where {} are declared", data.len(), buffer.length()),
            ));
        }
        all.push(data);
    }
    Ok(all)
}

struct Reader<'a, 'r> {
    document: &'a gltf::Document,
    folder: &'a Path,
    by: &'a mut Read<'r>,
    buffers: &'a [Vec<u8>],
    images: HashMap<usize, Arc<Texture>>,
    meshes: HashMap<(usize, usize), Arc<Mesh>>,
    asset: Asset,
}

impl Reader<'_, '_> {
    fn materials(&mut self) -> Result<(), GltfError> {
        for material in self.document.materials() {
            let index = material.index().unwrap_or_default();
            let read = self.material(&material, &format!("materials[{index}]"), format!("material {index}"))?;
            self.asset.materials.push(read);
        }
        Ok(())
    }

    fn material(&mut self, material: &gltf::Material, place: &str, fallback: String) -> Result<Material, GltfError> {
        let pbr = material.pbr_metallic_roughness();
        let mut made = Material {
            name: material.name().map_or(fallback, str::to_owned),
            double_sided: material.double_sided(),
            alpha: match material.alpha_mode() {
                gltf::material::AlphaMode::Opaque => Alpha::Opaque,
                gltf::material::AlphaMode::Mask => Alpha::Mask(material.alpha_cutoff().unwrap_or(0.5)),
                gltf::material::AlphaMode::Blend => Alpha::Blend,
            },
            ..Material::default()
        };
        let list = |components: &[f32]| Value::List(components.iter().map(|&x| f64::from(x)).collect());
        let strength = material.emissive_strength().unwrap_or(1.0);
        made.factors = IndexMap::from([
            ("gltf:baseColorFactor", list(&pbr.base_color_factor()[..3])),
            ("gltf:baseColorFactor.a", Value::Number(pbr.base_color_factor()[3].into())),
            ("gltf:metallicFactor", Value::Number(pbr.metallic_factor().into())),
            ("gltf:roughnessFactor", Value::Number(pbr.roughness_factor().into())),
            ("gltf:emissiveFactor", list(&material.emissive_factor())),
            ("gltf:emissiveStrength", Value::Number(strength.into())),
        ]);
        if let Alpha::Mask(cutoff) = made.alpha {
            made.factors.insert("gltf:alphaCutoff", Value::Number(cutoff.into()));
        }
        let extra = extensions::read(material, place)?;
        made.factors.extend(extra.factors);
        made.layers = extra.layers;
        // Name, texture, set of coordinates, and a factor of this use.
        type Used = (&'static str, usize, u32, Option<(&'static str, f32)>);
        let plain = |name: &'static str, info: gltf::texture::Info| -> Used { (name, info.texture().index(), info.tex_coord(), None) };
        let mut used: Vec<Used> = Vec::new();
        used.extend(pbr.base_color_texture().map(|t| plain("gltf:baseColorTexture", t)));
        used.extend(pbr.metallic_roughness_texture().map(|t| plain("gltf:metallicRoughnessTexture", t)));
        used.extend(material.emissive_texture().map(|t| plain("gltf:emissiveTexture", t)));
        if let Some(normal) = material.normal_texture() {
            let scale = ("gltf:normalScale", normal.scale());
            used.push(("gltf:normalTexture", normal.texture().index(), normal.tex_coord(), Some(scale)));
        }
        if let Some(occlusion) = material.occlusion_texture() {
            let strength = ("gltf:occlusionStrength", occlusion.strength());
            used.push((
                "gltf:occlusionTexture",
                occlusion.texture().index(),
                occlusion.tex_coord(),
                Some(strength),
            ));
        }
        for (name, info) in extra.textures {
            used.push((
                name,
                info.index,
                info.tex_coord,
                info.scale.map(|scale| ("gltf:normalScale", scale)),
            ));
        }
        for (name, texture, set, factor) in used {
            let word = name.trim_start_matches("gltf:");
            if set != 0 {
                return Err(unsupported(format!("{place}.{word}"), format!("texture coordinate set {set}")));
            }
            let texture = self.texture(texture, &format!("textures[{texture}]"))?;
            let factors = factor.map(|(name, x)| (name, Value::Number(x.into()))).into_iter().collect();
            made.maps.insert(name, Map { texture, factors });
        }
        Ok(made)
    }

    fn texture(&mut self, index: usize, place: &str) -> Result<Arc<Texture>, GltfError> {
        let Some(texture) = self.document.textures().nth(index) else {
            return Err(damaged(place, "there is no such texture"));
        };
        let image = texture.source();
        if let Some(known) = self.images.get(&image.index()) {
            return Ok(Arc::clone(known));
        }
        let place = format!("images[{}]", image.index());
        let from_file;
        let bytes: &[u8] = match image.source() {
            gltf::image::Source::View { view, .. } => self
                .buffers
                .get(view.buffer().index())
                .and_then(|b| b.get(view.offset()..view.offset().checked_add(view.length())?))
                .ok_or_else(|| damaged(place.clone(), "reaches past the end of its buffer"))?,
            gltf::image::Source::Uri { uri, .. } => {
                from_file = files::resolve(uri, self.folder, &place, self.by)?;
                &from_file
            }
        };
        let decoded = Arc::new(decode_texture(bytes).map_err(|e| damaged(place, e))?);
        self.images.insert(image.index(), Arc::clone(&decoded));
        Ok(decoded)
    }

    /// Walks the default scene, parents before children. A node has one parent at most, so meeting one twice is a cycle or worse.
    fn nodes(&mut self) -> Result<(), GltfError> {
        let Some(scene) = self.document.default_scene().or_else(|| self.document.scenes().next()) else {
            return Err(damaged("scenes", "there is no scene"));
        };
        let mut met = vec![false; self.document.nodes().len()];
        let mut waiting: Vec<(gltf::Node, Mat4)> = scene.nodes().map(|n| (n, Mat4::IDENTITY)).collect();
        if met.len() > MAX_NODES || waiting.len() > MAX_NODES {
            return Err(unsupported("nodes", format!("a file of more than {MAX_NODES} nodes")));
        }
        waiting.reverse();
        while let Some((node, parent)) = waiting.pop() {
            let place = format!("nodes[{}]", node.index());
            if std::mem::replace(&mut met[node.index()], true) {
                return Err(damaged(place, "is the child of two nodes, or of itself"));
            }
            let model = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
            if !model.is_finite() {
                return Err(damaged(place, "a transform that is not finite"));
            }
            self.node(&node, &place, model)?;
            let at = waiting.len();
            waiting.extend(node.children().map(|child| (child, model)));
            if waiting.len() > MAX_NODES {
                return Err(damaged("nodes", "more children than nodes"));
            }
            waiting[at..].reverse();
        }
        Ok(())
    }

    fn node(&mut self, node: &gltf::Node, place: &str, model: Mat4) -> Result<(), GltfError> {
        if node.skin().is_some() {
            return Err(unsupported(place, "a skin"));
        }
        if let Some(mesh) = node.mesh() {
            for primitive in mesh.primitives() {
                let key = (mesh.index(), primitive.index());
                let read = match self.meshes.get(&key) {
                    Some(known) => Arc::clone(known),
                    None => {
                        let place = format!("meshes[{}].primitives[{}]", key.0, key.1);
                        let read = Arc::new(geometry::read(&primitive, &place, self.buffers)?);
                        self.meshes.insert(key, Arc::clone(&read));
                        read
                    }
                };
                let material = match primitive.material().index() {
                    Some(index) => index,
                    None => self.default_material(&primitive.material())?,
                };
                self.asset.objects.push(Object {
                    name: node
                        .name()
                        .or(mesh.name())
                        .map_or_else(|| format!("node {}", node.index()), str::to_owned),
                    mesh_name: mesh.name().map(str::to_owned),
                    mesh: read,
                    material,
                    model,
                });
            }
        }
        if let Some(camera) = node.camera() {
            let perspective = match camera.projection() {
                gltf::camera::Projection::Perspective(p) => Some(Perspective {
                    fov: p.yfov(),
                    near: p.znear(),
                    far: p.zfar(),
                }),
                gltf::camera::Projection::Orthographic(_) => None,
            };
            self.asset.cameras.push(Camera {
                name: camera
                    .name()
                    .or(node.name())
                    .map_or_else(|| format!("camera {}", camera.index()), str::to_owned),
                world: model,
                perspective,
            });
        }
        if let Some(light) = node.light() {
            let read = light_at(&light, node, place, &model)?;
            self.asset.lights.push(read);
        }
        Ok(())
    }

    fn default_material(&mut self, material: &gltf::Material) -> Result<usize, GltfError> {
        let index = self.document.materials().len();
        if self.asset.materials.len() == index {
            let made = self.material(material, "the default material", "default".to_owned())?;
            self.asset.materials.push(made);
        }
        Ok(index)
    }
}

fn light_at(light: &gltf::khr_lights_punctual::Light, node: &gltf::Node, place: &str, model: &Mat4) -> Result<Light, GltfError> {
    use gltf::khr_lights_punctual::Kind;

    let list = |v: Vec3| Value::List(v.to_array().iter().map(|&x| f64::from(x)).collect());
    let numbers = light.color().into_iter().chain([light.intensity()]).chain(light.range());
    if numbers.into_iter().any(|x| !x.is_finite() || x < 0.0) {
        return Err(damaged(place, "a light with a negative or infinite colour, intensity or range"));
    }
    let mut fields = IndexMap::from([("gltf:color", list(Vec3::from(light.color())))]);
    let direction = model.transform_vector3(Vec3::NEG_Z).normalize_or(Vec3::NEG_Z);
    let (kind, unit) = match light.kind() {
        Kind::Directional => ("gltf:light/directional", "lx"),
        Kind::Point => ("gltf:light/point", "cd"),
        Kind::Spot {
            inner_cone_angle,
            outer_cone_angle,
        } => {
            fields.insert("gltf:innerConeAngle", Value::Number(inner_cone_angle.into()));
            fields.insert("half_angle", Value::Number(outer_cone_angle.into()));
            ("gltf:light/spot", "cd")
        }
    };
    fields.insert("gltf:intensity", Value::Text(format!("{} {unit}", light.intensity())));
    if kind != "gltf:light/directional" {
        fields.insert("position", list(model.transform_point3(Vec3::ZERO)));
        if let Some(range) = light.range() {
            fields.insert("range", Value::Number(range.into()));
        }
    }
    if kind != "gltf:light/point" {
        fields.insert("direction", list(direction));
    }
    Ok(Light {
        name: light
            .name()
            .or(node.name())
            .map_or_else(|| format!("light {}", light.index()), str::to_owned),
        kind,
        fields,
    })
}
