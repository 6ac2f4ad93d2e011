//! The driver's own cache of compiled pipelines, through a file and back.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Renderer;
use shadewright_runtime::gpu::{Gpu, GpuError, RuntimeError, cache};
use shadewright_runtime::scene::SceneFile;

/// What a caller has to do himself.
#[allow(unsafe_code)]
fn cache_of(gpu: &Gpu, data: Option<&[u8]>) -> wgpu::PipelineCache {
    let descriptor = wgpu::PipelineCacheDescriptor {
        label: None,
        data,
        fallback: true,
    };
    // SAFETY: `data` is nothing, or comes from `get_data` of a cache of the same adapter and driver in this process, by way of a file in a
    // folder that this test has just made and that is gone after it.
    unsafe { gpu.device().create_pipeline_cache(&descriptor) }
}

/// A device of an adapter, as a caller makes it.
fn open(adapter: &wgpu::Adapter) -> Gpu {
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_features: wgpu::Features::PIPELINE_CACHE,
        required_limits: adapter.limits(),
        ..Default::default()
    }))
    .unwrap();
    Gpu::from_parts(device, queue)
}

/// Catches pipelines that are made without the cache that was given, data that does not come back, and a cache that changes the picture.
#[test]
fn pipelines_go_into_the_cache_and_come_back() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    // Only Vulkan has such a cache.
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
    let Some(adapter) = adapters.iter().find(|a| a.features().contains(wgpu::Features::PIPELINE_CACHE)) else {
        assert!(adapters.is_empty(), "a Vulkan driver without a pipeline cache");
        return;
    };
    let gpu = open(adapter);
    let folder = tempfile::tempdir().unwrap();
    let catalog = Arc::new(Catalog::load(shadewright_modules::library()).unwrap());
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/scenes/first.scene.ron");
    let frame = SceneFile::read(Path::new(scene)).unwrap().frame(&catalog, Some([32, 18])).unwrap();
    let draw = |made: Option<wgpu::PipelineCache>| {
        let mut renderer = Renderer::with_cache(&gpu, Arc::clone(&catalog), made);
        renderer.render(&frame)?.read_hdr(&gpu)
    };
    let expected = draw(None).unwrap();
    let empty = cache_of(&gpu, None);
    let first = draw(Some(empty.clone())).unwrap();
    assert!(cache::store(folder.path(), gpu.info(), &empty).unwrap());
    let data = cache::load(folder.path(), gpu.info()).unwrap();
    assert_eq!(Some(&data), empty.get_data().as_ref());
    let again = draw(Some(cache_of(&gpu, Some(&data)))).unwrap();
    assert!(first == expected && again == expected);
    // A driver that keeps nothing does not show whether its cache is used. One of another device is refused where it is.
    let other = cache_of(&open(adapter), None);
    let refused = draw(Some(other)).map(drop);
    assert!(matches!(refused, Err(RuntimeError::Gpu(GpuError::Invalid { .. }))), "{refused:?}");
}
