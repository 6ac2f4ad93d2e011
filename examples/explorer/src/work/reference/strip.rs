//! A picture in strips.

use std::ops::Range;

use glam::{Mat4, Vec3};
use shadewright_compiler::Catalog;
use shadewright_compiler::manifest::{Filling, Node};
use shadewright_runtime::frame::{Frame, Targets};
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::wgpu;

use crate::compare::Values;

/// Some rows of a frame, counted from the top, as a frame.
pub(super) fn strip(frame: &Frame, rows: Range<u32>) -> Frame {
    let [width, height] = frame.size;
    let edge = |row: u32| 1.0 - 2.0 * f64::from(row) / f64::from(height);
    let (top, bottom) = (edge(rows.start), edge(rows.end));
    let scale = 2.0 / (top - bottom);
    let place = Vec3::new(0.0, (-scale * (top + bottom) / 2.0) as f32, 0.0);
    let cut = Mat4::from_translation(place) * Mat4::from_scale(Vec3::new(1.0, scale as f32, 1.0));
    let mut strip = frame.clone();
    strip.camera.projection = cut * frame.camera.projection;
    strip.size = [width, rows.len() as u32];
    strip
}

/// Whether the way to the screen looks at one pixel alone. What has passes of its own looks at the whole picture, for its exposure.
pub(super) fn can_be_cut(catalog: &Catalog, frame: &Frame) -> bool {
    fn has_passes(catalog: &Catalog, category: Option<&str>, node: &Node) -> bool {
        let of_slot = category.and_then(|category| catalog.module_for(category, &node.module).ok());
        let Some(module) = of_slot.or_else(|| catalog.module(&node.module).ok()) else {
            return true;
        };
        let manifest = &module.manifest;
        let below = manifest.slots.iter().any(|(name, slot)| {
            let nodes = match node.fill.get(name).or(slot.default.as_ref()) {
                None => &[],
                Some(Filling::One(node)) => std::slice::from_ref(node),
                Some(Filling::Many(nodes)) => nodes.as_slice(),
            };
            nodes.iter().any(|node| has_passes(catalog, Some(&slot.interface), node))
        });
        !manifest.passes.is_empty() || below
    }
    frame
        .display
        .as_ref()
        .is_none_or(|display| !has_passes(catalog, None, &display.recipe))
}

/// A picture that strips are added to.
pub(super) struct Whole {
    size: [u32; 2],
    display: wgpu::Texture,
    texels: Vec<[f32; 4]>,
}

impl Whole {
    /// An empty one.
    ///
    /// # Errors
    /// The GPU has no room for it.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self, RuntimeError> {
        let display = gpu.scoped("strips", |device| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("strips"),
                size: wgpu::Extent3d {
                    width: size[0],
                    height: size[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        })?;
        Ok(Self {
            size,
            display,
            texels: Vec::new(),
        })
    }

    /// Adds a strip whose first row is this one.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn add(&mut self, gpu: &Gpu, targets: &Targets, read: Values, row: u32) -> Result<(), RuntimeError> {
        self.texels.extend(read.texels);
        let Some(display) = &targets.display else { return Ok(()) };
        let commands = gpu.scoped("strip", |device| {
            let mut commands = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let mut to = self.display.as_image_copy();
            to.origin.y = row;
            commands.copy_texture_to_texture(display.as_image_copy(), to, display.size());
            commands.finish()
        })?;
        gpu.queue().submit([commands]);
        Ok(())
    }

    /// The picture for the screen, and its numbers.
    ///
    /// # Errors
    /// The GPU fails.
    pub fn finish(self, gpu: &Gpu) -> Result<(wgpu::Texture, Values), RuntimeError> {
        gpu.wait()?;
        let values = Values {
            size: self.size,
            texels: self.texels,
        };
        Ok((self.display, values))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;
    use std::sync::Arc;

    use shadewright_runtime::frame::Renderer;
    use shadewright_runtime::scene::SceneFile;

    use super::*;

    /// Catches strips that are upside down, squeezed, a row too high or low, or in another order; and a picture that is cut though its exposure
    /// is that of the whole.
    #[test]
    fn strips_make_the_whole() {
        let scene = |exposure: &str| {
            let text = format!(
                r#"(
                camera: (eye: (0.5, 1.0, 6.0), target: (0.0, 0.3, 0.0), fov: 30.0), pass: "forward", display: "display",
                post: [(module: "tonemap", fill: {{"exposure": {exposure}}})],
                meshes: {{"ball": Sphere(radius: 1.0)}}, materials: {{"m": {{"material": "metalness", "brdf": "microfacet"}}}},
                lights: [(module: "point", fields: {{"position": (1.0, 3.0, 2.0), "intensity": 500.0}})], objects: [(mesh: "ball", material: "m")],
            )"#
            );
            SceneFile::parse("test", &text, Path::new("")).unwrap()
        };
        let catalog = Arc::new(Catalog::load(shadewright_modules::library()).unwrap());
        let size = [48, 37];
        let frame = scene("(module: \"manual\", params: {\"ev100\": 5.0})")
            .frame(&catalog, Some(size))
            .unwrap();
        assert!(can_be_cut(&catalog, &frame));
        let adaptive = scene("\"log-average\"").frame(&catalog, Some(size)).unwrap();
        assert!(!can_be_cut(&catalog, &adaptive));
        let gpu = Gpu::headless().unwrap();
        let mut renderer = Renderer::new(&gpu, catalog);
        let expected = renderer.render(&frame).unwrap();
        let read = |targets: &Targets| Values {
            size: [targets.hdr.width(), targets.hdr.height()],
            texels: targets.read_hdr(&gpu).unwrap(),
        };
        let mut whole = Whole::new(&gpu, size).unwrap();
        for rows in [0..10, 10..11, 11..37] {
            let targets = renderer.render(&strip(&frame, rows.clone())).unwrap();
            whole.add(&gpu, &targets, read(&targets), rows.start).unwrap();
        }
        let (display, values) = whole.finish(&gpu).unwrap();
        let expected_values = read(&expected);
        let same = values.texels.iter().zip(&expected_values.texels);
        let near = same
            .filter(|(a, b)| (0..3).all(|c| (a[c] - b[c]).abs() <= 1e-3 * b[c].abs().max(1.0)))
            .count();
        // A silhouette may fall on the other side of a pixel's middle.
        assert!(values.texels.len() == 48 * 37 && near > 48 * 37 - 8, "{near}");
        let found = Targets {
            display: Some(display),
            ..expected.clone()
        };
        let pixels = |targets: &Targets| targets.read_display(&gpu).unwrap().unwrap();
        let same = pixels(&found)
            .iter()
            .zip(pixels(&expected))
            .filter(|(a, b)| a.abs_diff(*b) <= 1)
            .count();
        assert!(same > 4 * 48 * 37 - 32, "{same}");
    }
}
