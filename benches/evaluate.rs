//! How fast the evaluator runs a BRDF: `cargo bench --bench evaluate`.

#![allow(clippy::print_stdout)] // that is what it is for

use std::time::Instant;

use serde_json::{Value as Json, json};
use shadewright::compiler::{Catalog, Recipe};
use shadewright::evaluate::{Allowed, Counts, Kind, Number};
use shadewright::modules::library;
use shadewright::runtime::probe::{Probe, Table};

const ROWS: usize = 20_000;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let catalog = Catalog::load(library())?;
    let recipe = Recipe::parse("bench", "\"microfacet\"")?;
    let probe = Probe::new(&catalog, &recipe, "brdf")?;
    let row = |i: usize| {
        let (a, b) = ((i as f64 * 0.618).fract() * 1.5, (i as f64 * 0.414).fract() * 6.0);
        json!({"s": {"alpha": 0.01 + 0.9 * (i as f64 * 0.732).fract()}, "v": [a.sin(), 0, a.cos()], "l": [0.6 * b.cos(), 0.6 * b.sin(), 0.8]})
    };
    let rows: Vec<Json> = (0..ROWS).map(row).collect();
    let table = probe.table(&rows)?;
    println!("microfacet brdf, {ROWS} rows, {} threads", std::thread::available_parallelism()?);
    measure::<f32>(&probe, &table)?;
    measure::<f64>(&probe, &table)?;
    measure::<Allowed>(&probe, &table)?;
    Ok(())
}

fn measure<N: Number>(probe: &Probe, table: &Table) -> Result<(), Failure> {
    let mut best = f64::INFINITY;
    let mut counts = Counts::default();
    for _ in 0..9 {
        let start = Instant::now();
        let evaluated = probe.on_cpu::<N>(table)?;
        best = best.min(start.elapsed().as_secs_f64());
        counts = evaluated.executed[0];
    }
    let operations: u64 = Kind::ALL.iter().map(|kind| counts[*kind]).sum();
    let threads = std::thread::available_parallelism()?.get() as f64;
    println!(
        "{:<8} {:>9.0} rows/s, {:>5.2} us a row and thread, {operations} operations in the first",
        N::NAME,
        table.len() as f64 / best,
        best / table.len() as f64 * 1e6 * threads
    );
    Ok(())
}
