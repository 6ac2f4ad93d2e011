//! Every filling of a module's slots that the library has: it links, validates, and does what its parts let it.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;
mod verdict;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use common::{catalog, gpu};
use shadewright::compiler::Catalog;
use shadewright::compiler::manifest::{Arity, Slot};
use shadewright::modules::{Folder, Overlay, library};
use shadewright::report::proofs::{self, Bench, Combinations, Effort};
use verdict::{naga_takes, tint};

fn combined(catalog: &Catalog) -> Vec<Combinations> {
    let roles = proofs::load(&*library(), catalog).unwrap_or_else(|report| panic!("{report}"));
    let gpu = gpu();
    let bench = Bench::new(catalog, Some(&gpu));
    let effort = Effort {
        samples: 0,
        others: false,
        modules: &|_| true,
        cancel: &AtomicBool::new(false),
        progress: &|_, _, _| {},
    };
    let mut found = Vec::new();
    for role in &roles {
        for name in &role.declared.combinations {
            let combined = proofs::combinations(&bench, role, name, &effort);
            found.push(combined.unwrap_or_else(|error| panic!("{error}")));
        }
    }
    found
}

/// Catches modules that do not fit together: a combination that does not link or validate, that is negative, not finite, or not reciprocal though
/// its parts are, or that draws what it does not say. None is left out: their number is the product of what fits each slot.
#[test]
fn every_combination_does_what_its_parts_let_it() {
    let found = combined(catalog());
    assert!(!found.is_empty());
    for combined in found {
        println!("{combined:#?}");
        assert!(combined.faults.is_empty(), "{:#?}", combined.faults);
        let manifest = &catalog().module(&combined.module).unwrap().manifest;
        let ways = |slot: &Slot| catalog().fits(&slot.interface).len() + usize::from(slot.arity == Arity::Optional);
        let all: usize = manifest.slots.values().map(ways).product();
        assert!(combined.count >= all && all > 1000, "{} of {all}", combined.count);
        assert!(combined.on_device > 20 && combined.samplers > 20 && combined.reciprocal > 0);
    }
}

/// Catches combinations whose text another compiler refuses: those that hold every pair of alternatives.
#[test]
fn others_take_the_cover() {
    let space = proofs::space(catalog(), "brdf/microfacet").unwrap_or_else(|report| panic!("{report}"));
    let (mut taken, mut tinted) = (0, 0);
    for permutation in space.pairwise().unwrap() {
        let program = catalog()
            .compile_probe(&permutation.recipe, "brdf")
            .unwrap_or_else(|report| panic!("{report}"));
        naga_takes(program.wgsl()).unwrap_or_else(|error| panic!("{error}\n{}", program.wgsl()));
        taken += 1;
        if let Some(verdict) = tint(program.wgsl()) {
            verdict.unwrap_or_else(|error| panic!("{error}\n{}", program.wgsl()));
            tinted += 1;
        }
    }
    println!("naga takes {taken}, tint {tinted}");
    assert!(taken > 20);
}

/// Catches a check that lets parts pass that do not fit: a diffuse part that falsely claims to be reciprocal, one that is NaN at grazing angles,
/// and a distribution that draws facets with another density than it says.
#[test]
fn a_bad_part_is_found_in_every_combination() {
    let folder = tempfile::tempdir().unwrap();
    let put = |path: &str, text: &str| {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    };
    let claims = "(summary: \"planted\", uses: [\"math\"], properties: [\"reciprocal\"])";
    put("diffuse/lopsided/module.ron", claims);
    put(
        "diffuse/lopsided/lopsided.wgsl",
        "fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return s.diffuse * dot(s.normal, v);\n}\n",
    );
    put("diffuse/holed/module.ron", claims);
    put(
        "diffuse/holed/holed.wgsl",
        "fn diffuse(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return s.diffuse * sqrt(dot(s.normal, v) - 0.01) * sqrt(dot(s.normal, l) - 0.01);\n}\n",
    );
    put("ndf/narrow/module.ron", "(summary: \"planted\", uses: [\"math\"])");
    put(
        "ndf/narrow/narrow.wgsl",
        "fn distribution(s: Surface, h: vec3f) -> f32 {\n    return INV_PI;\n}\n\
        fn facet_sample(s: Surface, v: vec3f, u: vec2f) -> vec3f {\n    return cosine_sample(s.normal, u);\n}\n\
        fn facet_pdf(s: Surface, v: vec3f, h: vec3f) -> f32 {\n    return INV_PI * dot(s.normal, h) * dot(s.normal, h);\n}\n",
    );
    let overlay = Overlay(vec![Arc::new(Folder::new(folder.path())), Arc::new(Fewer)]);
    let catalog = Catalog::load(Arc::new(overlay)).unwrap_or_else(|report| panic!("{report}"));
    let found = combined(&catalog).remove(0);
    let distributions = catalog.fits("ndf").len();
    let faults = |word: &str| found.faults.iter().filter(|fault| fault.contains(word)).count();
    println!("{} combinations: {:#?}", found.count, &found.faults);
    assert!(faults("lopsided: is not reciprocal") >= distributions);
    assert!(faults("holed: is NaN") >= distributions);
    assert!(faults("narrow") > catalog.fits("diffuse").len());
    assert!(
        found
            .faults
            .iter()
            .any(|fault| fault.contains("narrow") && fault.contains("draws with p"))
    );
    assert!(
        found
            .faults
            .iter()
            .all(|fault| fault.contains("lopsided") || fault.contains("holed") || fault.contains("narrow"))
    );
}

/// The standard library with few masking and Fresnel terms, so that it does not take long.
struct Fewer;

impl shadewright::compiler::Library for Fewer {
    fn folders(&self, folder: &str) -> Vec<String> {
        let mut names = library().folders(folder);
        match folder {
            "masking" => names.retain(|name| name.starts_with("smith")),
            "fresnel" => names.retain(|name| name == "schlick"),
            "compensation" => names.clear(),
            _ => {}
        }
        names
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        library().read(path)
    }

    fn bytes(&self, path: &str) -> Result<Option<Vec<u8>>, String> {
        library().bytes(path)
    }
}
