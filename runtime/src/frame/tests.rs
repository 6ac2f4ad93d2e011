//! The renderer with passes of its own, so that every texel is known.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use shadewright_compiler::manifest::Node;

use super::jobs::{Job, Task};
use super::{Bounds, Camera, Draw, Fallback, Fallbacks, Frame, Material, Mesh, Part, Renderer, Settings};
use crate::gpu::testing::{catalog, gpu};
use crate::gpu::{Gpu, GpuError, RuntimeError};

/// Writes the object's own position into the frame, with the opacity .25; members of `Frame` and `Object` are partly left out.
const FORWARD: &str = "
    struct In { @builtin(instance_index) object: u32, @location(0) position: vec3f }
    struct Out { @builtin(position) clip: vec4f, @location(0) @interpolate(flat) place: vec3f }
    struct Color { @location(0) color: vec4f }
    @vertex fn vertex_main(in: In) -> Out {
        let model = objects[in.object].model;
        return Out(frame.view_projection * model * vec4f(in.position, 1.0), model[3].xyz + vec3f(0.0, frame.size.x, 0.0));
    }
    @fragment fn fragment_main(in: Out) -> Color { return Color(vec4f(in.place, 0.25)); }";

const DISPLAY_PASS: &str = "
    struct In { @builtin(vertex_index) i: u32 }
    struct At { @builtin(position) at: vec4f }
    struct Color { @location(0) color: vec4f }
    @vertex fn vertex_main(in: In) -> At {
        return At(vec4f(f32(in.i & 1u) * 4.0 - 1.0, f32(in.i >> 1u) * 4.0 - 1.0, 0.0, 1.0));
    }
    @fragment fn fragment_main(in: At) -> Color {
        return Color(vec4f(textureLoad(hdr, vec2u(in.at.xy), 0).rgb / 20.0, 1.0));
    }";

const COUNT_RON: &str = r#"(
    summary: "tested",
    resources: {"total": (kind: Buffer(bytes: 4), doc: "tested")},
    passes: {"add": Compute(entry: "add", over: Once)},
)"#;

/// Shows how often its compute pass ran, in 255ths.
const COUNT: &str = "
    struct In { @builtin(vertex_index) i: u32 }
    struct At { @builtin(position) at: vec4f }
    struct Color { @location(0) color: vec4f }
    struct Total { frames: u32 }
    var<storage, read_write> total: Total;
    @compute @workgroup_size(1) fn add() { total.frames += 1u; }
    @vertex fn vertex_main(in: In) -> At {
        return At(vec4f(f32(in.i & 1u) * 4.0 - 1.0, f32(in.i >> 1u) * 4.0 - 1.0, 0.0, 1.0));
    }
    @fragment fn fragment_main() -> Color { return Color(vec4f(f32(total.frames) / 255.0)); }";

fn renderer(gpu: &Gpu) -> Renderer {
    let textured = FORWARD
        .replace("position: vec3f }", "position: vec3f, @location(3) uv: vec2f }")
        .replace("in.position,", "in.position + in.uv.xxx,");
    let wrong = FORWARD
        .replace("color: vec4f", "color: vec4u")
        .replace("vec4f(in.place, 0.25)", "vec4u(vec3u(in.place), 1u)");
    let catalog = catalog(&[
        ("pass/flat/module.ron", "(summary: \"tested\")"),
        ("pass/flat/flat.wgsl", FORWARD),
        ("pass/show/module.ron", "(summary: \"tested\", uses: [\"post\"])"),
        ("pass/show/show.wgsl", DISPLAY_PASS),
        ("pass/count/module.ron", COUNT_RON),
        ("pass/count/count.wgsl", COUNT),
        ("pass/wrong/module.ron", "(summary: \"tested\")"),
        ("pass/wrong/wrong.wgsl", &wrong),
        ("pass/textured/module.ron", "(summary: \"tested\")"),
        ("pass/textured/textured.wgsl", &textured),
    ]);
    Renderer::new(gpu, catalog)
}

fn material(recipe: &str) -> Material {
    Material {
        recipe: Arc::new(Node::new(recipe)),
        settings: Settings::default(),
    }
}

/// A square with corners at +-1 that faces +z.
fn square() -> Arc<Mesh> {
    Arc::new(Mesh {
        positions: vec![[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Default::default()
    })
}

fn draw(mesh: &Arc<Mesh>, model: Mat4) -> Draw {
    Draw {
        mesh: Arc::clone(mesh),
        material: 0,
        model,
        bounds: Bounds {
            min: Vec3::new(-1.0, -1.0, 0.0),
            max: Vec3::new(1.0, 1.0, 0.0),
        },
        visible: true,
        alpha_blend: false,
        double_sided: false,
        casts_shadow: true,
    }
}

/// An orthographic camera at z = 10: a target of 8 x 8 texels over 8 x 8 m.
fn frame(draws: Vec<Draw>) -> Frame {
    Frame {
        camera: Camera {
            view: Mat4::from_translation(Vec3::new(0.0, 0.0, -10.0)),
            projection: glam::camera::rh::proj::directx::orthographic(-4.0, 4.0, -4.0, 4.0, 0.1, 100.0),
        },
        size: [8, 8],
        time: 0.0,
        background: Vec3::new(0.5, 0.0, 0.0),
        materials: vec![material("flat")],
        draws,
        lights: vec![],
        display: Some(material("show")),
    }
}

fn at(x: f32, y: f32, z: f32) -> Mat4 {
    Mat4::from_translation(Vec3::new(x, y, z))
}

/// The texel that shows (x, y, 0).
fn texel(image: &[[f32; 4]], x: f32, y: f32) -> [f32; 4] {
    image[((4.0 - y) as usize) * 8 + (x + 4.0) as usize]
}

/// Catches wrong transforms of instances, depth order, culling, blending, background, and rows upside down.
#[test]
fn squares_stand_where_they_should() {
    let mesh = square();
    let turned = at(2.5, -2.5, 0.0) * Mat4::from_rotation_y(std::f32::consts::PI);
    let blended = Draw {
        alpha_blend: true,
        ..draw(&mesh, at(-2.5, -2.5, 3.0))
    };
    let mirrored = at(0.0, 0.0, 0.0) * Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    let draws = vec![
        draw(&mesh, at(-2.5, 2.5, -1.0)),
        draw(&mesh, at(-2.5, 2.5, -2.0)),
        draw(&mesh, at(2.5, 2.5, 1.0)),
        draw(&mesh, turned),
        blended,
        draw(&mesh, mirrored),
    ];
    let mut renderer = renderer(&gpu());
    let frame = frame(draws);
    renderer.prepare(&frame).unwrap();
    assert_eq!(renderer.pipeline_counts().misses, 4, "scene, blended, mirrored, display");
    let targets = renderer.render(&frame).unwrap();
    let hdr = targets.read_hdr(&gpu()).unwrap();
    assert_eq!(texel(&hdr, -2.5, 2.5), [-2.5, 10.5, -1.0, 0.25], "the nearer one, first row on top");
    assert_eq!(texel(&hdr, 2.5, 2.5), [2.5, 10.5, 1.0, 0.25]);
    assert_eq!(texel(&hdr, 2.5, -2.5), [0.5, 0.0, 0.0, 1.0], "seen from behind");
    assert_eq!(texel(&hdr, 0.0, 0.0)[1], 8.0, "mirrored, still seen from the front");
    let mix = texel(&hdr, -2.5, -2.5);
    assert_eq!(mix[..3], [0.25 * -2.5 + 0.75 * 0.5, 0.25 * 5.5, 0.25 * 3.0]);
    let display = targets.read_display(&gpu()).unwrap().unwrap();
    assert_eq!(display[(8 + 6) * 4..][..4], [32, 134, 13, 255]);
    assert_eq!(renderer.pipeline_counts().misses, 4, "all was there");
    let again = renderer.render(&frame).unwrap();
    assert_eq!(again.read_hdr(&gpu()).unwrap(), hdr);
    assert_eq!(renderer.pipeline_counts().misses, 4);
}

/// Catches a panic or a silent picture where the frame's parts do not fit.
#[test]
fn bad_frames_are_errors() {
    let mut renderer = renderer(&gpu());
    let mesh = square();
    let mut fail = |change: &dyn Fn(&mut Frame)| {
        let mut frame = frame(vec![draw(&mesh, Mat4::IDENTITY)]);
        change(&mut frame);
        renderer.render(&frame).unwrap_err().to_string()
    };
    assert_eq!(fail(&|f| f.draws[0].material = 3), "draws[0].material: material 3 of 1");
    assert_eq!(fail(&|f| f.draws[0].model.x_axis.x = f32::NAN), "draws[0].model: is not finite");
    assert_eq!(fail(&|f| f.draws[0].bounds.max.y = f32::INFINITY), "draws[0].bounds: is not finite");
    assert_eq!(fail(&|f| f.camera.view.x_axis.x = f32::NAN), "camera: is not finite");
    assert!(fail(&|f| f.size = [0, 4]).starts_with("size: 0 x 4 texels"));
    assert!(fail(&|f| f.size = [4_000_000, 4]).starts_with("size: 4000000 x 4 texels"));
    let with = |positions: usize, indices: Vec<u32>| {
        Arc::new(Mesh {
            positions: vec![[0.0; 3]; positions],
            indices,
            ..Default::default()
        })
    };
    assert_eq!(
        fail(&|f| f.draws[0].mesh = with(3, vec![0, 1, 3])),
        "draws[0].mesh: index 3 in a mesh of 3 vertices"
    );
    assert_eq!(
        fail(&|f| f.draws[0].mesh = with(3, vec![0, 1])),
        "draws[0].mesh: 2 indices are no triangles"
    );
    let uneven = Mesh {
        normals: vec![[0.0; 3]; 2],
        ..Mesh::clone(&mesh)
    };
    assert_eq!(
        fail(&|f| f.draws[0].mesh = Arc::new(uneven.clone())),
        "draws[0].mesh: 2 normals for 4 vertices"
    );
    let mut textured = frame(vec![draw(&mesh, Mat4::IDENTITY)]);
    textured.materials = vec![material("textured")];
    let error = renderer.render(&textured).unwrap_err().to_string();
    assert_eq!(error, "draws[0].mesh: has no texture coordinates, which the recipe reads");
}

/// Catches a loss that panics or hangs, and a new device that draws another frame.
#[test]
fn lost_device_is_an_error_and_a_new_one_draws_the_same() {
    let frame = frame(vec![draw(&square(), Mat4::IDENTITY)]);
    let draw_on = |gpu: &Gpu| renderer(gpu).render(&frame).and_then(|t| t.read_hdr(gpu));
    let gpu = Gpu::headless().unwrap();
    let before = draw_on(&gpu).unwrap();
    let mut renderer = renderer(&gpu);
    let targets = renderer.render(&frame).unwrap();
    gpu.device().destroy();
    for result in [
        targets.read_hdr(&gpu).map(drop),
        renderer.render(&frame).map(drop),
        draw_on(&gpu).map(drop),
    ] {
        assert!(matches!(result, Err(RuntimeError::Gpu(GpuError::Lost(_)))), "{result:?}");
    }
    assert_eq!(draw_on(&Gpu::headless().unwrap()).unwrap(), before);
}

/// Catches a preparation that leaves a trace in what modules keep from frame to frame, and buffers that are not kept.
#[test]
fn a_preparation_does_not_count_as_a_frame() {
    let mut frame = frame(vec![]);
    frame.display = Some(material("count"));
    let mut renderer = renderer(&gpu());
    let next = |renderer: &mut Renderer| renderer.render(&frame).unwrap().read_display(&gpu()).unwrap().unwrap()[0];
    renderer.prepare(&frame).unwrap();
    assert_eq!(next(&mut renderer), 1);
    renderer.prepare(&frame).unwrap();
    assert_eq!(next(&mut renderer), 2);
}

/// Catches buffers that stay on the GPU when no frame has their recipe any more.
#[test]
fn buffers_go_with_their_recipe() {
    let mut frame = frame(vec![]);
    frame.display = Some(material("count"));
    let mut renderer = renderer(&gpu());
    let next = |renderer: &mut Renderer, frame: &Frame| renderer.render(frame).unwrap().read_display(&gpu()).unwrap().unwrap()[0];
    assert_eq!((next(&mut renderer, &frame), next(&mut renderer, &frame)), (1, 2));
    let without = Frame {
        display: None,
        ..frame.clone()
    };
    renderer.render(&without).unwrap();
    assert_eq!(next(&mut renderer, &frame), 1);
}

/// Catches a fallback that is compiled while the special is, and takes its time.
#[test]
fn a_fallback_is_made_only_where_nothing_better_comes() {
    let mut renderer = renderer(&gpu());
    let mut frame = frame(vec![draw(&square(), at(0.0, 0.0, -1.0))]);
    frame.display = None;
    let fallbacks = Fallbacks {
        otherwise: vec![Fallback::Material(material("show")), Fallback::Material(material("count"))],
        ..Fallbacks::default()
    };
    assert!(renderer.settle(&frame, &fallbacks).unwrap().is_empty());
    let there = |name| renderer.programs.find(&Node::new(name), "main").is_some();
    assert!(there("flat") && !there("show") && !there("count"));
    assert_eq!(renderer.pipeline_counts().misses, 1);
}

/// Jobs that run until what is returned is dropped: as many as there can be threads.
fn hold(renderer: &mut Renderer) -> std::sync::mpsc::Sender<()> {
    let (go, wait) = std::sync::mpsc::channel::<()>();
    let wait = Arc::new(std::sync::Mutex::new(wait));
    let threads = std::thread::available_parallelism()
        .map_or(1, usize::from)
        .saturating_sub(1)
        .clamp(1, 8);
    let begun = Arc::new(std::sync::Barrier::new(threads + 1));
    let jobs = (0..threads).map(|i| -> (Task, Job) {
        let (begun, wait) = (Arc::clone(&begun), Arc::clone(&wait));
        let job = move || {
            begun.wait();
            let _ = crate::gpu::lock(&wait).recv();
            Ok(())
        };
        (Task::Program(format!("held {i}"), String::new()), Box::new(job))
    });
    renderer.jobs.want(jobs.collect()).unwrap();
    begun.wait();
    go
}

/// Catches a frame that waits for the threads that compile, a cancelled special that is made all the same, and a frame after that which
/// does not ask for it again.
#[test]
fn a_cancelled_special_is_made_when_it_is_asked_for_again() {
    let mut renderer = renderer(&gpu());
    let mut frame = frame(vec![draw(&square(), at(0.0, 0.0, -1.0))]);
    frame.display = None;
    let general = frame.clone();
    renderer.prepare(&general).unwrap();
    frame.draws[0].double_sided = true;
    frame.materials = vec![material("textured")];
    let textured = Mesh {
        uvs: vec![[0.0; 2]; 4],
        ..Mesh::clone(&frame.draws[0].mesh)
    };
    frame.draws[0].mesh = Arc::new(textured);
    let mut flat = general.clone();
    flat.draws.clone_from(&frame.draws);
    renderer.prepare(&flat).unwrap();
    let there = renderer.pipeline_counts().misses;
    let fallbacks = Fallbacks {
        otherwise: vec![Fallback::Material(material("flat"))],
        ..Fallbacks::default()
    };
    let go = hold(&mut renderer);
    for _ in 0..2 {
        let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
        assert_eq!((late[0].part, late[0].shown, late[0].compiling), (Part::Material(0), Some(0), true));
        let hdr = targets.read_hdr(&gpu()).unwrap();
        assert_eq!(texel(&hdr, 0.0, 0.0), [0.0, 8.0, -1.0, 0.25], "the fallback's picture");
    }
    renderer.cancel();
    drop(go);
    renderer.jobs.wait();
    assert_eq!(renderer.pipeline_counts().misses, there);
    assert!(renderer.programs.find(&Node::new("textured"), "main").is_none());
    assert!(renderer.settle(&frame, &fallbacks).unwrap().is_empty());
    assert_eq!(renderer.pipeline_counts().misses, there + 1);
}

/// Catches wgpu's refusal of a special pipeline that comes as a failed frame, or not at all.
#[test]
fn a_pipeline_that_fails_is_reported_and_its_fallback_stays() {
    let mut renderer = renderer(&gpu());
    let mut frame = frame(vec![draw(&square(), at(0.0, 0.0, -1.0))]);
    frame.materials = vec![material("wrong")];
    let fallbacks = Fallbacks {
        otherwise: vec![Fallback::Material(material("flat"))],
        ..Fallbacks::default()
    };
    let late = renderer.settle(&frame, &fallbacks).unwrap();
    let error = late[0].error.as_deref();
    assert!(
        matches!(error, Some(RuntimeError::Gpu(GpuError::Invalid { what, .. })) if what == "render pipeline vertex_main"),
        "{error:?}"
    );
    assert_eq!((late.len(), late[0].shown, late[0].compiling), (1, Some(0), false));
    let hdr = renderer.render_now(&frame, &fallbacks).unwrap().0.read_hdr(&gpu()).unwrap();
    assert_eq!(texel(&hdr, 0.0, 0.0), [0.0, 8.0, -1.0, 0.25]);
    assert_eq!(gpu().check(), Ok(()));
}
