//! The table of transformed cosines for anisotropic GGX against truth: the lights of `cosines.rs`, seen from a random azimuth. Beside it stand the
//! isotropic table with the mean width, and its map stretched as the facets are, which needs no table.
//!
//! `cargo test --release -p shadewright-modules --features oracles --test anisotropic -- --nocapture` prints the errors by widths.

#![cfg(feature = "oracles")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod rectangles;

use std::f64::consts::PI;
use std::thread;

use glam::{DMat3, DVec3};
use rectangles::{LIGHTS, Light, Quadrature, Random, error, lights, mirrored};
use shadewright_modules::library;
use shadewright_modules::oracles::anisotropic::{NUMBERS, SIDES, View, look_up, row, stretched};
use shadewright_modules::oracles::cosines;
use shadewright_modules::oracles::drawn::{Widths, ggx_anisotropic};

/// Root mean square and largest error.
type Error = (f64, f64);

/// The wider width, the narrower, and the errors of the isotropic table, of its map stretched and of the table, as they were when this was written.
const ERRORS: [(f64, f64, [Error; 3]); 7] = [
    (0.00354, 0.00177, [(0.00130, 0.0100), (0.00024, 0.0009), (0.00007, 0.0003)]),
    (0.02, 0.005, [(0.01200, 0.0743), (0.00232, 0.0101), (0.00162, 0.0076)]),
    (0.08, 0.02, [(0.03636, 0.1237), (0.01324, 0.0616), (0.00758, 0.0380)]),
    (0.245, 0.245, [(0.00843, 0.0333), (0.00843, 0.0333), (0.00911, 0.0358)]),
    (0.245, 0.06125, [(0.06520, 0.2063), (0.03933, 0.1861), (0.01666, 0.0906)]),
    (0.79, 0.079, [(0.14486, 0.4356), (0.07845, 0.3516), (0.01248, 0.0404)]),
    (1.0, 0.25, [(0.07331, 0.2827), (0.05935, 0.2545), (0.00603, 0.0200)]),
];

/// A file of floats in the library.
fn kept(path: &str) -> Vec<f32> {
    let bytes = library().bytes(path).unwrap().unwrap();
    bytes.as_chunks::<4>().0.iter().map(|word| f32::from_le_bytes(*word)).collect()
}

/// GGX of two widths for F = 1 times the cosine, x along the wider: Burley 2012; Heitz 2014, eqs. 85 and 99. 0 below the horizon.
fn density(wide: f64, thin: f64, v: DVec3, l: DVec3) -> f64 {
    if l.z <= 0.0 {
        return 0.0;
    }
    let h = (v + l).normalize();
    let (x, y) = (h.x / wide, h.y / thin);
    let k = x * x + y * y + h.z * h.z;
    let length = |w: DVec3| DVec3::new(wide * w.x, thin * w.y, w.z).length();
    0.5 * l.z / (PI * wide * thin * k * k * (l.z * length(v) + v.z * length(l)))
}

/// The view of a light from an azimuth.
fn view(wide: f64, thin: f64, azimuth: f64, light: &Light) -> View {
    View {
        major: wide,
        ratio: thin / wide,
        azimuth: (azimuth.cos(), azimuth.sin()),
        theta: light.theta,
    }
}

/// What the surface sends toward the viewer, whose azimuth the light is told from.
fn truth(wide: f64, thin: f64, azimuth: f64, light: &Light) -> f64 {
    let turn = DMat3::from_rotation_z(azimuth);
    let v = turn * DVec3::new(light.theta.sin(), 0.0, light.theta.cos());
    Quadrature::of(&|l| density(wide, thin, v, turn * l), (thin, wide), light)
}

/// Errors of the isotropic table, of its map stretched and of the table.
fn errors(wide: f64, thin: f64, lights: &[(f64, Light)], round: &[f32], table: &[f32]) -> [Error; 3] {
    let truths: Vec<f64> = lights.iter().map(|(azimuth, light)| truth(wide, thin, *azimuth, light)).collect();
    let of = |answer: &dyn Fn(&View) -> (DMat3, f64, f64)| {
        let mirrored = |(azimuth, light): &(f64, Light)| {
            let (map, integral, _) = answer(&view(wide, thin, *azimuth, light));
            mirrored(map, integral, light)
        };
        error(lights.iter().map(mirrored), &truths)
    };
    let isotropic = |alpha: f64, view: &View| cosines::look_up(round, cosines::SIDE, alpha, view.theta.cos());
    [
        of(&|view| isotropic((wide * thin).sqrt(), view)),
        of(&|view| {
            let (map, integral, grazing) = isotropic(view.widths().along, view);
            (stretched(map, &view.widths()), integral, grazing)
        }),
        of(&|view| look_up(table, SIDES, view)),
    ]
}

/// Catches a table that is worse than it was, or than what needs none where facets are rough; a lookup that does not fit the table. Both others
/// are pinned as well: what they cost is why there is a table.
#[test]
fn the_table_is_better_than_a_stretched_map() {
    let round = kept("cosines/ggx-lobe/ggx-lobe.f32");
    let table = kept("highlight/ltc-anisotropic/ltc-anisotropic.f32");
    let mut random = Random(77);
    let lights = lights().into_iter().take(LIGHTS / 6);
    let lights: Vec<(f64, Light)> = lights.map(|light| (random.between(0.0, 2.0 * PI), light)).collect();
    let found: Vec<[Error; 3]> = thread::scope(|scope| {
        let job = |(wide, thin, _): &(f64, f64, _)| {
            let (wide, thin, lights, round, table) = (*wide, *thin, &lights, &round, &table);
            scope.spawn(move || errors(wide, thin, lights, round, table))
        };
        let jobs: Vec<_> = ERRORS.iter().map(job).collect();
        jobs.into_iter().map(|job| job.join().unwrap()).collect()
    });
    println!("widths           isotropic         stretched         table      (RMS, largest)");
    for ((wide, thin, pinned), found) in ERRORS.iter().zip(&found) {
        let line = found.map(|(rms, largest)| format!("{rms:.5}  {largest:.4}")).join("   ");
        println!("{wide:.5} {thin:.5}  {line}");
        for (found, pinned) in found.iter().zip(pinned) {
            let is_no_worse = found.0 < pinned.0 * 1.02 + 1e-5 && found.1 < pinned.1 * 1.02 + 1e-4;
            assert!(is_no_worse, "{wide}, {thin}: {found:?}, was {pinned:?}");
        }
        assert!(found[2].0 < found[1].0 || *wide < 0.05 || wide == thin, "{wide}, {thin}: {found:?}");
    }
}

/// Catches a fit that is not the same on this machine, to the last bit: rows of the shipped table are fitted again. The whole takes a minute.
#[test]
fn rows_are_fitted_to_the_same_bits() {
    let table = kept("highlight/ltc-anisotropic/ltc-anisotropic.f32");
    assert_eq!(table.len(), SIDES.iter().product::<usize>() * NUMBERS);
    for index in [[0, 0, 0], [2, 1, 3], [6, 4, 4]] {
        let start = ((index[0] * SIDES[1] + index[1]) * SIDES[2] + index[2]) * SIDES[3] * NUMBERS;
        let cells = row(index, SIDES);
        let fitted: Vec<u32> = cells.as_flattened().iter().map(|number| (*number as f32).to_bits()).collect();
        let found: Vec<u32> = table[start..start + fitted.len()].iter().map(|number| number.to_bits()).collect();
        assert_eq!(found, fitted, "{index:?}");
    }
}

/// Catches a quadrature of another lobe than the one that is fitted: what is on one side of a plane through the normal, by samples and as a long wall.
#[test]
fn all_mean_the_same_lobe() {
    for (wide, thin, azimuth, theta) in [
        (0.1, 0.1, 0.0, 1.2),
        (0.4, 0.1, 0.7, 0.8),
        (0.3, 0.05, 2.3, 1.4),
        (1.0, 0.2, -1.3, 0.4),
    ] {
        let far = 1e3;
        let corners = [
            DVec3::new(-far, 0.2, 1e-9),
            DVec3::new(far, 0.2, 1e-9),
            DVec3::new(far, 0.2, far),
            DVec3::new(-far, 0.2, far),
        ];
        let wall = truth(wide, thin, azimuth, &Light { theta, corners });
        let widths = Widths::seen(wide, thin, (f64::cos(azimuth), f64::sin(azimuth)));
        let samples = ggx_anisotropic(widths, DVec3::new(theta.sin(), 0.0, theta.cos()), 256);
        let side: f64 = samples.iter().filter(|sample| sample.l.y > 0.0).map(|sample| sample.weight).sum();
        assert!((wall - side).abs() < 6e-3, "{wide} {thin} {azimuth} {theta}: {wall}, {side}");
    }
}

/// Catches a map that is not told by its numbers, a table whose lookup is undefined at its ends, and one that has other lobes from the other side: finite and not
/// negative from the smallest widths to the largest, at all angles, alike for opposite azimuths of a lobe's axes.
#[test]
fn maps_are_finite_everywhere() {
    let table = kept("highlight/ltc-anisotropic/ltc-anisotropic.f32");
    let mut random = Random(5);
    for step in 0..20_000 {
        let mut width = || {
            if step % 7 == 0 {
                1.0
            } else {
                10f64.powf(random.between(-4.0, 0.0))
            }
        };
        let (one, other) = (width(), width());
        let azimuth = random.between(0.0, 2.0 * PI);
        let theta = if step % 3 == 0 {
            0.5 * PI - 1e-6
        } else {
            random.between(0.0, 0.5 * PI - 1e-6)
        };
        let at = |azimuth: (f64, f64)| View {
            major: one.max(other),
            ratio: one.min(other) / one.max(other),
            azimuth,
            theta,
        };
        let (c, s) = (azimuth.cos(), azimuth.sin());
        let (map, integral, grazing) = look_up(&table, SIDES, &at((c, s)));
        assert!(map.is_finite() && map.determinant() > 0.0, "{one} {other} {azimuth} {theta}: {map}");
        assert!(
            (0.0..1.000_001).contains(&integral) && (0.0..=1.0).contains(&grazing),
            "{one} {other}: {integral} {grazing}"
        );
        // The ellipse of slopes looks the same from the other side; the map is another by a turn about the cosine's axis alone.
        let (turned, ..) = look_up(&table, SIDES, &at((-c, -s)));
        let (gram, other_gram) = (map.transpose() * map, turned.transpose() * turned);
        assert!(
            (gram - other_gram).abs_diff_eq(
                DMat3::ZERO,
                1e-9 * (1.0 + gram.x_axis.length() + gram.y_axis.length() + gram.z_axis.length())
            ),
            "{one} {other} {azimuth} {theta}"
        );
    }
}
