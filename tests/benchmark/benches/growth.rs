//! Time and memory of 10 to 10 000 permutations, each measurement in a process of its own.
#![allow(clippy::print_stderr, clippy::print_stdout, reason = "a bench's output, and its child's answer")]

use std::path::Path;
use std::process::{Command, ExitCode};
use std::time::Instant;

use rayon::prelude::*;
use shadewright_benchmark::permutations::permutations;
use shadewright_benchmark::process::resident;
use shadewright_benchmark::table::{Arguments, bytes, table, time};
use shadewright_compiler::{Catalog, Program, Recipe, Report, Validated, validate};

/// Every measurement is made this often; the middle one counts.
const REPEATS: usize = 3;

/// What stays of every permutation.
const KEPT: [(&str, &str); 3] = [
    ("program", "program: IR, its validation, plan"),
    ("module", "validated IR alone"),
    ("text", "WGSL text alone"),
];

fn main() -> ExitCode {
    let done = Arguments::read().and_then(|arguments| match arguments.rest.as_slice() {
        [child, kept, count, threads] if child == "child" => measure(kept, count, threads),
        _ => all(&arguments),
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn all(arguments: &Arguments) -> Result<(), String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let counts: &[usize] = if arguments.quick {
        &[10, 100, 1000]
    } else {
        &[10, 100, 1000, 10_000]
    };
    let mut rows = Vec::new();
    for (kept, described) in KEPT {
        for count in counts {
            for threads in [1usize, 2] {
                let answers: Result<Vec<[f64; 6]>, String> = (0..REPEATS).map(|_| child(&own, kept, *count, threads)).collect();
                let mut answers = answers?;
                answers.sort_by(|a, b| a[2].total_cmp(&b[2]));
                let [made, different, seconds, before, after, most] = answers[REPEATS / 2];
                let memory = |value: f64| if after > 0.0 { bytes(value) } else { "-".to_owned() };
                rows.push(vec![
                    described.to_owned(),
                    made.to_string(),
                    if different > 0.0 { different.to_string() } else { "-".to_owned() },
                    threads.to_string(),
                    time(seconds),
                    time(seconds / made),
                    memory((after - before) / made),
                    memory(most),
                ]);
            }
        }
    }
    let header = [
        "kept",
        "permutations",
        "different shaders",
        "threads",
        "time",
        "time each",
        "memory each",
        "peak memory of the process",
    ];
    arguments.publish("growth", &table(&header, &rows))
}

/// A measurement in a process of its own: what [`measure`] prints.
fn child(own: &Path, kept: &str, count: usize, threads: usize) -> Result<[f64; 6], String> {
    let output = Command::new(own)
        .args(["child", kept, &count.to_string(), &threads.to_string()])
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("{count} permutations, {kept}: {}", String::from_utf8_lossy(&output.stderr)));
    }
    let answer = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<f64> = answer.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    numbers.try_into().map_err(|_| format!("the child answered {answer}"))
}

enum Product {
    Program(Box<Program>),
    Module(Box<Validated>),
    Text(String),
}

/// The child's part: prints how many were made, different ones among them (0: not asked), seconds, resident bytes before and after, peak.
fn measure(kept: &str, count: &str, threads: &str) -> Result<(), String> {
    let number = |text: &str| text.parse::<usize>().map_err(|_| format!("`{text}` is no number"));
    let said = |report: Report| report.render();
    let catalog = Catalog::load(shadewright_modules::library()).map_err(said)?;
    let recipes: Vec<Recipe> = permutations(&catalog, "forward", number(count)?)?
        .into_iter()
        .map(Recipe::from)
        .collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number(threads)?).build();
    let pool = pool.map_err(|error| error.to_string())?;
    let make = |recipe: &Recipe| match kept {
        "program" => Ok(Product::Program(Box::new(catalog.compile(recipe, "main").map_err(said)?))),
        "module" => {
            let module = catalog.plan(recipe, "main").and_then(|plan| plan.link()).map_err(said)?;
            let validated = validate::validate(module).map_err(|error| error.to_string())?;
            Ok(Product::Module(Box::new(validated)))
        }
        _ => catalog
            .plan(recipe, "main")
            .and_then(|plan| plan.source())
            .map(Product::Text)
            .map_err(said),
    };
    let (before, _) = resident().unwrap_or_default();
    let start = Instant::now();
    let made: Result<Vec<Product>, String> = pool.install(|| recipes.par_iter().map(make).collect());
    let seconds = start.elapsed().as_secs_f64();
    let made = made?;
    let (after, most) = resident().unwrap_or_default();
    let mut hashes: Vec<u128> = Vec::new();
    for product in &made {
        match product {
            Product::Program(program) => hashes.push(program.hash()),
            Product::Module(module) => debug_assert!(!module.module().entry_points.is_empty()),
            Product::Text(text) => debug_assert!(!text.is_empty()),
        }
    }
    hashes.sort_unstable();
    hashes.dedup();
    println!("{} {} {seconds} {before} {after} {most}", made.len(), hashes.len());
    Ok(())
}
