//! What one stage hands to the next.

use naga::{Binding, Handle, ShaderStage, Type, TypeInner};

use super::{Body, Plan};

/// A member of an entry point's result.
pub struct Output {
    /// The struct.
    pub id: usize,
    /// Its member.
    pub member: u32,
    /// Struct and member of the fragment stages' inputs that read it; `None` where somebody outside the shader does.
    pub readers: Option<Vec<(usize, u32)>>,
}

/// Outputs of all stages.
pub fn outputs(plan: &Plan) -> Vec<Output> {
    let mut inputs = Vec::new();
    for planned in &plan.functions {
        let Body::Entry(index) = planned.body else { continue };
        let entry = &plan.homes[planned.home].unit.ir.entry_points[index];
        if entry.stage == ShaderStage::Fragment {
            for argument in &entry.function.arguments {
                for (id, member, binding) in members(plan, planned.home, argument.ty) {
                    inputs.extend(location(binding).map(|location| (location, (id, member))));
                }
            }
        }
    }
    let mut outputs = Vec::new();
    for planned in &plan.functions {
        let Body::Entry(index) = planned.body else { continue };
        let entry = &plan.homes[planned.home].unit.ir.entry_points[index];
        let Some(result) = &entry.function.result else { continue };
        for (id, member, binding) in members(plan, planned.home, result.ty) {
            let location = location(binding).filter(|_| entry.stage == ShaderStage::Vertex);
            let readers = location.map(|at| inputs.iter().filter(|(l, _)| *l == at).map(|&(_, input)| input).collect());
            outputs.push(Output { id, member, readers });
        }
    }
    outputs
}

fn location(binding: Option<&Binding>) -> Option<u32> {
    match binding {
        Some(Binding::Location { location, .. }) => Some(*location),
        _ => None,
    }
}

fn members(plan: &Plan, home: usize, ty: Handle<Type>) -> impl Iterator<Item = (usize, u32, Option<&Binding>)> {
    let unit = &plan.homes[home].unit;
    let (members, id) = match (&unit.ir.types[ty].inner, plan.structs.id(home, ty)) {
        (TypeInner::Struct { members, .. }, Some(id)) => (members.as_slice(), id),
        _ => (&[][..], 0),
    };
    members
        .iter()
        .enumerate()
        .map(move |(index, m)| (id, index as u32, m.binding.as_ref()))
}
