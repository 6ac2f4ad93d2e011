//! `*.proofs.ron` as text, and the page of what is proved.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use shadewright_compiler::Catalog;
use shadewright_modules::library;
use shadewright_report::proofs::{Combinations, Proof, Property, load, read};
use shadewright_report::write;

/// Catches functions and modules that are not there, and errors that do not say where they stand.
#[test]
fn what_is_not_there_is_located() {
    let catalog = Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"));
    let text = r#"(
    reflectance: "brdf",
    draws: (sample: "brdf_sample", density: "brdf_pfd", drawn: "l"),
    areas: [(distribution: "ndf/ggx", masking: "masking/smith", within: 1e-4)],
    combinations: ["microfact"],
)
"#;
    let found = read(&catalog, "brdf", "brdf/brdf.proofs.ron", text)
        .expect_err("it is wrong")
        .render();
    let expected = r#"
error[SW1101]: `brdf` has no function `brdf_pfd`
  --> brdf/brdf.proofs.ron:3:45
  |
3 |     draws: (sample: "brdf_sample", density: "brdf_pfd", drawn: "l"),
  |                                             ^^^^^^^^^^ named here
  |
  = did you mean `brdf_pdf`?
  = functions: brdf, brdf_sample, brdf_pdf

error[SW1101]: there is no module `masking/smith`
  --> brdf/brdf.proofs.ron:4:48
  |
4 |     areas: [(distribution: "ndf/ggx", masking: "masking/smith", within: 1e-4)],
  |                                                ^^^^^^^^^^^^^^^ named here

error[SW1101]: `brdf` has no module `microfact`
  --> brdf/brdf.proofs.ron:5:20
  |
5 |     combinations: ["microfact"],
  |                    ^^^^^^^^^^^ named here
"#;
    assert_eq!(found.trim(), expected.trim(), "found\n{found}");
}

/// Catches a library whose categories have lost their files.
#[test]
fn the_library_says_what_is_what() {
    let catalog = Catalog::load(library()).unwrap_or_else(|report| panic!("{report}"));
    let roles = load(&*library(), &catalog).unwrap_or_else(|report| panic!("{report}"));
    let categories: Vec<&str> = roles.iter().map(|r| r.category.as_str()).collect();
    for category in ["brdf", "ndf", "masking", "fresnel", "diffuse"] {
        assert!(categories.contains(&category), "{categories:?}");
    }
}

fn proof(module: &str, property: Property, claimed: bool, worst: f64, bound: f64) -> Proof {
    Proof {
        module: module.to_owned(),
        property,
        claimed,
        worst,
        at: "v 30°, a|b".to_owned(),
        bound,
    }
}

/// Catches a broken claim that the page does not show, a value under another property, and a place that breaks its table.
#[test]
fn the_page_shows_what_is_broken() {
    let proofs = [
        proof("brdf/a", Property::Reciprocal, true, 2e-5, 1e-5),
        proof("brdf/a", Property::NotNegative, true, 0.0, 0.0),
        proof("brdf/b", Property::Energy, false, 3.80519, 1.001),
        proof("ndf/c", Property::Drawn, true, 1e-9, 1e-4),
    ];
    assert_eq!(proofs.iter().map(Proof::is_broken).collect::<Vec<_>>(), [true, false, false, true]);
    let combined = Combinations {
        module: "brdf/a".to_owned(),
        count: 12,
        slots: vec![("ndf".to_owned(), 3), ("masking".to_owned(), 4)],
        ..Combinations::default()
    };
    let page = write::proofs("a device", 1000, &proofs, &[combined]);
    for line in [
        "Measured on a device, 1000 samples for a chi-square test. 3 claims, 2 of them broken.",
        "| module | reciprocal | not negative | albedo | drawn as said |",
        "| brdf/a | **2.00e-5** | 0 |  |  |",
        "| brdf/b |  |  | (3.81) |  |",
        "| brdf/a | yes | 2.00e-5 | 1.00e-5 | **no** | v 30°, a\\|b |",
        "| brdf/b | no | 3.80519 | 1.00 | no | v 30°, a\\|b |",
        "3 ndf, 4 masking: 12 combinations, all of them linked, validated and evaluated in f32; 0 programs differ.",
    ] {
        assert!(page.contains(line), "no {line:?} in\n{page}");
    }
}
