//! Area lights over 512 drawn and at least 60 hard configurations a shape: every approximation is finite and not negative, form factors agree with
//! closed forms in double precision, the sampled reference agrees with both within its standard error, and a light that sinks below the
//! horizon fades to nothing. What the approximations get wrong by shape is in the lights' experiments.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

mod common;

use std::f64::consts::{PI, TAU};

use common::catalog;
use glam::DVec3;
use serde_json::{Value as Json, json};
use shadewright::compiler::Recipe;
use shadewright::modules::oracles::area;
use shadewright::modules::oracles::quadrature::direction;
use shadewright::runtime::probe::Probe;

const DRAWN: usize = 512;
const SHAPES: [&str; 6] = ["sphere", "disk", "rectangle", "polygon", "tube", "tube with caps"];
const IRRADIANCE: [&str; 5] = ["form-factor", "centre", "representative-point", "structured-sampling", "reference"];
const HIGHLIGHT: [&str; 8] = [
    "none",
    "representative-point",
    "d-modification",
    "overlap",
    "ltc",
    "phong-lobe",
    "ltc-anisotropic",
    "reference",
];
/// Roughness from 0.02 to 1, squared.
const ALPHAS: [f64; 5] = [4e-4, 0.01, 0.04, 0.25, 1.0];

/// A stratified number for each step: multiples of an irrational fill the unit interval evenly.
fn fraction(step: usize, by: f64) -> f64 {
    (step as f64 * by + 0.5).fract()
}

fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// As the device gets it.
fn single3(v: DVec3) -> DVec3 {
    v.as_vec3().as_dvec3()
}

fn sphere_direction(step: usize, a: f64, b: f64) -> DVec3 {
    direction(f64::acos(1.0 - 2.0 * fraction(step, a)), TAU * fraction(step, b))
}

/// A light and where it is seen from: the normal of the surface at the origin.
struct At {
    fields: Json,
    place: DVec3,
    normal: DVec3,
    truth: f64,
    /// Square of its size over its distance, at most 1.
    share: f64,
    /// Whether it turns its dark side to the point.
    is_behind: bool,
}

/// A light of a shape at a place, facing along `facing`, of about the size `size`; with its form factor.
fn placed(shape: &str, place: DVec3, facing: DVec3, size: f64, thin: f64, normal: DVec3) -> At {
    let (place, facing, normal) = (single3(place), single3(facing), single3(normal.normalize()));
    let (size, thin) = (single(size), single(size * thin));
    let right = single3(facing.any_orthonormal_vector());
    let n = normal.normalize();
    let (mut fields, truth) = match shape {
        "sphere" => (json!({"radius": size}), area::sphere(place, size, n)),
        "disk" => (
            json!({"direction": facing.to_array(), "radius": size}),
            area::disk(place, facing.normalize(), size, n, false),
        ),
        "rectangle" | "polygon" => {
            let axes = area::plane_axes(facing, right);
            let (x, y) = (size, thin);
            let corners = if shape == "rectangle" {
                vec![(-x, -y), (x, -y), (x, y), (-x, y)]
            } else {
                // A star that is not convex.
                let corner = |k: usize| {
                    let out = if k.is_multiple_of(2) { size } else { 0.4 * size };
                    let angle = TAU * k as f64 / 10.0;
                    (single(out * angle.cos()), single(out * angle.sin()))
                };
                (0..10).map(corner).collect()
            };
            let mut fields = json!({"direction": facing.to_array(), "right": right.to_array()});
            if shape == "rectangle" {
                fields["size"] = json!([2.0 * x, 2.0 * y]);
            } else {
                fields["corners"] = json!(corners.len());
                for (k, (x, y)) in corners.iter().enumerate() {
                    fields[format!("p{k}")] = json!([x, y]);
                }
            }
            (fields, area::flat(place, axes, &corners, n, false))
        }
        _ => (
            json!({"along": facing.to_array(), "length": 2.0 * size, "radius": thin}),
            area::tube(place, facing, 2.0 * size, thin, n, shape == "tube with caps"),
        ),
    };
    fields["position"] = json!(place.to_array());
    fields["luminance"] = json!(1);
    At {
        fields,
        place,
        normal,
        truth,
        share: (size * size / place.length_squared()).min(1.0),
        is_behind: matches!(shape, "disk" | "rectangle" | "polygon") && facing.dot(place) > 1e-5 * place.length() * facing.length(),
    }
}

/// Drawn and hard configurations: far and near, tiny and huge, across the horizon, behind, coplanar, degenerate.
fn configurations(shape: &str) -> Vec<At> {
    let mut all = Vec::new();
    for step in 1..=DRAWN {
        let place = sphere_direction(step, 0.819_172_513, 0.671_043_607) * 10f64.powf(3.0 * fraction(step, 0.549_700_478) - 1.0);
        let aside = sphere_direction(step, 0.450_299_522, 0.754_877_666);
        // Two in three face the point.
        let facing = if step % 3 == 0 { aside } else { aside - place.normalize() };
        let size = place.length() * 10f64.powf(3.5 * fraction(step, 0.569_840_291) - 3.0);
        let normal = sphere_direction(step, 0.856_674_884, 0.733_891_856);
        all.push(placed(
            shape,
            place,
            facing,
            size,
            10f64.powf(-1.5 * fraction(step, 0.628_704_184)),
            normal,
        ));
    }
    for degrees in [0.0_f64, 60.0, 85.0, 90.0, 95.0, 120.0, 180.0] {
        for size in [1e-3, 0.3, 0.99, 30.0] {
            for thin in [1.0, 1e-4] {
                let place = direction(degrees.to_radians(), 0.4);
                all.push(placed(shape, place, DVec3::new(-0.3, 0.1, -1.0), size, thin, DVec3::Z));
            }
        }
    }
    for (place, facing, size, thin) in [
        (DVec3::ZERO, -DVec3::Z, 1.0, 0.5),
        (DVec3::Z * 1e-4, -DVec3::Z, 1.0, 0.5),
        (DVec3::X, -DVec3::Z, 0.5, 0.5),
        (DVec3::Z, DVec3::Z, 0.5, 0.5),
        (DVec3::Z, -DVec3::Z, 0.0, 0.0),
        (DVec3::Z * 1e4, -DVec3::Z, 1e-3, 1.0),
        (DVec3::Z, DVec3::Z, 0.5, 1e-4),
        (DVec3::new(0.3, 0.0, 0.2), DVec3::X, 5.0, 0.02),
    ] {
        all.push(placed(shape, place, facing, size, thin, DVec3::Z));
    }
    all
}

/// The light of a shape with a recipe in its slot `area`.
fn light(shape: &str, area: &str) -> String {
    match shape {
        "tube with caps" => format!(r#"(module: "light/tube", freeze: {{"caps": true}}, fill: {{"area": {area}}})"#),
        _ => format!(r#"(module: "light/{shape}", fill: {{"area": {area}}})"#),
    }
}

fn diffuse(with: &str) -> String {
    format!(r#"(module: "split", fill: {{"diffuse": "{with}", "specular": "none"}})"#)
}

fn probe(recipe: &str) -> Probe {
    let parsed = Recipe::parse("test", recipe).unwrap_or_else(|report| panic!("{recipe}\n{report}"));
    Probe::new(catalog(), &parsed, "light").unwrap_or_else(|error| panic!("{recipe}: {error}"))
}

/// First channel of every row, in 32 or 64 bits.
fn evaluated(recipe: &str, rows: &[Json], double: bool) -> Vec<f64> {
    let probe = probe(recipe);
    let table = probe.table(rows).unwrap_or_else(|error| panic!("{recipe}: {error}"));
    if double {
        let values = probe.on_cpu::<f64>(&table).unwrap().values;
        return values.into_iter().map(|v| v[0]).collect();
    }
    let values = probe.on_cpu::<f32>(&table).unwrap().values;
    values.into_iter().map(|v| f64::from(v[0])).collect()
}

fn white(at: &At) -> Json {
    json!({"s": {"normal": at.normal.to_array(), "diffuse": [1, 1, 1]}, "v": at.normal.to_array(), "instances": [at.fields]})
}

/// Catches 0 / 0, overflow, light from a dark side and cancellation to below 0 in any approximation of the illuminance, for any shape; and an approximation that
/// is brighter than a sky of light. That of the point is, near by, and the reference's samples are, of huge lights at grazing angles.
#[test]
fn illuminance_is_finite_and_not_negative() {
    for shape in SHAPES {
        let all = configurations(shape);
        assert!(all.len() >= DRAWN + 60);
        let rows: Vec<Json> = all.iter().map(white).collect();
        for with in IRRADIANCE {
            let got = evaluated(&light(shape, &diffuse(with)), &rows, false);
            for ((got, row), at) in got.iter().zip(&rows).zip(&all) {
                assert!(got.is_finite() && *got >= 0.0, "{shape}, {with}: {got} of {row}");
                assert!(*got == 0.0 || !at.is_behind, "{shape}, {with}, from behind: {got} of {row}");
                assert!(
                    *got < 1.0001 || matches!(with, "centre" | "reference"),
                    "{shape}, {with}: {got} of {row}"
                );
            }
        }
    }
}

/// Catches a wrong closed form, a clip at the wrong side of the horizon, a branch that is off where it meets another, digits lost by small lights.
#[test]
fn form_factors_are_exact() {
    for shape in SHAPES {
        let all = configurations(shape);
        let rows: Vec<Json> = all.iter().map(white).collect();
        let got = evaluated(&light(shape, &diffuse("form-factor")), &rows, false);
        // Eight points across a thin tube, chords for the ends of a thick one.
        let (absolute, relative) = if shape.starts_with("tube") {
            (2e-5_f64, 1e-3)
        } else {
            (1e-6, 1e-4)
        };
        // A polygon's edges cancel where it is narrow or nearly edge-on.
        let cancelled = if shape == "polygon" { 1e-6 } else { 1e-7 };
        let mut worst: f64 = 0.0;
        for ((got, at), row) in got.iter().zip(&all).zip(&rows) {
            let error = (got - at.truth).abs();
            worst = worst.max(error);
            let allowed = relative * at.truth + absolute.min(0.01 * at.truth) + 1e-6 * at.share + cancelled * at.share.sqrt();
            assert!(error <= allowed, "{shape}: {got}, not {}, of {row}", at.truth);
        }
        println!("{shape}: {} configurations, largest difference {worst:.1e}", all.len());
    }
}

/// Catches samplers and densities that do not belong together, and a radiance that is seen where no sample goes: then the reference tends to
/// another number. Sixteen grids of samples at random tell their own standard error.
#[test]
fn the_reference_is_unbiased() {
    const GRIDS: usize = 16;
    for shape in SHAPES {
        let all: Vec<At> = configurations(shape).into_iter().step_by(12).filter(|at| at.truth > 1e-5).collect();
        let rows: Vec<Json> = all.iter().map(white).collect();
        let mut sums = vec![(0.0, 0.0); rows.len()];
        for seed in 1..=GRIDS {
            let area = format!(r#"(module: "area/reference", freeze: {{"strata": 6, "seed": {seed}}})"#);
            for (sum, got) in sums.iter_mut().zip(evaluated(&light(shape, &area), &rows, true)) {
                sum.0 += got;
                sum.1 += got * got;
            }
        }
        let n = GRIDS as f64;
        let mut off = 0;
        for ((sum, at), row) in sums.iter().zip(&all).zip(&rows) {
            let mean = sum.0 / n;
            let error = ((sum.1 / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
            let far = (mean - at.truth).abs();
            // Sixteen grids know their standard error only to a fifth; the closed form of a tube has an error of its own.
            assert!(
                far <= 6.0 * error + 1e-3 * at.truth + 1e-7,
                "{shape}: {mean} +- {error}, not {}, of {row}",
                at.truth
            );
            off += usize::from(far > 3.0 * error + 1e-3 * at.truth + 1e-7);
        }
        println!("{shape}: {} configurations, {off} beyond three standard errors", rows.len());
        assert!(
            off * 8 <= rows.len(),
            "{shape}: {off} of {} beyond three standard errors",
            rows.len()
        );
    }
}

/// Catches NaN, negative light and mirrors that are brighter than what they mirror, from the smoothest to the roughest surface, at grazing eyes.
#[test]
fn highlights_are_finite_and_bounded() {
    for shape in SHAPES {
        let all: Vec<At> = configurations(shape).into_iter().step_by(3).collect();
        for with in HIGHLIGHT {
            let with = if with == "reference" {
                r#"(module: "reference", freeze: {"strata": 4})"#.to_owned()
            } else {
                format!("\"{with}\"")
            };
            let area = format!(r#"(module: "split", fill: {{"specular": {with}}})"#);
            let recipe = format!(r#"(module: "with-brdf", fill: {{"lights": [{}]}})"#, light(shape, &area));
            let row = |(step, at): (usize, &At)| {
                let alpha = ALPHAS[step % ALPHAS.len()];
                let degrees = [0.0_f64, 45.0, 80.0, 89.9, 90.0, 95.0][step % 6];
                let frame = at.normal.any_orthonormal_vector();
                let mut v = at.normal * degrees.to_radians().cos() + frame * degrees.to_radians().sin();
                let cosine = at.normal.dot(at.place);
                // Every other eye looks at the mirrored light.
                if step % 2 == 0 && cosine > 0.0 {
                    v = (2.0 * cosine * at.normal - at.place).normalize();
                }
                let v = single3(v);
                json!({
                    "s": {"normal": at.normal.to_array(), "diffuse": [0, 0, 0], "f0": [1, 1, 1], "alpha": alpha, "widths": [alpha, alpha]},
                    "v": v.to_array(), "instances": [at.fields],
                })
            };
            let rows: Vec<Json> = all.iter().enumerate().map(row).collect();
            for (got, row) in evaluated(&recipe, &rows, false).iter().zip(&rows) {
                assert!(got.is_finite() && *got >= 0.0, "{shape}, {with}: {got} of {row}");
                assert!(*got <= 1.0001 || with.contains("strata"), "{shape}, {with}: {got} of {row}");
            }
        }
    }
}

/// Catches a place or a width of what is averaged that is no number, from any side and at any distance; light from a dark side; and means that are brighter
/// than the picture, whose red is at most 1.
#[test]
fn pictures_are_finite_and_bounded() {
    let all = configurations("rectangle");
    let pictured = |area: &str| format!(r#"(module: "light/rectangle", fill: {{"picture": "image", "area": {area}}})"#);
    for with in IRRADIANCE {
        let rows: Vec<Json> = all.iter().map(white).collect();
        for ((got, row), at) in evaluated(&pictured(&diffuse(with)), &rows, false).iter().zip(&rows).zip(&all) {
            assert!(got.is_finite() && *got >= 0.0, "{with}: {got} of {row}");
            assert!(*got == 0.0 || !at.is_behind, "{with}, from behind: {got} of {row}");
            assert!(*got < 1.0001 || matches!(with, "centre" | "reference"), "{with}: {got} of {row}");
        }
    }
    for with in ["representative-point", "d-modification", "overlap", "ltc"] {
        let area = format!(r#"(module: "split", fill: {{"specular": "{with}"}})"#);
        let recipe = format!(r#"(module: "with-brdf", fill: {{"lights": [{}]}})"#, pictured(&area));
        let row = |(step, at): (usize, &At)| {
            let alpha = ALPHAS[step % ALPHAS.len()];
            let v = single3((2.0 * at.normal.dot(at.place) * at.normal - at.place).normalize_or(at.normal));
            json!({
                "s": {"normal": at.normal.to_array(), "diffuse": [0, 0, 0], "f0": [1, 1, 1], "alpha": alpha, "widths": [alpha, alpha]},
                "v": v.to_array(), "instances": [at.fields],
            })
        };
        let rows: Vec<Json> = all.iter().enumerate().map(row).collect();
        for (got, row) in evaluated(&recipe, &rows, false).iter().zip(&rows) {
            assert!(got.is_finite() && (0.0..=1.0001).contains(got), "{with}: {got} of {row}");
        }
    }
}

/// Catches a pop or a rise where a light sinks below the horizon: its form factor falls all the way, and ends at 0.
#[test]
fn a_sinking_light_fades() {
    const STEPS: usize = 400;
    for shape in SHAPES {
        for (size, thin) in [(0.3, 0.5), (0.01, 1.0)] {
            let at = |step: usize| {
                // From where all of it is above the horizon to where nothing is.
                let height = 1.1 * size * (1.0 - 2.0 * step as f64 / STEPS as f64);
                let facing = if shape.starts_with("tube") { DVec3::Y } else { -DVec3::X };
                placed(shape, DVec3::new(1.0, 0.0, height), facing, size, thin, DVec3::Z)
            };
            let rows: Vec<Json> = (0..=STEPS).map(|step| white(&at(step))).collect();
            for with in ["form-factor", "representative-point"] {
                let got = evaluated(&light(shape, &diffuse(with)), &rows, false);
                assert!(
                    got[0] > 0.0 && got[STEPS] == 0.0,
                    "{shape}, {with}: from {} to {}",
                    got[0],
                    got[STEPS]
                );
                let slack = 2e-4 * got[0];
                for (step, pair) in got.windows(2).enumerate() {
                    assert!(pair[1] <= pair[0] + slack, "{shape} of {size}, {with}: {pair:?} at step {step}");
                    assert!(
                        pair[0] - pair[1] <= 0.05 * got[0],
                        "{shape} of {size}, {with}: a pop, {pair:?} at step {step}"
                    );
                }
            }
        }
    }
}

/// Catches an outline that is not closed where the horizon cuts it, or that leaves corners out: then the mirrored light pops, or does not end at 0.
#[test]
fn a_sinking_outline_fades() {
    const STEPS: usize = 400;
    for shape in SHAPES {
        for (size, thin, alpha) in [(0.3, 0.5, 0.04), (0.3, 1.0, 0.36), (0.3, 0.5, 1.0), (0.01, 1.0, 0.25)] {
            let row = |step: usize| {
                let height = 1.1 * size * (1.0 - 2.0 * step as f64 / STEPS as f64);
                let facing = if shape.starts_with("tube") { DVec3::Y } else { -DVec3::X };
                let at = placed(shape, DVec3::new(1.0, 0.0, height), facing, size, thin, DVec3::Z);
                json!({
                    "s": {"diffuse": [0, 0, 0], "f0": [1, 1, 1], "alpha": alpha, "widths": [alpha, alpha]},
                    "v": [-0.9, 0.0, 0.435_889_9], "instances": [at.fields],
                })
            };
            let rows: Vec<Json> = (0..=STEPS).map(row).collect();
            let got = evaluated(
                &light(shape, r#"(module: "split", fill: {"specular": "phong-lobe"})"#),
                &rows,
                false,
            );
            let most = got.iter().copied().fold(0.0, f64::max);
            assert!(
                most > 1e-6 && got[STEPS] == 0.0,
                "{shape} of {size}, {alpha}: {most}, at last {}",
                got[STEPS]
            );
            for (step, pair) in got.windows(2).enumerate() {
                assert!(
                    (pair[0] - pair[1]).abs() <= 0.05 * most,
                    "{shape} of {size}, {alpha}: a pop, {pair:?} at step {step}"
                );
            }
        }
    }
}

/// Catches a flux that is not conserved: over the area alone, over both sides where one shines, or growing with the size.
#[test]
fn flux_is_conserved_as_the_size_changes() {
    // All of the flux goes through a large sphere around the light: far away its illuminance is I / d^2, and the integral of I over all
    // directions is the flux.
    for (fields, recipe) in [
        (
            r#"{"radius": SIZE, "flux": 100}"#,
            r#"(module: "light/sphere", fill: {"area": AREA})"#,
        ),
        (
            r#"{"radius": SIZE, "flux": 100, "direction": [0, 0, 1]}"#,
            r#"(module: "light/disk", fill: {"area": AREA})"#,
        ),
        (
            r#"{"radius": SIZE, "flux": 100, "direction": [0, 0, 1]}"#,
            r#"(module: "light/disk", freeze: {"two_sided": true}, fill: {"area": AREA})"#,
        ),
        (
            r#"{"size": [SIZE, 0.3], "flux": 100, "direction": [0, 0, 1]}"#,
            r#"(module: "light/rectangle", fill: {"area": AREA})"#,
        ),
        (
            r#"{"radius": SIZE, "length": 0.4, "flux": 100, "along": [0, 0, 1]}"#,
            r#"(module: "light/tube", fill: {"area": AREA})"#,
        ),
        (
            r#"{"radius": SIZE, "length": 0.4, "flux": 100, "along": [0, 0, 1]}"#,
            r#"(module: "light/tube", freeze: {"caps": true}, fill: {"area": AREA})"#,
        ),
        (
            r#"{"flux": 100, "direction": [0, 0, 1], "corners": 3, "p2": [SIZE, SIZE]}"#,
            r#"(module: "light/polygon", fill: {"area": AREA})"#,
        ),
    ] {
        let recipe = recipe.replace("AREA", &diffuse("form-factor"));
        for size in ["0.001", "0.05", "0.5"] {
            let fields: Json = serde_json::from_str(&fields.replace("SIZE", size)).unwrap();
            const RINGS: usize = 64;
            let row = |ring: usize| {
                let cosine = 1.0 - (2.0 * ring as f64 + 1.0) / RINGS as f64;
                let place = direction(cosine.acos(), 0.7) * 300.0;
                json!({"s": {"position": place.to_array(), "normal": (-place / 300.0).to_array(), "diffuse": [1, 1, 1]}, "v": [0, 0, 1], "instances": [fields]})
            };
            let rows: Vec<Json> = (0..RINGS).map(row).collect();
            let got = evaluated(&recipe, &rows, false);
            let flux = got.iter().map(|radiance| radiance * PI).sum::<f64>() / RINGS as f64 * 4.0 * PI * 300.0 * 300.0;
            assert!((flux / 100.0 - 1.0).abs() < 2e-3, "{recipe}, {size}: {flux} lm");
        }
    }
}
