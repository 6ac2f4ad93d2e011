//! What could stand in a slot: the plot, the table, the sheet.

use egui_kittest::kittest::Queryable;

use crate::compare::until;
use crate::harness::{click, open, settle};

/// Catches an alternative that is not drawn, without a number, with the error of another truth, a choice that is no edit, and a sheet with other pictures than
/// the plot's.
#[test]
fn alternatives_of_a_slot_have_errors_costs_and_pictures() {
    let mut explorer = open("sun");
    explorer.state_mut().selected = "lights[0].fill.disc".to_owned();
    click(&mut explorer, "Pareto");
    until(&mut explorer, "measured", |app| {
        app.compare.sweep.as_ref().is_some_and(|sweep| sweep.alternatives.len() == sweep.of)
    });
    let sweep = explorer.state().compare.sweep.clone().unwrap();
    assert!(sweep.against.contains("disc-reference"), "{}", sweep.against);
    let measured = |name: &str| {
        let found = sweep.alternatives.iter().find(|alternative| alternative.name == name).unwrap();
        (found.outcome.as_ref().unwrap(), found)
    };
    let (truth, _) = measured("disc-reference");
    let (present, is_present) = measured("convolved-lobe");
    let (rays, _) = measured("parallel-rays");
    assert_eq!(truth.rms, 0.0);
    assert!(
        is_present.is_present && present.rms < rays.rms && present.rms > 0.0,
        "{} {}",
        present.rms,
        rays.rms
    );
    assert!(rays.operations < present.operations && present.operations > 100.0);
    // A software driver's times are those of a busy machine: only that they are there.
    assert!(present.ratio.is_none_or(|ratio| ratio > 0.1 && ratio < 10.0), "{:?}", present.ratio);
    assert!(
        is_present
            .stored
            .iter()
            .any(|(experiment, error)| experiment == "light/sun-mirrored" && (error - 0.053).abs() < 0.001)
    );
    assert!(explorer.query_by_label("Choose disc-reference for lights[0].fill.disc").is_some());
    explorer.run_steps(4);
    save(&mut explorer, "pareto");
    click(&mut explorer, "Choose parallel-rays for lights[0].fill.disc");
    settle(&mut explorer);
    assert_eq!(
        explorer.state().document.can_undo(),
        Some("Choose parallel-rays for lights[0].fill.disc")
    );
    assert!(
        explorer
            .state()
            .document
            .scene()
            .get("lights[0].fill.disc")
            .unwrap()
            .contains("parallel-rays")
    );
    click(&mut explorer, "Sheet");
    until(&mut explorer, "drawn", |app| {
        app.compare
            .sweep
            .as_ref()
            .is_some_and(|sweep| sweep.version == app.version && sweep.alternatives.len() == sweep.of)
    });
    explorer.run_steps(3);
    save(&mut explorer, "sheet");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sheet.png");
    explorer.state_mut().compare.sheet_path = path.display().to_string();
    explorer.run_steps(1);
    click(&mut explorer, "Write the sheet");
    settle(&mut explorer);
    let written = image::open(&path).unwrap();
    let size = explorer.state().compare.sweep.as_ref().unwrap().size;
    assert!(
        written.width() > 2 * size[0] && written.height() > size[1],
        "{}",
        explorer.state().message
    );
    click(&mut explorer, "Choose nearest-point for lights[0].fill.disc");
    settle(&mut explorer);
    assert!(
        explorer
            .state()
            .document
            .scene()
            .get("lights[0].fill.disc")
            .unwrap()
            .contains("nearest-point")
    );
}

/// Catches a space that is not read, and a choice that puts another of its permutations there.
#[test]
fn a_sheet_shows_the_permutations_of_a_space() {
    let mut explorer = open("sphere");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("brdfs.space.ron");
    let text = r#"(module: "microfacet", fill: {"ndf": (one_of: ["ggx", "beckmann", "exponential"]), "masking": (one_of: ["implicit", "kelemen"])})"#;
    std::fs::write(&path, text).unwrap();
    explorer.state_mut().selected = "materials.ball.brdf".to_owned();
    explorer.state_mut().compare.space = path.display().to_string();
    click(&mut explorer, "Sheet");
    until(&mut explorer, "drawn", |app| {
        !app.compare.problem.is_empty() || app.compare.sweep.as_ref().is_some_and(|sweep| sweep.alternatives.len() == sweep.of)
    });
    assert_eq!(explorer.state().compare.problem, "");
    let sweep = explorer.state().compare.sweep.clone().unwrap();
    assert_eq!((sweep.of, sweep.cut), (6, 0));
    assert!(sweep.alternatives.iter().all(|alternative| alternative.outcome.is_ok()));
    let name = format!("Choose {} for materials.ball.brdf", sweep.alternatives[3].name);
    click(&mut explorer, &name);
    settle(&mut explorer);
    let brdf = explorer.state().document.scene().get("materials.ball.brdf").unwrap().to_owned();
    assert!(brdf.contains("microfacet") && brdf.contains("fill"), "{brdf}");
}

/// Keeps a picture whose numbers are the machine's, to look at.
fn save(harness: &mut egui_kittest::Harness<explorer::App>, name: &str) {
    let image = harness.render().unwrap();
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    image.save(folder.join(format!("{name}.png"))).unwrap();
}
