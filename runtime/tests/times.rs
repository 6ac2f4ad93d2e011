//! What a frame's passes cost, told by the GPU.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::{Arc, LazyLock};
use std::time::Instant;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::{Frame, Renderer};
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::scene::SceneFile;

static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap());
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::load(shadewright_modules::library()).unwrap()));

/// Two lamps and a sun with shadow maps, and a post effect with compute passes.
const SCENE: &str = r#"(
    camera: (eye: (0.0, 2.0, 6.0), target: (0.0, 0.5, 0.0)),
    size: (64, 48),
    pass: "forward",
    display: "display",
    post: [(module: "tonemap", fill: {"exposure": "log-average"})],
    meshes: {"ball": Sphere(radius: 0.5), "floor": Plane(size: (8.0, 8.0))},
    materials: {
        "copper": {"material": (module: "metalness", params: {"metalness": 1.0}), "brdf": "microfacet"},
        "chalk": {"material": "metalness", "brdf": "lambert"},
    },
    lights: [
        (module: "point", fields: {"position": (2.0, 3.0, 2.0), "intensity": 500.0}, visibility: Some((module: "cube-map", params: {"resolution": 64}))),
        (module: "point", fields: {"position": (-2.0, 3.0, 2.0), "intensity": 500.0}, visibility: Some((module: "cube-map", params: {"resolution": 64}))),
        (module: "directional", fields: {"direction": (-1.0, -2.0, -1.0), "illuminance": 1000.0},
            visibility: Some((module: "perspective", params: {"resolution": 64}))),
    ],
    objects: [
        (mesh: "floor", material: "chalk"),
        (mesh: "ball", material: "copper", translate: (0.0, 0.5, 0.0)),
    ],
)"#;

fn frame(text: &str) -> Frame {
    let file = SceneFile::parse("test", text, Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    file.frame(&CATALOG, None).unwrap_or_else(|e| panic!("{e}"))
}

/// Catches a pass without a time, times under another pass's name or another frame's, and queries where nobody asked for any.
#[test]
fn every_pass_has_its_time() {
    let frame = frame(SCENE);
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    let plain = renderer.render(&frame).unwrap().read_display(&GPU).unwrap();
    assert_eq!((renderer.take_times(), renderer.wait_for_times().unwrap()), (None, None), "off");
    renderer.time_passes(true).unwrap();
    assert_eq!(renderer.wait_for_times().unwrap(), None, "no frame yet");
    let start = Instant::now();
    let timed = renderer.render(&frame).unwrap();
    let times = renderer.wait_for_times().unwrap().unwrap();
    let wall = start.elapsed();
    assert_eq!(timed.read_display(&GPU).unwrap(), plain, "the same picture");
    let mut expected: Vec<String> = Vec::new();
    for light in 1..=2 {
        expected.extend((1..=6).map(|view| format!("shadow map of point {light}, view {view} of 6")));
    }
    expected.push("shadow map of directional".into());
    expected.push("scene (forward)".into());
    expected.extend(["sum", "mean"].map(|pass| format!("log_average.{pass}")));
    expected.push("display (display)".into());
    let names: Vec<&str> = times.passes.iter().map(|pass| pass.name.as_str()).collect();
    assert_eq!(names, expected);
    assert!(times.passes.iter().all(|pass| pass.nanoseconds > 0.0), "{times:?}");
    let sum: f64 = times.passes.iter().map(|pass| pass.nanoseconds).sum();
    assert!(sum < wall.as_secs_f64() * 1e9, "{sum} ns of {wall:?}");
    assert!(times.cpu.record > std::time::Duration::ZERO && times.cpu.record < wall);
    assert_eq!(renderer.wait_for_times().unwrap(), None, "taken already");
    renderer.time_passes(false).unwrap();
    renderer.render(&frame).unwrap();
    assert_eq!(renderer.take_times(), None, "off again");
}

/// Catches a frame's times that are given for another's when more frames are under way than are waited for, and linking that is charged to
/// the frame after.
#[test]
fn times_come_in_the_order_of_frames() {
    let (frame, small) = (
        frame(SCENE),
        frame(&SCENE.replace("post: [(module: \"tonemap\", fill: {\"exposure\": \"log-average\"})]", "post: []")),
    );
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    renderer.time_passes(true).unwrap();
    for drawn in [&frame, &small, &frame, &frame, &small] {
        renderer.render(drawn).unwrap();
    }
    let mut passes = Vec::new();
    let mut links = Vec::new();
    while let Some(times) = renderer.wait_for_times().unwrap() {
        passes.push(times.passes.len());
        links.push(times.cpu.link);
    }
    assert_eq!(passes, [17, 15, 15], "the first two and the last");
    assert!(links[0] > links[2], "the first frame links, the last has everything: {links:?}");
}

/// Catches timers that break with a frame that fails: the queries that it began would be waited for without end.
#[test]
fn a_frame_that_fails_breaks_no_timer() {
    let good = frame(SCENE);
    let mut bad = good.clone();
    let mut mesh = (*bad.draws[0].mesh).clone();
    mesh.normals.pop();
    bad.draws[0].mesh = Arc::new(mesh);
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    renderer.time_passes(true).unwrap();
    assert!(matches!(renderer.render(&bad), Err(RuntimeError::Data(_))));
    renderer.render(&good).unwrap();
    let times = renderer.wait_for_times().unwrap().unwrap();
    assert_eq!(times.passes.len(), 17);
    assert_eq!(renderer.wait_for_times().unwrap(), None);
}

/// Catches a wall clock that passes for the GPU's, and a renderer that needs timestamps for drawing.
#[test]
fn a_device_without_timestamps_says_so() {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()));
    let adapter = adapters.into_iter().find(|adapter| adapter.get_info() == *GPU.info()).unwrap();
    let request = adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: adapter.limits(),
        ..Default::default()
    });
    let (device, queue) = pollster::block_on(request).unwrap();
    let gpu = Gpu::from_parts(device, queue);
    let mut renderer = Renderer::new(&gpu, Arc::clone(&CATALOG));
    let expected = format!("timing passes needs timestamp queries on {}, which is not there", gpu.name());
    assert_eq!(renderer.time_passes(true).unwrap_err().to_string(), expected);
    renderer.render(&frame(SCENE)).unwrap();
    assert_eq!(renderer.wait_for_times().unwrap(), None);
    assert_eq!(gpu.check(), Ok(()));
}
