//! What is measured side by side means the same: the first scene, drawn with each candidate's shader in place of ours.

#![allow(clippy::unwrap_used)]

use std::path::Path;
use std::sync::Arc;

use shadewright_benchmark::peers::{concatenation::concatenate, oil, parse, wesl};
use shadewright_benchmark::pieces::{Piece, pieces};
use shadewright_benchmark::{Subject, permutations};
use shadewright_compiler::canonical::canonical_hash;
use shadewright_compiler::program::Recipe;
use shadewright_compiler::{naga, validate};
use shadewright_runtime::frame::Renderer;
use shadewright_runtime::gpu::Gpu;
use shadewright_runtime::scene::SceneFile;

/// Difference of a texel's channel that is taken for the same: rounding of 32-bit floats over some hundred operations, in case that a
/// driver orders them otherwise, relative to the larger value and to 1 cd/m2.
const TOLERANCE: f32 = 1e-4;

/// The module of each candidate. Every one is made of the same pieces.
fn modules(pieces: &[Piece]) -> Vec<(&'static str, naga::Module)> {
    let sources = oil::Sources::new(pieces);
    let oil = |validating: bool| {
        let mut composer = sources.composer(validating)?;
        sources.make(&mut composer)
    };
    let wesl = |checks: bool| parse(&wesl::Compiler::new(pieces, checks)?.text()?);
    let candidates: [(&str, Result<naga::Module, String>); 5] = [
        ("concatenation", parse(&concatenate(pieces))),
        ("naga_oil", oil(true)),
        ("naga_oil, not validating", oil(false)),
        ("wesl", wesl(true)),
        ("wesl, no checks", wesl(false)),
    ];
    candidates
        .map(|(name, module)| (name, module.unwrap_or_else(|e| panic!("{name}: {e}"))))
        .into()
}

/// The same pieces with one item's text changed.
fn changed(pieces: &[Piece], from: &str, to: &str) -> Vec<Piece> {
    let mut pieces = pieces.to_vec();
    let mut count = 0;
    for item in pieces.iter_mut().flat_map(|piece| &mut piece.items) {
        count += item.text.matches(from).count();
        item.text = item.text.replace(from, to);
    }
    assert_eq!(count, 1, "{from} stands once in the shader");
    pieces
}

/// Largest difference of two pictures, relative to the larger value and at least 1 cd/m2.
fn difference(a: &[[f32; 4]], b: &[[f32; 4]]) -> f32 {
    assert_eq!(a.len(), b.len());
    let channels = a.as_flattened().iter().zip(b.as_flattened());
    // Not `max`, which drops NaN.
    channels
        .map(|(x, y)| (x - y).abs() / x.abs().max(y.abs()).max(1.0))
        .fold(0.0, |most, d| if d <= most { most } else { d })
}

/// Catches a peer that is given another shader than ours (a piece left out, a wrong import, a binding moved) and so measured
/// unfairly: what each one makes draws the same picture, and a Fresnel term with the power 4 instead of 5 does not.
#[test]
fn every_candidate_draws_the_same_picture() {
    let subject = Subject::load().unwrap();
    let gpu = Gpu::headless().unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes/first.scene.ron");
    let scene = SceneFile::read(&path).and_then(|scene| scene.frame(&subject.catalog, Some([128, 72])));
    let frame = scene.unwrap_or_else(|report| panic!("{report}"));
    let draw = |module: Option<naga::Module>| {
        let mut renderer = Renderer::new(&gpu, Arc::clone(&subject.catalog));
        if let Some(module) = module {
            let validated = validate::validate(module).unwrap();
            renderer.draw_with(&subject.program, &validated).unwrap();
        }
        renderer.render(&frame).unwrap().read_hdr(&gpu).unwrap()
    };
    let ours = draw(None);
    assert!(ours.iter().any(|texel| texel[0] > 1.0), "something is lit");

    let pieces = pieces(&subject.program).unwrap();
    for (name, module) in modules(&pieces) {
        let found = difference(&ours, &draw(Some(module)));
        assert!(found <= TOLERANCE, "{name}: off by {found}");
    }
    for (name, module) in modules(&changed(&pieces, "x2 * x2 * x", "x2 * x2")).into_iter().step_by(2) {
        let found = difference(&ours, &draw(Some(module)));
        assert!(found > 10.0 * TOLERANCE, "{name}: the planted difference is not seen, {found}");
    }
}

/// Catches pieces that lose or double an item or change its text: the pieces behind each other are the shader itself.
#[test]
fn the_pieces_are_the_whole_shader() {
    let subject = Subject::load().unwrap();
    let pieces = pieces(&subject.program).unwrap();
    let names: Vec<&str> = pieces.iter().map(|piece| piece.name.as_str()).collect();
    // One for each of the 16 instances, and one more where a filter calls back into the map that calls it.
    for expected in [
        "main",
        "main_brdf",
        "main_brdf_ndf",
        "main_lights_b_visibility",
        "main_lights_b_visibility_upper",
        "params",
    ] {
        assert!(names.contains(&expected), "{expected} is not in {names:?}");
    }
    assert_eq!(names.last(), Some(&"main"), "the entry points come last");
    let mut lines: Vec<String> = concatenate(&pieces).lines().map(str::to_owned).collect();
    let mut expected: Vec<String> = subject.program.wgsl().lines().map(str::to_owned).collect();
    for lines in [&mut lines, &mut expected] {
        lines.retain(|line| !line.trim().is_empty());
        lines.sort();
    }
    assert_eq!(lines, expected);
    // Texts can be held against the shader exactly; naga_oil's module cannot, as it names and orders constants its own way.
    let wesl = wesl::Compiler::new(&pieces, true).and_then(|compiler| compiler.text());
    for text in [concatenate(&pieces), wesl.unwrap()] {
        assert_eq!(canonical_hash("text", &text), Ok(subject.program.hash()));
    }
}

/// Catches permutations that do not compile (their time would be that of an error), are one and the same, or change from call to call, and a
/// space that is too small for the longest row of the tables.
#[test]
fn permutations_compile_and_differ() {
    let catalog = Subject::load().unwrap().catalog;
    let many = permutations::permutations(&catalog, 10_000).unwrap();
    let texts: std::collections::BTreeSet<&str> = many.iter().map(|recipe| recipe.source.text.as_str()).collect();
    assert_eq!((many.len(), texts.len()), (10_000, 10_000));
    let text = |recipe: &Recipe| recipe.source.text.clone();
    let again = permutations::permutations(&catalog, 100).unwrap();
    assert!(
        again
            .iter()
            .map(text)
            .eq(permutations::permutations(&catalog, 100).unwrap().iter().map(text))
    );
    let mut hashes = std::collections::BTreeSet::new();
    for recipe in many.iter().step_by(170) {
        let program = catalog.compile(recipe, "main");
        hashes.insert(program.unwrap_or_else(|report| panic!("{}: {report}", recipe.source.text)).hash());
    }
    assert!(hashes.len() > 50, "only {} of 59 differ", hashes.len());
    let error = permutations::permutations(&catalog, usize::MAX).unwrap_err();
    assert!(error.starts_with("growth.space.ron has "), "{error}");
}
