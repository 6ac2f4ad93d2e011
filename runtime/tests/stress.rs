//! A renderer under many edits, threads, failures and losses.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

use shadewright_compiler::manifest::Value;
use shadewright_compiler::{Catalog, Library, Recipe};
use shadewright_runtime::frame::{Fallbacks, Frame, Part, Renderer};
use shadewright_runtime::gpu::{Gpu, GpuError, RuntimeError};
use shadewright_runtime::scene::SceneFile;

static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap());
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::load(shadewright_modules::library()).unwrap()));

const SCENE: &str = r#"(
    camera: (eye: (0.0, 2.0, 6.0), target: (0.0, 0.5, 0.0)),
    size: (32, 24),
    pass: "forward",
    display: "display",
    post: ["tonemap"],
    meshes: {"ball": Sphere(radius: 0.7), "floor": Plane(size: (6.0, 6.0))},
    materials: {
        "first": {"material": (module: "metalness", freeze: {"roughness": 0.25}), "brdf": "microfacet"},
        "second": {"material": "metalness", "brdf": "lambert"},
    },
    lights: [(module: "directional", fields: {"direction": (-1.0, -2.0, -1.0), "illuminance": 1000.0},
        visibility: Some((module: "perspective", params: {"resolution": 32})))],
    objects: [(mesh: "ball", material: "first"), (mesh: "floor", material: "second")],
)"#;

fn frame() -> Frame {
    let file = SceneFile::parse("test", SCENE, Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    file.frame(&CATALOG, None).unwrap_or_else(|e| panic!("{e}"))
}

/// The frame after an edit: another frozen roughness, or the materials in another order.
fn edited(edit: usize) -> Frame {
    let mut frame = frame();
    let mut recipe = (*frame.materials[0].recipe).clone();
    let filling = recipe.fill.get_mut("material").unwrap();
    let node = match filling {
        shadewright_compiler::manifest::Filling::One(node) => node,
        shadewright_compiler::manifest::Filling::Many(_) => panic!("one material"),
    };
    node.freeze
        .insert("roughness".into(), Value::Number(0.2 + 0.05 * (edit % 12) as f64));
    frame.materials[0].recipe = Arc::new(recipe);
    if edit % 3 == 2 {
        frame.materials.swap(0, 1);
        frame.draws.iter_mut().for_each(|draw| draw.material = 1 - draw.material);
    }
    frame
}

fn fresh(frame: &Frame) -> Vec<[f32; 4]> {
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    renderer.render(frame).unwrap().read_hdr(&GPU).unwrap()
}

/// Catches a picture of an earlier edit, a part that is late for ever, and work for edits that nobody waits for any more.
#[test]
fn many_edits_settle_to_the_last() {
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    let fallbacks = Fallbacks::default();
    let general = renderer.fallback_frame(&frame(), &fallbacks);
    renderer.prepare(&general).unwrap();
    for edit in 0..24 {
        let (_, late) = renderer.render_now(&edited(edit), &fallbacks).unwrap();
        assert!(late.iter().all(|late| late.error.is_none()), "{late:?}");
        if edit % 7 == 0 {
            renderer.cancel();
        }
    }
    let last = edited(23);
    assert!(renderer.settle(&last, &fallbacks).unwrap().is_empty());
    let (targets, late) = renderer.render_now(&last, &fallbacks).unwrap();
    assert!(late.is_empty());
    assert_eq!(targets.read_hdr(&GPU).unwrap(), fresh(&last));
}

/// Catches renderers on one device that wait for each other, take each other's errors, or mix up pictures.
#[test]
fn two_renderers_share_a_device() {
    std::thread::scope(|scope| {
        for number in 0..2 {
            scope.spawn(move || {
                let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
                let fallbacks = Fallbacks::default();
                for edit in 0..6 {
                    renderer.render_now(&edited(edit * 2 + number), &fallbacks).unwrap();
                }
                let mut last = edited(4 + number);
                assert!(renderer.settle(&last, &fallbacks).unwrap().is_empty());
                let now = renderer.render_now(&last, &fallbacks).unwrap().0;
                assert_eq!(now.read_hdr(&GPU).unwrap(), fresh(&last));
                // The other one's frames go on.
                let wrong = Recipe::parse("test", r#"(module: "forward", fill: {"brdf": "no-such-thing"})"#).unwrap();
                last.materials[0].recipe = Arc::new(wrong.root);
                renderer.settle(&last, &fallbacks).unwrap();
            });
        }
    });
}

/// Catches a lost device that is waited for, that hangs a drop, or that comes back as another error.
#[test]
fn a_lost_device_ends_the_waiting() {
    for settle in [false, true] {
        let gpu = Gpu::headless().unwrap();
        let mut renderer = Renderer::new(&gpu, Arc::clone(&CATALOG));
        renderer.render_now(&frame(), &Fallbacks::default()).unwrap();
        gpu.device().destroy();
        let begun = Instant::now();
        let error = loop {
            let result = match settle {
                true => renderer.settle(&frame(), &Fallbacks::default()).map(drop),
                false => renderer.render_now(&frame(), &Fallbacks::default()).map(drop),
            };
            match result {
                Err(error) => break error,
                Ok(()) => assert!(begun.elapsed() < Duration::from_secs(20), "nobody noticed, settle: {settle}"),
            }
        };
        assert!(matches!(error, RuntimeError::Gpu(GpuError::Lost(_))), "{error}");
        drop(renderer);
        let again = Gpu::headless().unwrap();
        let mut renderer = Renderer::new(&again, Arc::clone(&CATALOG));
        let fallbacks = Fallbacks::default();
        assert!(renderer.settle(&frame(), &fallbacks).unwrap().is_empty());
        let now = renderer.render_now(&frame(), &fallbacks).unwrap().0;
        assert_eq!(now.read_hdr(&again).unwrap(), fresh(&frame()));
    }
}

/// The standard library, which panics once when a BRDF is read.
struct Panics(Arc<dyn Library>, AtomicBool);

impl Library for Panics {
    fn folders(&self, folder: &str) -> Vec<String> {
        self.0.folders(folder)
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        if path == "brdf/microfacet/microfacet.wgsl" && self.1.swap(false, Ordering::SeqCst) {
            panic!("planted");
        }
        self.0.read(path)
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        self.0.bytes(path)
    }
}

/// Catches a panic in the background that takes the frame along, hangs whoever waits, or leaves locks that nobody gets past.
#[test]
fn a_panic_in_the_background_is_an_error() {
    let library = Panics(shadewright_modules::library(), AtomicBool::new(true));
    let mut renderer = Renderer::new(&GPU, Arc::new(Catalog::load(Arc::new(library)).unwrap()));
    let (frame, fallbacks) = (frame(), Fallbacks::default());
    let late = renderer.settle(&frame, &fallbacks).unwrap();
    assert_eq!(late.len(), 1, "{late:?}");
    assert_eq!((late[0].part, late[0].compiling), (Part::Material(0), false));
    assert!(late[0].error.as_ref().unwrap().to_string().contains("panicked"));
    renderer.cancel();
    assert!(renderer.settle(&frame, &fallbacks).unwrap().is_empty());
    let now = renderer.render_now(&frame, &fallbacks).unwrap().0;
    assert_eq!(now.read_hdr(&GPU).unwrap(), fresh(&frame));
}
