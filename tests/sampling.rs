//! What is drawn has the density that is said: chi-square tests of every module that draws directions, on the device.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use common::{catalog, gpu};
use shadewright::compiler::Catalog;
use shadewright::modules::{Embedded, Folder, Overlay, library};
use shadewright::report::proofs::{self, Bench, Effort, Proof};

/// Directions drawn for a test.
const SAMPLES: usize = 1_000_000;

fn drawn(catalog: &Catalog, samples: usize, modules: &dyn Fn(&str) -> bool) -> Vec<Proof> {
    let roles = proofs::load(&*library(), catalog).unwrap_or_else(|report| panic!("{report}"));
    let gpu = gpu();
    let effort = Effort {
        samples,
        others: false,
        modules,
        cancel: &AtomicBool::new(false),
        progress: &|_, _, _| {},
    };
    proofs::prove(&Bench::new(catalog, Some(&gpu)), &roles, &effort).unwrap_or_else(|error| panic!("{error}"))
}

/// Catches a density that is not of what is drawn: a Jacobian that is forgotten, a share that is exchanged, an angle of another meaning.
#[test]
fn every_module_draws_what_it_says() {
    let found = drawn(catalog(), SAMPLES, &|_| true);
    for proof in &found {
        println!("{}: p {:.4}, {}", proof.module, proof.worst, proof.at);
    }
    let broken: Vec<&Proof> = found.iter().filter(|proof| proof.is_broken()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    let modules = catalog().modules().filter(|m| matches!(m.category.as_str(), "brdf" | "ndf"));
    assert_eq!(found.len(), modules.count());
}

/// Catches a test that is too weak: a lobe that gets 1 % more of the samples than the density says, which 3 x 10^4 samples do not show, and
/// a density that is 1 % too small everywhere.
#[test]
fn one_per_cent_is_seen() {
    let path = "brdf/ward/ward.wgsl";
    let (_, text) = Embedded.files().find(|(name, _)| *name == path).unwrap();
    let mutant = |from: &str, to: &str| {
        assert!(text.contains(from), "{path} has no {from:?}");
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(folder.path().join("brdf/ward")).unwrap();
        std::fs::write(folder.path().join(path), text.replace(from, to)).unwrap();
        let overlay = Overlay(vec![Arc::new(Folder::new(folder.path())), library()]);
        (Catalog::load(Arc::new(overlay)).unwrap_or_else(|report| panic!("{report}")), folder)
    };
    let of_ward = |catalog: &Catalog, samples: usize| drawn(catalog, samples, &|name| name == "brdf/ward").remove(0);

    let sampled = "slope_lobe_sample(s, s.widths, lobe_share";
    let (shifted, _folder) = mutant(sampled, "slope_lobe_sample(s, s.widths, 1.01 * lobe_share");
    let (few, many) = (of_ward(&shifted, 30_000), of_ward(&shifted, SAMPLES));
    println!(
        "1 % of the lobe: p {:.1e} with few samples, {:.1e} with many",
        few.worst, many.worst
    );
    assert!(!few.is_broken() && many.is_broken(), "{few:?} {many:?}");

    let (scaled, _folder) = mutant("return slope_lobe_pdf(", "return 0.99 * slope_lobe_pdf(");
    let few = of_ward(&scaled, 30_000);
    println!("1 % of the density: p {:.1e}", few.worst);
    assert!(few.is_broken(), "{few:?}");
}
