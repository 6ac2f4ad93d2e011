//! Runs snippets of WGSL.
#![allow(dead_code, clippy::expect_used, clippy::unwrap_used)]

use naga::valid::{Capabilities, ValidationFlags, Validator};
use shadewright_evaluate::{EvaluateError, Invocation, Limits, Machine, Number, Program, Value};

/// A parsed and validated module.
pub struct Checked {
    pub module: naga::Module,
    pub info: naga::valid::ModuleInfo,
}

/// Parses and validates.
pub fn check(source: &str) -> Checked {
    let module = naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
    let info = info.unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)));
    Checked { module, info }
}

/// The program of the entry point `main`.
pub fn program(source: &str) -> Program {
    let checked = check(source);
    Program::new(&checked.module, &checked.info, "main", &[], Limits::default()).unwrap_or_else(|error| panic!("{error}\n{source}"))
}

/// Runs a body that writes `out[0]`, `out[1]` ... of a type, once, and gives the numbers.
pub fn run<N: Number>(ty: &str, body: &str) -> Result<Vec<Value<N>>, EvaluateError> {
    run_source(&format!(
        "@group(0) @binding(0) var<storage, read_write> out: array<{ty}, 8>;
        @group(0) @binding(1) var<storage, read_write> in: array<f32, 16>;
        @compute @workgroup_size(1) fn main() {{ {body} }}"
    ))
}

/// Runs `main` of a module once, and gives the numbers of binding 0 of group 0.
pub fn run_source<N: Number>(source: &str) -> Result<Vec<Value<N>>, EvaluateError> {
    let program = program(source);
    let mut machine = Machine::<N>::new(&program)?;
    machine.run(&Invocation::default())?;
    machine.values(0, 0)
}

/// An f32 from an expression.
pub fn float(expression: &str) -> f32 {
    floats(&format!("out[0] = {expression};"))[0]
}

/// The f32 that a body writes.
pub fn floats(body: &str) -> Vec<f32> {
    let values = run::<f32>("f32", body).unwrap_or_else(|error| panic!("{error}: {body}"));
    values.into_iter().map(Value::number).collect()
}

/// The u32 that a body writes.
pub fn uints(body: &str) -> Vec<u32> {
    let values = run::<f32>("u32", body).unwrap_or_else(|error| panic!("{error}: {body}"));
    values
        .into_iter()
        .map(|value| if let Value::Uint(x) = value { x } else { panic!("{value:?}") })
        .collect()
}

/// The i32 that a body writes.
pub fn ints(body: &str) -> Vec<i32> {
    let values = run::<f32>("i32", body).unwrap_or_else(|error| panic!("{error}: {body}"));
    values
        .into_iter()
        .map(|value| if let Value::Int(x) = value { x } else { panic!("{value:?}") })
        .collect()
}
