//! What one permutation allocates and what it leaves allocated, counted: the same in every run.
#![allow(clippy::print_stderr, reason = "a failing bench says so")]

use std::alloc::System;
use std::process::ExitCode;

use shadewright_benchmark::Subject;
use shadewright_benchmark::peers::{concatenation::concatenate, oil, parse_and_validate, wesl};
use shadewright_benchmark::pieces::pieces;
use shadewright_benchmark::table::{Arguments, bytes, table};
use shadewright_compiler::{Report, validate as gate};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static COUNTED: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

fn said<T>(result: Result<T, Report>) -> Result<T, String> {
    result.map_err(|report| report.render())
}

/// Runs twice, so that whatever is kept from the first run is there, and counts the second.
fn counted<T>(name: &str, mut make: impl FnMut() -> Result<T, String>) -> Result<Vec<String>, String> {
    drop(make()?);
    let region = Region::new(COUNTED);
    let made = make()?;
    let change = region.change();
    drop(made);
    let kept = change.bytes_allocated as f64 - change.bytes_deallocated as f64;
    Ok(vec![
        name.to_owned(),
        (change.allocations + change.reallocations).to_string(),
        bytes(change.bytes_allocated as f64),
        bytes(kept),
    ])
}

fn run() -> Result<(), String> {
    let arguments = Arguments::read()?;
    let subject = Subject::load()?;
    let pieces = pieces(&subject.program)?;
    let Subject { catalog, recipe, program } = &subject;
    let plan = said(catalog.plan(recipe, "main"))?;
    let sources = oil::Sources::new(&pieces);
    let mut composer = sources.composer(true)?;
    let wesl = wesl::Compiler::new(&pieces, false)?;
    let rows = vec![
        counted("ours: program (IR, its validation, plan)", || {
            said(catalog.compile(recipe, "main"))
        })?,
        counted("ours: plan", || said(catalog.plan(recipe, "main")))?,
        counted("ours: IR written from a plan", || said(plan.link()))?,
        counted("ours: validated IR, plan thrown away", || {
            let module = said(catalog.plan(recipe, "main").and_then(|plan| plan.link()))?;
            gate::validate(module).map_err(|e| e.to_string())
        })?,
        counted("ours: reflection", || Ok(program.reflection().clone()))?,
        counted("ours: WGSL text, plan thrown away", || {
            said(catalog.plan(recipe, "main").and_then(|plan| plan.source()))
        })?,
        counted("naga_oil, modules built: IR", || sources.make(&mut composer))?,
        counted("wesl, no checks: WGSL text", || wesl.text())?,
        counted("concatenation: parsed and validated IR", || {
            parse_and_validate(&concatenate(&pieces))
        })?,
    ];
    let header = ["what is made and kept", "allocations", "bytes allocated", "bytes kept"];
    arguments.publish("memory", &table(&header, &rows))
}
