//! Binding numbers for languages that count resources by kind instead of by group and binding.

use std::collections::BTreeMap;

use naga::back::msl;
use naga::{AddressSpace, ImageClass, Module, ResourceBinding, TypeInner};

/// Kinds of resources that are counted apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Uniform,
    Storage,
    Texture,
    StorageTexture,
    Sampler,
    Other,
}

/// The module's resources in the order of group and binding.
fn resources(module: &Module) -> BTreeMap<ResourceBinding, Kind> {
    let bound = module
        .global_variables
        .iter()
        .filter_map(|(_, global)| Some((global.binding?, global)));
    bound
        .map(|(binding, global)| {
            let inner = match module.types[global.ty].inner {
                TypeInner::BindingArray { base, .. } => &module.types[base].inner,
                ref inner => inner,
            };
            let kind = match (inner, global.space) {
                (TypeInner::Sampler { .. }, _) => Kind::Sampler,
                (TypeInner::Image { class, .. }, _) => match class {
                    ImageClass::Storage { .. } => Kind::StorageTexture,
                    _ => Kind::Texture,
                },
                (_, AddressSpace::Uniform) => Kind::Uniform,
                (_, AddressSpace::Storage { .. }) => Kind::Storage,
                _ => Kind::Other,
            };
            (binding, kind)
        })
        .collect()
}

/// GLSL: uniform blocks, storage blocks, textures, images and samplers each from 0; `None` if a number exceeds 255.
pub(super) fn glsl(module: &Module) -> Option<BTreeMap<ResourceBinding, u8>> {
    let mut next = BTreeMap::new();
    let mut map = BTreeMap::new();
    for (binding, kind) in resources(module) {
        let class = match kind {
            Kind::Uniform => 0,
            Kind::Storage => 1,
            // A sampler has no number of its own: GLSL fuses it with its texture.
            Kind::Texture | Kind::Sampler => 2,
            Kind::StorageTexture => 3,
            Kind::Other => 4,
        };
        let number = next.entry(class).or_insert(0u32);
        map.insert(binding, u8::try_from(*number).ok()?);
        if kind != Kind::Sampler {
            *number += 1;
        }
    }
    Some(map)
}

/// Metal: buffers, textures and samplers each from 0, the same in all entry points; after the last buffer comes the one with
/// the sizes of runtime-sized arrays. `None` if a number exceeds 255.
pub(super) fn msl(module: &Module) -> Option<msl::EntryPointResourceMap> {
    let (mut buffers, mut textures, mut samplers) = (0u32, 0u32, 0u32);
    let mut map = msl::BindingMap::new();
    let take = |counter: &mut u32| {
        let slot = u8::try_from(*counter).ok();
        *counter += 1;
        slot
    };
    for (binding, kind) in resources(module) {
        let mut target = msl::BindTarget::default();
        match kind {
            Kind::Uniform | Kind::Storage | Kind::Other => target.buffer = Some(take(&mut buffers)?),
            Kind::Texture | Kind::StorageTexture => target.texture = Some(take(&mut textures)?),
            Kind::Sampler => target.sampler = Some(msl::BindSamplerTarget::Resource(take(&mut samplers)?)),
        }
        map.insert(binding, target);
    }
    let resources = msl::EntryPointResources {
        resources: map,
        immediates_buffer: None,
        sizes_buffer: Some(take(&mut buffers)?),
    };
    Some(
        module
            .entry_points
            .iter()
            .map(|entry| (entry.name.clone(), resources.clone()))
            .collect(),
    )
}
