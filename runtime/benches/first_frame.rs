//! What the first frame of a scene costs, with and without `prepare`, against the second one: ratios of one run.
//!
//! `cargo bench -p shadewright-runtime --bench first_frame [-- SCENE]`. Every round opens a new device, so that nothing is left of the
//! round before but what the driver keeps on disk: `MESA_SHADER_CACHE_DISABLE=true` turns that off, `MESA_SHADER_CACHE_DIR` says where it is.

#![allow(clippy::expect_used, clippy::print_stdout)]

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::{Frame, Progress, Renderer};
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::SceneFile;

const ROUNDS: usize = 5;

/// How much is made beforehand.
#[derive(Clone, Copy)]
enum Before {
    Nothing,
    /// Stopped where the pipelines are made and nothing is drawn with them yet.
    Pipelines,
    Everything,
}

/// Seconds of one round: the preparation, the first frame, the second one.
fn round(catalog: &Arc<Catalog>, frame: &Frame, before: Before) -> [f64; 3] {
    let gpu = Gpu::headless().expect("a GPU");
    let mut renderer = Renderer::new(&gpu, Arc::clone(catalog));
    // Programs are linked beforehand in both cases: this is about pipelines.
    renderer.needs(frame).expect("a scene that can be drawn");
    let start = Instant::now();
    let until = |share: usize| {
        move |progress: Progress| {
            if progress.done * share >= progress.total {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
    };
    match before {
        Before::Nothing => {}
        Before::Pipelines => drop(renderer.prepare_with(frame, until(2)).expect("a scene that can be drawn")),
        Before::Everything => drop(renderer.prepare(frame).expect("a scene that can be drawn")),
    }
    let prepared = start.elapsed().as_secs_f64();
    let [first, second] = [(); 2].map(|()| {
        let start = Instant::now();
        renderer.render(frame).expect("a scene that can be drawn");
        gpu.wait().expect("a GPU that ends");
        start.elapsed().as_secs_f64()
    });
    [prepared, first, second]
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let given = std::env::args().skip(1).find(|a| a.ends_with(".ron")).map(PathBuf::from);
    let path = given.unwrap_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/scenes/first.scene.ron")));
    let catalog = Arc::new(Catalog::load(shadewright_modules::library()).expect("the library"));
    let scene = SceneFile::read(&path).expect("a scene");
    let frame = scene.frame(&catalog, None).expect("a scene");
    println!("{} on {}", path.display(), Gpu::headless().expect("a GPU").name());
    let (mut plain, mut pipelines, mut prepared) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..ROUNDS {
        plain.push(round(&catalog, &frame, Before::Nothing));
        pipelines.push(round(&catalog, &frame, Before::Pipelines));
        prepared.push(round(&catalog, &frame, Before::Everything));
    }
    let of = |rounds: &[[f64; 3]], i: usize| median(rounds.iter().map(|r| r[i]).collect());
    let second = of(&prepared, 2);
    println!(
        "medians of {ROUNDS}, milliseconds, and times the second frame of a prepared renderer ({:.1} ms):",
        second * 1e3
    );
    for (name, seconds) in [
        ("first frame without prepare", of(&plain, 1)),
        ("pipelines alone", of(&pipelines, 0)),
        ("first frame after those", of(&pipelines, 1)),
        ("prepare", of(&prepared, 0)),
        ("first frame after prepare", of(&prepared, 1)),
        ("second frame without prepare", of(&plain, 2)),
    ] {
        println!("  {name:<29} {:8.1} {:7.2}", seconds * 1e3, seconds / second);
    }
}
