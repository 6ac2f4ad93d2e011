//! A scene drawn from both written forms of its programs, and read back without waiting.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Renderer;
use shadewright_runtime::gpu::{Form, Gpu, RuntimeError};
use shadewright_runtime::scene::SceneFile;

/// Asks until it is there.
fn wait_for<T>(mut take: impl FnMut() -> Option<Result<T, RuntimeError>>) -> T {
    let begun = Instant::now();
    loop {
        match take() {
            Some(result) => return result.unwrap(),
            None if begun.elapsed() < Duration::from_secs(60) => std::thread::sleep(Duration::from_millis(1)),
            None => panic!("it does not come"),
        }
    }
}

/// Catches a source form that means something else than the IR, or binds it elsewhere; and rows that a reading without waiting puts in other places
/// than one that waits.
#[test]
fn both_forms_draw_the_same_picture() {
    let gpu = Gpu::headless().unwrap();
    let catalog = Arc::new(Catalog::load(shadewright_modules::library()).unwrap());
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/scenes/first.scene.ron");
    let file = SceneFile::read(Path::new(scene)).unwrap();
    // 150 texels: rows that are padded in each format.
    let frame = file.frame(&catalog, Some([150, 85])).unwrap();
    let draw = |form: Form| {
        let gpu = gpu.clone().with_form(form);
        let mut renderer = Renderer::new(&gpu, Arc::clone(&catalog));
        let targets = renderer.render(&frame).unwrap();
        let (mut hdr, mut display) = (
            targets.start_read_hdr(&gpu).unwrap(),
            targets.start_read_display(&gpu).unwrap().unwrap(),
        );
        let (hdr, display) = (wait_for(|| hdr.take(&gpu)), wait_for(|| display.take(&gpu)));
        assert_eq!((hdr.len(), display.len()), (150 * 85, 150 * 85 * 4));
        assert!(hdr == targets.read_hdr(&gpu).unwrap());
        assert!(display == targets.read_display(&gpu).unwrap().unwrap());
        (hdr, display)
    };
    let ((ir_hdr, ir), (source_hdr, source)) = (draw(Form::Ir), draw(Form::Source));
    let most = ir.iter().zip(&source).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most <= Some(1), "{most:?} of 255");
    assert!(
        ir.iter().copied().max() > Some(128) && ir != [ir[0]; 150 * 85 * 4],
        "something is drawn"
    );
    for (at, (a, b)) in ir_hdr.iter().flatten().zip(source_hdr.iter().flatten()).enumerate() {
        // The two may be rounded in another order; a hundredth of a percent is far below what a wrong term would do.
        assert!((a - b).abs() <= 1e-4 * a.abs().max(1.0), "{at}: {a} and {b}");
    }
}
