//! Shadow maps, derived from what modules declare: a `Draw` pass says from where and how large, the light it belongs
//! to says where it stands. One map serves all recipes that hold the same light with the same visibility.

use glam::Vec3;
use shadewright_compiler::manifest::{Node, Param, PassDecl, ViewKind};
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::{Instance, Pass, Reflection};

use super::programs::{Programs, instance, text_of};
use super::view::{Eye, MapSize};
use super::{Bounds, Frame, Lights, Settings};
use crate::gpu::value::numbers;
use crate::gpu::{DataError, RuntimeError};

/// Depth format of shadow maps and of the camera's view.
pub(crate) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A shadow map to be drawn.
#[derive(Debug)]
pub(crate) struct Map {
    /// The light, the place of the visibility in it, and the pass.
    key: (String, String, String),
    /// Name of the kind of light, and how many views each has.
    pub light: String,
    pub views: usize,
    pub texels: u32,
    /// One for each layer.
    pub eyes: Vec<Eye>,
    /// Root of the recipe that draws it, before its inherited slots are filled.
    root: Node,
    inherit: Vec<String>,
}

/// Which map an instance of a recipe means by a pass of its own.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct MapUse {
    pub instance: String,
    pub pass: String,
    pub map: usize,
}

/// What a setting of an instance is: by its name, or by a place where it stands.
pub(crate) fn setting<'a, T>(
    of: &'a indexmap::IndexMap<String, indexmap::IndexMap<String, T>>,
    at: &Instance,
    name: &str,
) -> Option<&'a T> {
    let mut keys = std::iter::once(&at.name).chain(&at.paths);
    keys.find_map(|key| of.get(key)?.get(name))
}

/// The frame's lights of an instance that has them.
pub(crate) fn lights_of<'a>(programs: &Programs, frame: &'a Frame, root: &Node, light: &Instance) -> Result<&'a Lights, DataError> {
    let node = light.paths.first().and_then(|path| programs.node_at(root, path));
    node.and_then(|(node, _)| frame.lights.iter().find(|l| l.node == node))
        .filter(|lights| !lights.instances.is_empty())
        .ok_or_else(|| {
            DataError::new(
                "lights",
                format!("the recipe has `{}`, the frame has none of that kind", light.name),
            )
        })
}

/// The light in whose slots an instance stands: the nearest one above it that has instances.
fn light_above<'a>(reflection: &'a Reflection, of: &Instance) -> Option<(&'a Instance, String)> {
    let path = of.paths.first()?;
    let above = |i: &&Instance| !i.fields.is_empty() && i.paths.iter().any(|p| rest_of(path, p).is_some());
    let light = reflection
        .instances
        .iter()
        .filter(above)
        .max_by_key(|i| i.paths.iter().map(String::len).max())?;
    let rest = light.paths.iter().find_map(|p| rest_of(path, p))?;
    Some((light, rest.to_owned()))
}

/// What of a slot path comes after another one.
fn rest_of<'a>(path: &'a str, above: &str) -> Option<&'a str> {
    path.strip_prefix(above)?.strip_prefix('.')
}

/// A field's components for each of the lights, by the field's role.
fn by_role(light: &Instance, lights: &Lights, role: &str) -> Result<Option<Vec<Vec<f64>>>, DataError> {
    let Some((name, field)) = light.fields.iter().find(|(_, f)| f.role.as_deref() == Some(role)) else {
        return Ok(None);
    };
    let row = |(i, row): (usize, &indexmap::IndexMap<String, _>)| {
        let value = row.get(name).unwrap_or(&field.default);
        numbers(field, value, &format!("{}[{i}].{name}", light.name))
    };
    lights.instances.iter().enumerate().map(row).collect::<Result<_, _>>().map(Some)
}

#[allow(clippy::cast_possible_truncation)] // the values come from f32
fn vector(numbers: &[f64]) -> Vec3 {
    let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0) as f32;
    Vec3::new(at(0), at(1), at(2))
}

/// The views of all lights of a kind, in the order of their layers.
fn eyes(kind: ViewKind, light: &Instance, lights: &Lights, size: &MapSize) -> Result<Vec<Eye>, DataError> {
    let role = |name: &str| by_role(light, lights, name);
    let (position, direction, range, angle) = (role("position")?, role("direction")?, role("range")?, role("half_angle")?);
    let needs = |what: &str| {
        DataError::new(
            &light.name,
            format!("has no field with the role `{what}`, which its shadow map needs"),
        )
    };
    let mut all = Vec::new();
    for i in 0..lights.instances.len() {
        let of = |field: &Option<Vec<Vec<f64>>>| field.as_ref().map(|rows| vector(&rows[i]));
        let range = of(&range).map(|r| r.x);
        match (kind, of(&position), of(&direction)) {
            (ViewKind::Cube, Some(position), _) => all.extend(Eye::cube(position, range, size)),
            (ViewKind::Cube, None, _) => return Err(needs("position")),
            (ViewKind::Projected, _, None) => return Err(needs("direction")),
            (ViewKind::Projected, None, Some(direction)) => all.push(Eye::parallel(direction, size)),
            (ViewKind::Projected, Some(position), Some(direction)) => {
                // A view of 180 degrees has no perspective; 80 to each side is the widest that keeps a useful texel.
                let tangent = of(&angle).map_or(1.0, |a| a.x.clamp(0.01, 80f32.to_radians()).tan());
                all.push(Eye::spot(position, direction, tangent, range, size));
            }
        }
    }
    Ok(all)
}

/// Box around everything that is drawn, by a camera or into a shadow map.
pub(crate) fn scene_bounds(frame: &Frame, bounds: &[Bounds]) -> Bounds {
    let drawn = frame.draws.iter().zip(bounds).filter(|(d, _)| d.visible || d.casts_shadow);
    drawn.map(|(_, b)| *b).reduce(|a, b| a.union(&b)).unwrap_or(Bounds {
        min: Vec3::ZERO,
        max: Vec3::ZERO,
    })
}

/// The value of a `resolution` parameter: set, frozen, or the module's default.
fn resolution(programs: &Programs, root: &Node, settings: &Settings, at: &Instance, name: &str) -> Result<u32, DataError> {
    let path = format!("{}.{name}", at.name);
    let place = at.paths.first().and_then(|p| programs.node_at(root, p));
    let param: Option<Param> = place
        .as_ref()
        .and_then(|(node, interface)| programs.module(node, interface.as_deref()))
        .and_then(|module| module.manifest.params.get(name).cloned());
    let param = param.ok_or_else(|| DataError::new(&path, "is no parameter of the module whose pass needs it"))?;
    let frozen = place.as_ref().and_then(|(node, _)| node.freeze.get(name));
    let value = setting(&settings.params, at, name).or(frozen).unwrap_or(&param.default);
    let number = numbers(&param, value, &path)?[0];
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the range is checked
    if (1.0..=65536.0).contains(&number) {
        Ok(number as u32)
    } else {
        Err(DataError::new(path, format!("a shadow map of {number} texels")))
    }
}

/// Adds the maps that a recipe's program needs, and says which of its passes means which map.
pub(crate) fn maps_of(
    programs: &Programs,
    frame: &Frame,
    (root, settings, program): (&Node, &Settings, &Program),
    scene: Bounds,
    maps: &mut Vec<Map>,
) -> Result<Vec<MapUse>, RuntimeError> {
    let reflection = program.reflection();
    let mut uses = Vec::new();
    for Pass {
        instance: of,
        name,
        declared,
    } in &reflection.passes
    {
        let PassDecl::Draw {
            root: pass_root,
            inherit,
            view,
            resolution: side,
        } = declared
        else {
            continue;
        };
        let no_light = || DataError::new(of, format!("pass `{name}` draws a shadow map, but there is no light above it"));
        let at = instance(reflection, of).ok_or_else(no_light)?;
        let (light, rest) = light_above(reflection, at).ok_or_else(no_light)?;
        if let Some(path) = at.paths.iter().find(|p| !light.paths.iter().any(|l| rest_of(p, l).is_some())) {
            let message = format!(
                "stands below `{}` and at {path}, but a shadow map belongs to one kind of light; label one of the two",
                light.name
            );
            return Err(DataError::new(of, message).into());
        }
        let lights = lights_of(programs, frame, root, light)?;
        let key = (text_of(&lights.node), rest, name.clone());
        let map = match maps.iter().position(|m| m.key == key) {
            Some(map) => map,
            None => {
                let texels = resolution(programs, root, settings, at, side)?;
                let size = MapSize {
                    texels,
                    scene,
                    time: frame.time,
                };
                let eyes = eyes(*view, light, lights, &size)?;
                maps.push(Map {
                    key,
                    light: light.name.clone(),
                    views: eyes.len() / lights.instances.len().max(1),
                    texels,
                    eyes,
                    root: pass_root.clone(),
                    inherit: inherit.clone(),
                });
                maps.len() - 1
            }
        };
        uses.push(MapUse {
            instance: of.clone(),
            pass: name.clone(),
            map,
        });
    }
    Ok(uses)
}

impl Map {
    /// A layer for people: the light, and which of its views.
    pub fn name(&self, layer: usize) -> String {
        let (light, view) = (layer / self.views.max(1), layer % self.views.max(1));
        let light = match self.eyes.len() / self.views.max(1) {
            1 => self.light.clone(),
            _ => format!("{} {}", self.light, light + 1),
        };
        match self.views {
            1 => format!("shadow map of {light}"),
            views => format!("shadow map of {light}, view {} of {views}", view + 1),
        }
    }

    /// The recipe that draws an object of this recipe into the map: the pass's own root, with the inherited slots as there.
    /// It depends on what the object is made of, not on whether it receives this light.
    pub fn caster(&self, programs: &Programs, main: &Node) -> Node {
        let mut root = self.root.clone();
        for slot in &self.inherit {
            if let Some(filling) = programs.filling(main, None, slot) {
                root.fill.insert(slot.clone(), filling);
            }
        }
        root
    }
}
