//! What a scene will need, known without a GPU, and made before its first frame.

#![allow(clippy::unwrap_used)]

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::{Arc, LazyLock, Mutex};

use shadewright_compiler::{Catalog, Recipe};
use shadewright_runtime::frame::{Frame, Need, PipelineState, Renderer, Stage, needs};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::SceneFile;

static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap());
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::load(shadewright_modules::library()).unwrap()));

/// Two kinds of lights with shadow maps, a post effect with compute passes, an object behind the camera, and one that only casts.
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
        "unseen": {"material": (module: "metalness", freeze: {"roughness": 0.125}), "brdf": "microfacet"},
    },
    lights: [
        (module: "point", fields: {"position": (2.0, 3.0, 2.0), "intensity": 500.0}, visibility: Some((module: "cube-map", params: {"resolution": 64}))),
        (module: "directional", fields: {"direction": (-1.0, -2.0, -1.0), "illuminance": 1000.0},
            visibility: Some((module: "perspective", params: {"resolution": 64}, fill: {"filtering": "pcf"}))),
    ],
    objects: [
        (mesh: "floor", material: "chalk"),
        (mesh: "ball", material: "copper", translate: (0.0, 0.5, 0.0)),
        (mesh: "ball", material: "unseen", translate: (0.0, 0.5, 30.0)),
        (mesh: "ball", material: "chalk", translate: (1.0, 0.5, 0.0), visible: false),
    ],
)"#;

fn frame(text: &str) -> Frame {
    let file = SceneFile::parse("test", text, Path::new("")).unwrap_or_else(|e| panic!("{e}"));
    file.frame(&CATALOG, None).unwrap_or_else(|e| panic!("{e}"))
}

fn pipelines(needs: &[Need]) -> usize {
    let mut keys: Vec<_> = needs
        .iter()
        .map(|n| (n.hash, n.state.clone(), format!("{:?}", n.constants)))
        .collect();
    keys.sort_by_key(|key| format!("{key:?}"));
    keys.dedup();
    keys.len()
}

/// Catches a need that is left out, out of order, or other than what `compile` gives for its recipe and pass.
#[test]
fn needs_are_known_without_a_gpu() {
    let frame = frame(SCENE);
    let needs = needs(&CATALOG, &frame).unwrap();
    let (seen, unseen): (Vec<_>, Vec<_>) = needs.iter().partition(|n| n.in_view);
    let stages: Vec<_> = seen.iter().map(|n| n.stage).collect();
    assert!(stages.is_sorted(), "{stages:?}");
    let count = |stage| stages.iter().filter(|s| **s == stage).count();
    assert_eq!(
        count(Stage::ShadowMap),
        1,
        "one program draws all casters: they are made of the same geometry"
    );
    assert_eq!(count(Stage::Scene), 2, "chalk and copper");
    assert_eq!((count(Stage::Before), count(Stage::After), count(Stage::Display)), (0, 2, 1));
    assert_eq!(unseen.len(), 1, "the ball behind the camera");
    assert_eq!(unseen[0].recipe, *frame.materials[frame.draws[2].material].recipe);
    assert_eq!(
        needs.iter().position(|n| !n.in_view),
        Some(needs.len() - 1),
        "what is out of view comes last"
    );
    for need in &needs {
        let program = CATALOG.compile(&Recipe::from(need.recipe.clone()), &need.pass).unwrap();
        assert_eq!(program.hash(), need.hash);
        assert_eq!(
            matches!(need.state, PipelineState::Compute(_)),
            matches!(need.stage, Stage::Before | Stage::After)
        );
    }
    let copper = needs.iter().find(|n| n.modules.contains(&"brdf/microfacet".to_owned())).unwrap();
    assert!(copper.modules.contains(&"filtering/pcf".to_owned()) && copper.modules.contains(&"pass/forward".to_owned()));
}

/// Catches a pipeline that `prepare` forgets, so that the first frame makes it, or one that the list of needs does not have.
#[test]
fn after_prepare_no_frame_makes_a_pipeline() {
    let frame = frame(SCENE);
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    let needs = renderer.needs(&frame).unwrap();
    assert_eq!(renderer.pipeline_counts().misses, 0, "to say what is needed makes nothing");
    let prepared = renderer.prepare(&frame).unwrap();
    assert_eq!(prepared.pipelines, pipelines(&needs));
    assert_eq!((prepared.made, prepared.complete), (pipelines(&needs), true));
    assert_eq!(renderer.pipeline_counts().misses, prepared.made);
    let targets = renderer.render(&frame).unwrap();
    let mut turned = frame.clone();
    turned.camera.view =
        glam::camera::rh::view::look_at_mat4(glam::Vec3::new(0.0, 2.0, 6.0), glam::Vec3::new(0.0, 0.0, 30.0), glam::Vec3::Y);
    renderer.render(&turned).unwrap();
    assert_eq!(
        renderer.pipeline_counts().misses,
        prepared.made,
        "neither the first frame nor a turned camera makes one"
    );
    let fresh = Renderer::new(&GPU, Arc::clone(&CATALOG)).render(&frame).unwrap();
    assert_eq!(targets.read_hdr(&GPU).unwrap(), fresh.read_hdr(&GPU).unwrap());
    let display = targets.read_display(&GPU).unwrap();
    assert_eq!(
        display,
        fresh.read_display(&GPU).unwrap(),
        "buffers that compute passes keep are as new"
    );
    let again = renderer.prepare(&frame).unwrap();
    assert_eq!((again.pipelines, again.made), (prepared.pipelines, 0));
}

/// Catches progress that jumps, goes back or ends early, and a stop that is not heard.
#[test]
fn a_preparation_tells_of_its_steps_and_can_be_stopped() {
    let frame = frame(SCENE);
    let heard = Mutex::new(Vec::new());
    let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
    let prepared = renderer
        .prepare_with(&frame, |progress| {
            heard.lock().unwrap().push((progress.done, progress.total));
            ControlFlow::Continue(())
        })
        .unwrap();
    let total = 2 * prepared.pipelines;
    let heard = heard.into_inner().unwrap();
    assert_eq!(heard, (1..=total).map(|done| (done, total)).collect::<Vec<_>>());

    for stop in [1, prepared.pipelines + 1] {
        let mut renderer = Renderer::new(&GPU, Arc::clone(&CATALOG));
        let last = Mutex::new(0);
        let stopped = renderer
            .prepare_with(&frame, |progress| {
                *last.lock().unwrap() = progress.done;
                if progress.done >= stop {
                    ControlFlow::Break(())
                } else {
                    ControlFlow::Continue(())
                }
            })
            .unwrap();
        assert!(!stopped.complete);
        let last = last.into_inner().unwrap();
        assert!(last < total, "stopped at {stop}, went on to {last} of {total}");
        assert!(
            stop == 1 || last == stop,
            "one after another is drawn with: stopped at {stop}, went on to {last}"
        );
        assert!(stop > 1 || stopped.made < prepared.made, "{stopped:?}");
        assert!(renderer.prepare(&frame).unwrap().complete);
        assert_eq!(renderer.pipeline_counts().misses, prepared.made, "the second one makes the rest");
    }
}

/// Catches a recipe that links to something else while another thread parses the same modules: two instances of a module would then
/// have two copies of its types.
#[test]
fn what_is_compiled_at_once_is_what_is_compiled_alone() {
    let kind = |radius: u32| {
        format!(
            r#"(module: "point", fill: {{"visibility": (module: "cube-map", fill: {{"filtering": (module: "pcf", freeze: {{"radius": {radius}}})}})}})"#
        )
    };
    let lights = [kind(1), kind(1).replace("\"point\"", "\"point\", label: \"b\""), kind(2)].join(", ");
    let recipe = Recipe::parse(
        "test",
        &format!(r#"(module: "forward", fill: {{"brdf": "microfacet", "lights": [{lights}]}})"#),
    )
    .unwrap();
    let alone = CATALOG.compile(&recipe, "main").unwrap().hash();
    for _ in 0..20 {
        let catalog = Catalog::load(shadewright_modules::library()).unwrap();
        let start = std::sync::Barrier::new(4);
        let compile = || {
            start.wait();
            catalog.compile(&recipe, "main").unwrap().hash()
        };
        let hashes = std::thread::scope(|scope| {
            let threads = [(); 4].map(|()| scope.spawn(compile));
            threads.map(|thread| thread.join().unwrap())
        });
        assert_eq!(hashes, [alone; 4]);
    }
}
