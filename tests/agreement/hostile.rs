//! Every program of the repository, with buffers and textures that mean no good.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use proptest::prelude::*;
use shadewright::compiler::{Program as Linked, Recipe};
use shadewright::evaluate::{Allowed, EvaluateError, Invocation, Limits, Machine, Number, Program, Sampler, Texture};

use super::common::catalog;

/// All entry points of the example recipes and of the passes with their defaults.
fn programs() -> &'static [(String, Arc<Linked>)] {
    static PROGRAMS: OnceLock<Vec<(String, Arc<Linked>)>> = OnceLock::new();
    PROGRAMS.get_or_init(made)
}

fn made() -> Vec<(String, Arc<Linked>)> {
    let mut recipes: Vec<Recipe> = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/recipes");
    for entry in std::fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.unwrap().path();
        if path.to_string_lossy().ends_with(".recipe.ron") {
            recipes.push(Recipe::parse(&path.to_string_lossy(), &std::fs::read_to_string(&path).unwrap()).unwrap());
        }
    }
    for module in catalog().modules().filter(|module| module.category == "pass") {
        recipes.push(Recipe::parse("default", &format!("\"{}\"", module.name)).unwrap());
    }
    let mut programs = Vec::new();
    for recipe in &recipes {
        for program in catalog().compile_all(recipe).unwrap_or_else(|report| panic!("{report}")) {
            let program = Arc::new(program);
            for entry in &program.reflection().entry_points {
                programs.push((entry.name.clone(), Arc::clone(&program)));
            }
        }
    }
    assert!(programs.len() > 6, "{}", programs.len());
    programs
}

fn run<N: Number>(program: &Program, linked: &Linked, bytes: &[u8], invocation: &Invocation) -> Result<(), EvaluateError> {
    let mut machine = Machine::<N>::new(program)?;
    let texels: Vec<f32> = bytes
        .chunks_exact(4)
        .take(16)
        .filter_map(|b| b.first_chunk::<4>())
        .map(|b| f32::from_le_bytes(*b))
        .collect();
    for binding in &linked.reflection().bindings {
        let (group, number) = (binding.group, binding.binding);
        // Whatever of these fits.
        let _ = machine.bind_buffer(group, number, bytes);
        let _ = machine.bind_sampler(
            group,
            number,
            Sampler {
                linear: bytes.len().is_multiple_of(2),
                repeat: bytes.len().is_multiple_of(3),
            },
        );
        if let Ok(texture) = Texture::new(2, 2, 1, 4, vec![texels.clone()]) {
            let _ = machine.bind_texture(group, number, Arc::new(texture));
        }
    }
    machine.run(invocation)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    /// Catches a panic or a hang of the evaluator on any program of the repository, whatever its buffers hold and however long they are.
    #[test]
    fn any_bytes_are_survived(bytes in prop::collection::vec(any::<u8>(), 0..2400), x in any::<u32>(), at in prop::array::uniform4(any::<f32>())) {
        let limits = Limits { steps: 20_000, numbers: 1 << 18 };
        let invocation = Invocation {
            global_invocation_id: [x, x / 3, 0],
            vertex_index: x,
            instance_index: x,
            position: at.map(f64::from),
            locations: (0..8).map(|location| (location, at.map(f64::from).to_vec())).collect(),
            ..Invocation::default()
        };
        for (entry, linked) in programs() {
            let validated = linked.validated();
            let program = Program::new(validated.module(), validated.info(), entry, &[], limits).unwrap();
            let results = [
                run::<f32>(&program, linked, &bytes, &invocation),
                run::<f64>(&program, linked, &bytes, &invocation),
                run::<Allowed>(&program, linked, &bytes, &invocation),
            ];
            for result in results {
                let known = matches!(&result, Ok(()) | Err(EvaluateError::Steps { .. } | EvaluateError::Unsupported(_) | EvaluateError::TooLarge { .. }));
                prop_assert!(known, "{entry}: {result:?}");
                // Indices are clamped before this is asked.
                let outside = matches!(&result, Err(EvaluateError::Unsupported(what)) if what.contains("outside of its variable"));
                prop_assert!(!outside, "{entry}: {result:?}");
            }
        }
    }
}
