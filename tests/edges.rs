//! What a polygon's edge gives to its form factor: the angle that it is seen under, along the normal of the plane through it and the eye. Everything that
//! integrates over polygons stands on it, and the usual ways lose it for edges that are far, tiny or near.

#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

use std::fs;
use std::sync::Arc;

use serde_json::json;
use shadewright::compiler::{Catalog, Recipe};
use shadewright::modules::{Folder, Overlay, library};
use shadewright::runtime::probe::Probe;

/// As polygons have it: start and edge, and never the end minus the start.
const MODULE: &str = "fn irradiance(i: u32, s: Surface) -> vec3f {
    let across = cross(s.position, s.normal);
    return across * angle_over_sine(length(across), dot(s.position, s.position + s.normal));
}
";

/// Edges of each kind.
const EDGES: usize = 50_000;

/// Steele, Lea and Flood 2014, splitmix64.
struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }

    fn direction(&mut self) -> [f64; 3] {
        let (z, phi) = (self.between(-1.0, 1.0), self.between(0.0, std::f64::consts::TAU));
        let sine = (1.0 - z * z).sqrt();
        [sine * phi.cos(), sine * phi.sin(), z]
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Start and edge of an edge of a kind. Where an edge nearly points at the eye, or goes past it, the cross product of its rounded numbers has lost digits
/// before the function sees it: tiny edges are at right angles to their starts, and those that go past lie along an axis.
fn edge(random: &mut Random, kind: usize) -> ([f64; 3], [f64; 3]) {
    let (a, other) = (random.direction(), random.direction());
    let aside = cross(a, other);
    let aside = aside.map(|x| x / dot(aside, aside).sqrt());
    match kind {
        0 if dot(a, other) < -0.99 => edge(random, kind),
        0 => (a, [other[0] - a[0], other[1] - a[1], other[2] - a[2]]),
        1 => {
            let size = 10_f64.powf(random.between(-7.0, -1.0));
            (a.map(|x| x * 30.0), aside.map(|x| x * size))
        }
        2 => {
            let near = 10_f64.powf(random.between(-6.0, -1.0));
            (
                [-random.between(0.1, 1.0), near * a[0], near * a[1]],
                [random.between(1.0, 3.0), 0.0, 0.0],
            )
        }
        _ => {
            let (p, q) = (10_f64.powf(random.between(-3.0, 3.0)), 10_f64.powf(random.between(-3.0, 3.0)));
            (a.map(|x| x * p), aside.map(|x| x * q))
        }
    }
}

/// Catches an edge integral that is off by more than 2e-6 of itself at any angle: a built-in arc cosine or arc tangent, a clamp of 1 - c^2, ends that are
/// subtracted, a polynomial with too few terms. What cancels before the function, in the cross product of inputs that are rounded already, is
/// kept out by the choice of edges.
#[test]
fn edges_keep_their_digits() {
    let folder = tempfile::tempdir().unwrap();
    let module = folder.path().join("irradiance/edge");
    fs::create_dir_all(&module).unwrap();
    fs::write(module.join("module.ron"), "(summary: \"An edge\", uses: [\"horizon\"])").unwrap();
    fs::write(module.join("edge.wgsl"), MODULE).unwrap();
    fs::write(module.join("README.md"), "# edge\n").unwrap();
    fs::write(module.join("cases.ron"), "[]").unwrap();
    let layers = Overlay(vec![Arc::new(Folder::new(folder.path())), library()]);
    let catalog = Catalog::load(Arc::new(layers)).unwrap_or_else(|report| panic!("{report}"));
    let probe = Probe::new(&catalog, &Recipe::parse("test", "irradiance/edge").unwrap(), "irradiance").unwrap();
    let row = json!({"i": 0, "s": {"position": [1, 0, 0], "normal": [0, 1, 0]}});
    let names = [
        "s.position.x",
        "s.position.y",
        "s.position.z",
        "s.normal.x",
        "s.normal.y",
        "s.normal.z",
    ];
    let mut random = Random(5);
    for (kind, what) in ["random", "tiny and far", "seen under nearly pi", "of all lengths"]
        .iter()
        .enumerate()
    {
        let edges: Vec<_> = (0..EDGES).map(|_| edge(&mut random, kind)).collect();
        let numbers: Vec<[f32; 6]> = edges
            .iter()
            .map(|(a, d)| [a[0], a[1], a[2], d[0], d[1], d[2]].map(|x| x as f32))
            .collect();
        let columns: Vec<Vec<f32>> = (0..6).map(|k| numbers.iter().map(|row| row[k]).collect()).collect();
        let varied: Vec<(&str, &[f32])> = names
            .iter()
            .zip(&columns)
            .map(|(name, column)| (*name, column.as_slice()))
            .collect();
        let found = probe.on_cpu::<f32>(&probe.varied(&row, &varied).unwrap()).unwrap();
        let mut worst = (0.0, 0);
        for (index, (row, found)) in numbers.iter().zip(&found.values).enumerate() {
            let [x, y, z, u, v, w] = row.map(f64::from);
            let (a, d) = ([x, y, z], [u, v, w]);
            let across = cross(a, d);
            let sine = dot(across, across).sqrt();
            let scale = sine.atan2(dot(a, [x + u, y + v, z + w])) / sine;
            let wrong: [f64; 3] = [0, 1, 2].map(|k| f64::from(found[k]) - across[k] * scale);
            let error = dot(wrong, wrong).sqrt() / (sine * scale);
            if error > worst.0 {
                worst = (error, index);
            }
        }
        println!("{what}: {:.1e} at {:?}", worst.0, numbers[worst.1]);
        assert!(worst.0 < 2e-6, "{what}: {:.1e} at {:?}", worst.0, numbers[worst.1]);
    }
}
