//! Frames that do not wait for a compiler: fallbacks until the right thing is there.

#![allow(clippy::unwrap_used)]

use std::collections::HashMap;
use std::path::Path;
use std::sync::{Arc, LazyLock};

use shadewright_compiler::{Catalog, Recipe};
use shadewright_runtime::frame::{Fallback, Fallbacks, Frame, Late, Material, Part, Renderer, Settings, Targets};
use shadewright_runtime::gpu::{Gpu, RuntimeError};
use shadewright_runtime::scene::SceneFile;

static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap());
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::load(shadewright_modules::library()).unwrap()));

/// Two balls over a floor: the first with a frozen roughness and colour, the rest with nothing frozen.
const SCENE: &str = r#"(
    camera: (eye: (0.0, 2.0, 6.0), target: (0.0, 0.5, 0.0)),
    size: (64, 48),
    background: (1.0, 2.0, 3.0),
    pass: "forward",
    display: "display",
    post: [(module: "tonemap", fill: {"exposure": "log-average"})],
    meshes: {"ball": Sphere(radius: 0.7), "floor": Plane(size: (6.0, 6.0))},
    materials: {
        "special": {"material": (module: "metalness", freeze: {"roughness": 0.25, "base_color": (0.9, 0.1, 0.2)}, params: {"emission": 40.0}), "brdf": "microfacet"},
        "plain": {"material": (module: "metalness", params: {"base_color": (0.1, 0.8, 0.2)}), "brdf": "lambert"},
    },
    lights: [(module: "directional", fields: {"direction": (-1.0, -2.0, -1.0), "illuminance": 1000.0},
        visibility: Some((module: "perspective", params: {"resolution": 64})))],
    objects: [
        (mesh: "ball", material: "special", translate: (-1.0, 0.5, 0.0)),
        (mesh: "ball", material: "plain", translate: (1.0, 0.5, 0.0)),
        (mesh: "floor", material: "plain"),
    ],
)"#;

const SPECIAL: Part = Part::Material(0);

fn frame() -> Frame {
    let file = SceneFile::parse("test", SCENE, Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    let frame = file.frame(&CATALOG, None).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(frame.materials.len(), 2);
    frame
}

fn renderer() -> Renderer {
    Renderer::new(&GPU, Arc::clone(&CATALOG))
}

type Picture = (Vec<[f32; 4]>, Option<Vec<u8>>);

fn picture(targets: &Targets) -> Picture {
    (targets.read_hdr(&GPU).unwrap(), targets.read_display(&GPU).unwrap())
}

/// As a renderer draws it that knows no fallbacks.
fn fresh(frame: &Frame) -> Picture {
    picture(&renderer().render(frame).unwrap())
}

fn parts(late: &[Late]) -> Vec<(Part, Option<usize>, bool)> {
    late.iter().map(|l| (l.part, l.shown, l.compiling)).collect()
}

fn only(fallback: Fallback) -> Fallbacks {
    Fallbacks {
        materials: HashMap::from([(0, vec![fallback])]),
        ..Fallbacks::default()
    }
}

/// Something that shows no light at all: the background's opposite.
fn black() -> Material {
    Material {
        recipe: Arc::new(
            Recipe::parse("test", r#"(module: "forward", fill: {"brdf": "lambert"})"#)
                .unwrap()
                .root,
        ),
        settings: Settings::default(),
    }
}

/// Catches a frame that waits, a fallback that is not drawn, values of frozen parameters that get lost when they thaw, and a special that
/// never takes over or is drawn otherwise for having come late.
#[test]
fn the_special_takes_over_from_the_thawed() {
    let (frame, fallbacks) = (frame(), Fallbacks::default());
    let mut renderer = renderer();
    let general = renderer.fallback_frame(&frame, &fallbacks);
    assert!(general.materials[0].recipe != frame.materials[0].recipe && general.materials[1].recipe == frame.materials[1].recipe);
    renderer.prepare(&general).unwrap();
    let there = renderer.pipeline_counts().misses;
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert_eq!(parts(&late), [(SPECIAL, Some(0), true)]);
    let first = picture(&targets);
    assert_eq!(first, fresh(&general), "the fallback's picture");
    assert!(renderer.settle(&frame, &fallbacks).unwrap().is_empty());
    assert_eq!(renderer.pipeline_counts().misses, there + 1, "one special pipeline");
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert!(late.is_empty(), "{late:?}");
    let last = picture(&targets);
    let special = fresh(&frame);
    assert_eq!(last.0, special.0, "the special's picture");
    let off = |(a, b): (&[f32; 4], &[f32; 4])| (0..3).map(|i| (a[i] - b[i]).abs() / b[i].max(1.0)).fold(0.0, f32::max);
    let worst = first.0.iter().zip(&last.0).map(off).fold(0.0, f32::max);
    assert!(worst < 1e-4, "thawed and frozen are the same material, but differ by {worst}");
}

/// Catches a fallback of the caller's that is passed over, drawn with the settings of the special, or mixed up with another's.
#[test]
fn a_named_fallback_is_drawn_with_its_own_settings() {
    let (frame, fallbacks) = (frame(), only(Fallback::Material(black())));
    let mut renderer = renderer();
    let general = renderer.fallback_frame(&frame, &fallbacks);
    let mut expected = frame.clone();
    expected.materials[0] = black();
    renderer.prepare(&general).unwrap();
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert_eq!(parts(&late), [(SPECIAL, Some(0), true)]);
    let first = picture(&targets);
    assert_eq!(first, fresh(&expected));
    renderer.settle(&frame, &fallbacks).unwrap();
    let last = picture(&renderer.render_now(&frame, &fallbacks).unwrap().0);
    assert_eq!(last.0, fresh(&frame).0);
    let black = |picture: &Picture| picture.0.iter().filter(|texel| **texel == [0.0, 0.0, 0.0, 1.0]).count();
    assert!(black(&first) > black(&last), "the fallback is black also where light falls");
}

/// Catches a frame without anything ready that fails, waits, or keeps quiet about what it leaves out.
#[test]
fn where_nothing_is_ready_parts_wait_and_say_so() {
    let (frame, fallbacks) = (frame(), Fallbacks::default());
    let mut renderer = renderer();
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert_eq!(
        parts(&late),
        [(SPECIAL, None, true), (Part::Material(1), None, true), (Part::Display, None, true)]
    );
    assert!(targets.display.is_none());
    let hdr = targets.read_hdr(&GPU).unwrap();
    assert!(hdr.iter().all(|texel| *texel == [1.0, 2.0, 3.0, 1.0]), "only background");
    assert!(renderer.settle(&frame, &fallbacks).unwrap().is_empty());
    let made = renderer.pipeline_counts().misses;
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert!(late.is_empty(), "{late:?}");
    assert_eq!(picture(&targets), fresh(&frame));
    assert_eq!(renderer.pipeline_counts().misses, made, "settled is settled");
}

/// Catches shadows that are missing without a word, or that keep an object from being drawn.
#[test]
fn shadows_come_late_without_their_object() {
    let frame = frame();
    let mut unshadowed = frame.clone();
    unshadowed.draws.iter_mut().for_each(|draw| draw.casts_shadow = false);
    assert!(fresh(&unshadowed).0 != fresh(&frame).0, "the shadows are seen");
    for linked in [false, true] {
        let mut renderer = renderer();
        renderer.prepare(&unshadowed).unwrap();
        if linked {
            // The program of the casters is there, their pipeline is not.
            renderer.needs(&frame).unwrap();
        }
        let (targets, late) = renderer.render_now(&frame, &Fallbacks::default()).unwrap();
        assert_eq!(parts(&late), [(Part::Shadows(0), None, true), (Part::Shadows(1), None, true)]);
        assert_eq!(targets.read_hdr(&GPU).unwrap(), fresh(&unshadowed).0);
        assert!(renderer.settle(&frame, &Fallbacks::default()).unwrap().is_empty());
        let targets = renderer.render_now(&frame, &Fallbacks::default()).unwrap().0;
        assert_eq!(targets.read_hdr(&GPU).unwrap(), fresh(&frame).0);
    }
}

/// Catches an error that is swallowed, that spoils the frame, or that is tried again and again.
#[test]
fn a_failing_special_leaves_its_fallback() {
    let mut frame = frame();
    let wrong = r#"(module: "forward", fill: {"brdf": "no-such-thing"})"#;
    frame.materials[0].recipe = Arc::new(Recipe::parse("test", wrong).unwrap().root);
    let fallbacks = only(Fallback::Material(black()));
    let mut renderer = renderer();
    let first = renderer.render_now(&frame, &fallbacks).unwrap().1;
    assert!(first.iter().all(|late| late.error.is_none() && late.shown.is_none()), "{first:?}");
    for _ in 0..2 {
        let late = renderer.settle(&frame, &fallbacks).unwrap();
        assert_eq!(
            parts(&late),
            [(SPECIAL, Some(0), false)],
            "its fallback was made, because nothing else will show it"
        );
        let error = late[0].error.as_ref().unwrap();
        assert!(
            matches!(&**error, RuntimeError::Compile(report) if report.diagnostics[0].code == "SW0201"),
            "{error}"
        );
    }
    let (targets, late) = renderer.render_now(&frame, &fallbacks).unwrap();
    assert_eq!(parts(&late), [(SPECIAL, Some(0), false)]);
    assert_eq!(picture(&targets).0, fresh(&renderer.fallback_frame(&frame, &fallbacks)).0);
    assert!(renderer.render(&frame).is_err(), "a frame that waits has nothing else to say");
    let alone = only(Fallback::Thawed);
    assert_eq!(
        parts(&renderer.settle(&frame, &alone).unwrap()),
        [(SPECIAL, None, false)],
        "nothing fits"
    );
}

/// Catches a drop that hangs on work that is queued or running.
#[test]
fn a_renderer_can_be_dropped_at_any_time() {
    let frame = frame();
    for wait in [0, 1, 5, 20] {
        let mut renderer = renderer();
        renderer.render_now(&frame, &Fallbacks::default()).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(wait));
        renderer.render_now(&frame, &Fallbacks::default()).unwrap();
        drop(renderer);
    }
}
