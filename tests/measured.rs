//! Modules that look a measured table up: what a table of a known function gives, and how its error falls as the table grows.
// Figures are printed for who asks for them.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::f64::consts::TAU;
use std::path::Path;

use common::{catalog, gpu};
use glam::DVec3;
use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Recipe};
use shadewright::modules::oracles::quadrature::direction;
use shadewright::modules::oracles::reflection::{self, Surface};
use shadewright::runtime::gpu::pipeline::Pipelines;
use shadewright::runtime::measured::{Facets, Measured, Merl, Rgl, tabulate, write_tensors};
use shadewright::runtime::probe::Probe;

const ALPHA: f64 = 0.3;
const F0: [f64; 3] = [0.9, 0.6, 0.3];
const DIFFUSE: [f64; 3] = [0.02, 0.06, 0.1];

/// What the tables are of: GGX over a diffuse base, in double precision.
fn glossy(v: DVec3, l: DVec3) -> [f64; 3] {
    std::array::from_fn(|channel| {
        let surface = Surface {
            normal: DVec3::Z,
            diffuse: DIFFUSE[channel],
            f0: F0[channel],
            alpha: ALPHA,
        };
        reflection::microfacet(&surface, v, l)
    })
}

fn along_the_lobe(sizes: [usize; 3]) -> Vec<u8> {
    // Of facets that stand upright the limit: a table's last row is no edge.
    let normals = |m: DVec3| reflection::ggx_d(ALPHA, reflection::angle(DVec3::Z, m).min(TAU / 4.0 - 1e-9));
    let area = |v: DVec3| {
        let cosine = v.z.max(1e-3);
        cosine * (1.0 + reflection::ggx_lambda(ALPHA, cosine.acos()))
    };
    let facets = Facets {
        normals: &normals,
        area: &area,
    };
    write_tensors(&tabulate(sizes, facets, glossy))
}

fn recipe(module: &str, file: &Path) -> Recipe {
    let text = format!(
        "(module: \"brdf/{module}\", files: {{\"measured\": {:?}}})",
        file.display().to_string()
    );
    Recipe::parse("recipe", &text).unwrap_or_else(|report| panic!("{report}"))
}

/// Directions to the viewer and to the light, at most 60 degrees from the normal: half of the lights around the mirror direction.
fn directions(count: usize) -> Vec<(DVec3, DVec3)> {
    // The golden ratio's multiples, and those of the plastic number's powers.
    let part = |i: usize, by: f64| (0.5 + i as f64 * by).fract();
    let pair = |i: usize| {
        let v = direction(1.04 * part(i, 0.618_033_988_75).sqrt(), TAU * part(i, 0.754_877_666_25));
        let m = direction(0.4 * part(i, 0.569_840_290_998), TAU * part(i, 0.856_674_883_855));
        let l = if i.is_multiple_of(2) {
            2.0 * v.dot(m) * m - v
        } else {
            direction(1.04 * part(i, 0.324_717_957_245), TAU * part(i, 0.220_744_084_606))
        };
        (v, l.normalize())
    };
    (0..4 * count).map(pair).filter(|(_, l)| l.z >= 0.5).take(count).collect()
}

fn rows(directions: &[(DVec3, DVec3)]) -> Vec<Json> {
    directions
        .iter()
        .map(|(v, l)| json!({"v": v.to_array(), "l": l.to_array()}))
        .collect()
}

/// RMS and largest error of f cos of a table's module, relative to the RMS of f cos.
fn errors(catalog: &Catalog, module: &str, bytes: &[u8]) -> (f64, f64) {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), bytes).unwrap();
    let directions = directions(256);
    let probe = Probe::new(catalog, &recipe(module, file.path()), "brdf").unwrap_or_else(|error| panic!("{error}"));
    let table = probe.table(&rows(&directions)).unwrap();
    let got = probe.on_cpu::<f64>(&table).unwrap_or_else(|error| panic!("{error}"));
    let (mut all, mut wrong, mut most) = (0.0, 0.0, 0.0f64);
    for (got, (v, l)) in got.values.iter().zip(&directions) {
        for (got, expected) in got.iter().zip(glossy(*v, *l)) {
            let error = (got - expected) * l.z;
            all += (expected * l.z).powi(2);
            wrong += error * error;
            most = most.max(error.abs());
        }
    }
    let scale = (all / (3 * directions.len()) as f64).sqrt();
    ((wrong / all).sqrt(), most / scale)
}

/// Errors of growing tables, and that each is at most a part of the one before.
#[track_caller]
fn assert_converges(name: &str, errors: &[(f64, f64)], ratio: f64, last: f64) {
    println!("{name}: {errors:?}");
    for pair in errors.windows(2) {
        assert!(pair[1].0 * ratio < pair[0].0, "{name}: {errors:?}");
    }
    let end = errors.last().unwrap();
    assert!(end.0 < last, "{name}: {errors:?}");
}

/// Catches an interpolation of the first order: a table whose values stand at the cells' corners and not in their middles, angles that are off, or a
/// coordinate that is rounded. Twice the resolution, a quarter of the error.
#[test]
fn the_error_of_a_merl_table_falls_with_its_cells_size_squared() {
    let catalog = catalog();
    let sizes = [12, 24, 48].map(|n| [n, n, n]);
    let errors = sizes.map(|sizes| errors(catalog, "merl", &Merl::tabulate(sizes, glossy).write()));
    assert_converges("merl", &errors, 3.0, 4e-3);
}

/// Catches a warp that is inverted otherwise than it was made, a cosine on the wrong side, or a slice that is another direction's.
#[test]
fn the_error_of_an_rgl_table_falls_with_its_cells_size() {
    let catalog = catalog();
    let errors = [[1, 6, 12], [1, 12, 24], [1, 24, 48]].map(|sizes| errors(catalog, "rgl", &along_the_lobe(sizes)));
    assert_converges("rgl", &errors, 2.0, 1e-2);
}

/// Catches azimuths of an anisotropic table that are not those of the surface, or a half of the circle that is folded the wrong way: an isotropic
/// function, tabulated all round, gives what its isotropic table gives.
#[test]
fn an_anisotropic_table_has_all_azimuths() {
    let catalog = catalog();
    let isotropic = errors(catalog, "rgl", &along_the_lobe([1, 10, 20]));
    let all_round = errors(catalog, "rgl", &along_the_lobe([17, 10, 20]));
    println!("isotropic {isotropic:?}, all round {all_round:?}");
    assert!(all_round.0 < 3.0 * isotropic.0 && all_round.0 < 0.05, "{isotropic:?} {all_round:?}");
}

/// Catches a table that the device gets otherwise than the evaluator, and one of the published size that does not fit a device.
#[test]
fn the_device_looks_up_what_the_evaluator_does() {
    let catalog = catalog();
    let folder = tempfile::tempdir().unwrap();
    let gpu = gpu();
    let pipelines = Pipelines::new(&gpu, None);
    let directions = directions(64);
    for (module, bytes, is_large) in [
        ("merl", Merl::tabulate([20, 20, 20], glossy).write(), false),
        ("rgl", along_the_lobe([1, 8, 16]), false),
        ("rgl", along_the_lobe([5, 4, 8]), false),
        ("merl", Merl::tabulate(Merl::PUBLISHED, glossy).write(), true),
    ] {
        let file = folder.path().join("table");
        std::fs::write(&file, &bytes).unwrap();
        let probe = Probe::new(catalog, &recipe(module, &file), "brdf").unwrap_or_else(|error| panic!("{error}"));
        let table = probe.table(&rows(&directions)).unwrap();
        let device = probe.on_gpu(&pipelines, &gpu, &table).unwrap_or_else(|error| panic!("{error}"));
        let expected: Vec<Vec<f64>> = if is_large {
            directions.iter().map(|(v, l)| glossy(*v, *l).to_vec()).collect()
        } else {
            probe.on_cpu::<f64>(&table).unwrap_or_else(|error| panic!("{error}")).values
        };
        let tolerance = if is_large { 2e-2 } else { 2e-4 };
        for ((got, expected), (v, l)) in device.iter().zip(&expected).zip(&directions) {
            for (got, expected) in got.iter().zip(expected) {
                let error = (got / expected - 1.0).abs();
                assert!(error < tolerance, "{module}: {got} instead of {expected} at {v} {l}");
            }
        }
    }
}

/// Catches a default table that is not what its README says.
#[test]
fn the_default_tables_are_of_ggx() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("modules/brdf");
    let read = |path: &str| Measured::read(&std::fs::read(folder.join(path)).unwrap()).unwrap_or_else(|error| panic!("{error}"));
    let made = [
        ("merl/sample.binary", Measured::Merl(Merl::tabulate([12, 10, 12], glossy))),
        ("rgl/sample.bsdf", Measured::Rgl(Rgl::read(&along_the_lobe([1, 6, 12])).unwrap())),
    ];
    for (path, made) in made {
        let (found, made) = (read(path).floats(), made.floats());
        assert_eq!(found.len(), made.len(), "{path}");
        for (index, (found, made)) in found.iter().zip(&made).enumerate() {
            // Values where the warp comes from nothing are as uncertain as that: not at all in its middle.
            assert!(
                (found - made).abs() <= 2e-4 * made.abs().max(1e-2),
                "{path}: number {index}: {found} instead of {made}"
            );
        }
    }
}
