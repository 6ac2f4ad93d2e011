//! What manifests claim of modules holds on the device, over stratified and hard inputs; and what none of them may do.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use common::{catalog, gpu};
use shadewright::compiler::Catalog;
use shadewright::modules::{Embedded, Folder, Overlay, library};
use shadewright::report::proofs::{self, Bench, Effort, Proof, Property};

/// All that is proved of some modules but by chi-square tests, which have tests of their own.
fn proved(catalog: &Catalog, modules: &dyn Fn(&str) -> bool) -> Vec<Proof> {
    let roles = proofs::load(&*library(), catalog).unwrap_or_else(|report| panic!("{report}"));
    let gpu = gpu();
    let effort = Effort {
        samples: 0,
        others: true,
        modules,
        cancel: &AtomicBool::new(false),
        progress: &|_, _, _| {},
    };
    proofs::prove(&Bench::new(catalog, Some(&gpu)), &roles, &effort).unwrap_or_else(|error| panic!("{error}"))
}

/// Catches a claim that does not hold, a function that is negative or not finite, a distribution whose integral is not 1, a masking that is
/// not its distribution's.
#[test]
fn claimed_properties_hold() {
    let found = proved(catalog(), &|_| true);
    for proof in &found {
        let said = if proof.claimed { "" } else { ", not claimed" };
        println!(
            "{:<40} {:<14?} {:.3e}{said}: {}",
            proof.module, proof.property, proof.worst, proof.at
        );
    }
    let broken: Vec<&Proof> = found.iter().filter(|proof| proof.is_broken()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    // Nothing has lost its checks: every module of a category has every property that the category's functions can have.
    for (category, count) in [("brdf", 6), ("diffuse", 5), ("masking", 4), ("fresnel", 3), ("ndf", 4)] {
        for module in catalog().modules().filter(|m| m.category == category) {
            let name = format!("{category}/{}", module.name);
            assert_eq!(found.iter().filter(|p| p.module == name).count(), count, "{name}");
        }
    }
    let pairs = found.iter().filter(|p| p.property == Property::ProjectedArea).count();
    assert!(pairs >= 4, "{pairs}");
}

/// A library with some modules changed or added.
fn with(modules: &[(&str, &str)]) -> (tempfile::TempDir, Catalog) {
    let folder = tempfile::tempdir().unwrap();
    for (path, text) in modules {
        let path = folder.path().join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    let overlay = Overlay(vec![Arc::new(Folder::new(folder.path())), library()]);
    let catalog = Catalog::load(Arc::new(overlay)).unwrap_or_else(|report| panic!("{report}"));
    (folder, catalog)
}

/// A module's text with a change, which must change something.
fn mutated(path: &str, from: &str, to: &str) -> String {
    let (_, text) = Embedded.files().find(|(name, _)| *name == path).unwrap();
    assert!(text.contains(from), "{path} has no {from:?}");
    text.replace(from, to)
}

#[track_caller]
fn is_broken(catalog: &Catalog, module: &str, property: Property) {
    let found = proved(catalog, &|name| name == module);
    let broken: Vec<Property> = found.iter().filter(|p| p.is_broken()).map(|p| p.property).collect();
    assert!(
        broken.contains(&property),
        "{module}: {property:?} is not among {broken:?}: {found:#?}"
    );
}

/// Catches checks that let anything pass: each claim is made by a reflectance that does not keep it.
#[test]
fn false_claims_fail() {
    let cases = [
        (
            "lopsided",
            "reciprocal",
            "INV_PI * (1.0 + 1e-4 * dot(s.normal, v))",
            Property::Reciprocal,
        ),
        ("brushed", "isotropic", "INV_PI * (1.0 + 1e-3 * l.x * l.x)", Property::Isotropic),
        ("bright", "energy_conserving", "INV_PI * 1.002", Property::Energy),
        ("dark", "reciprocal", "INV_PI * (dot(s.normal, v) - 1e-6)", Property::NotNegative),
        (
            "grazing",
            "reciprocal",
            "INV_PI / max(dot(s.normal, v) - 2e-4, 0.0)",
            Property::Finite,
        ),
    ];
    let texts: Vec<(String, String, String)> = cases
        .iter()
        .map(|(name, claim, value, _)| {
            (
                format!("brdf/{name}"),
                format!("(summary: \"planted\", uses: [\"math\"], properties: [{claim:?}])"),
                format!("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {{\n    return vec3f({value});\n}}\n"),
            )
        })
        .collect();
    let files: Vec<(String, &str)> = texts
        .iter()
        .flat_map(|(folder, manifest, wgsl)| {
            let name = Path::new(folder).file_name().unwrap().to_str().unwrap();
            [
                (format!("{folder}/module.ron"), manifest.as_str()),
                (format!("{folder}/{name}.wgsl"), wgsl.as_str()),
            ]
        })
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(path, text)| (path.as_str(), *text)).collect();
    let (_folder, catalog) = with(&files);
    for (name, _, _, property) in cases {
        is_broken(&catalog, &format!("brdf/{name}"), property);
    }
}

/// Catches integrals over facets that any distribution and any masking pass: one with 1 % too much, one of another width, a masking of another
/// alpha, a density of samples that is too small, and shares above 1.
#[test]
fn wrong_facets_fail() {
    let ggx = "ndf/ggx/ggx.wgsl";
    let changed = mutated(
        ggx,
        "return select(0.0, k * k * INV_PI, cosine > 0.0);",
        "return select(0.0, k * k * INV_PI * 1.001, cosine > 0.0);",
    );
    is_broken(&with(&[(ggx, &changed)]).1, "ndf/ggx", Property::Normalised);

    let smith = "masking/smith-ggx-correlated/smith-ggx-correlated.wgsl";
    let changed = mutated(smith, "let a2 = s.alpha * s.alpha;", "let a2 = 1.01 * s.alpha * s.alpha;");
    is_broken(
        &with(&[(smith, &changed)]).1,
        "masking/smith-ggx-correlated",
        Property::ProjectedArea,
    );

    let changed = mutated(ggx, "return 2.0 * max(dot(v, h), 0.0)", "return 1.98 * max(dot(v, h), 0.0)");
    is_broken(&with(&[(ggx, &changed)]).1, "ndf/ggx", Property::Weight);

    let schlick = "fresnel/constant/constant.wgsl";
    let changed = mutated(schlick, "return s.f0;", "return s.f0 * 1.00001;");
    is_broken(&with(&[(schlick, &changed)]).1, "fresnel/constant", Property::Share);
}
