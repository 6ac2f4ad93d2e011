//! What a frame needs before it can be drawn: each program in each state, in the order in which they are needed first.
//!
//! The same list is what [`Renderer::prepare`](super::Renderer::prepare) makes, so that the two cannot differ.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use serde::Serialize;
use shadewright_compiler::catalog::Catalog;
use shadewright_compiler::manifest::Node;
use shadewright_compiler::program::Program;

use super::Frame;
use super::draw::{CASTER, SCREEN, overridden, scene_state};
use super::fill::Look;
use super::list::{Cut, List, world_bounds};
use super::plan::{Compute, Plan};
use super::programs::Programs;
use super::target::FULL;
use super::view::Eye;
use crate::gpu::pipeline::{Constants, Pipelines, RenderRequest, RenderState, bits};
use crate::gpu::{DataError, GpuError, RuntimeError};

/// When a pipeline is used first; a frame goes through them in this order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Stage {
    /// An object is drawn into a shadow map.
    ShadowMap,
    /// A compute pass of a material.
    Before,
    /// An object is drawn into the HDR frame.
    Scene,
    /// A compute pass of the display recipe.
    After,
    /// The display image is made from the HDR frame.
    Display,
}

/// What makes a program into a pipeline.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PipelineState {
    /// It draws.
    Render(RenderState),
    /// It computes; the entry point's name.
    Compute(String),
}

/// A program that a frame draws or computes with, in one state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Need {
    /// When it is needed first.
    pub stage: Stage,
    /// Whether the camera, or the light, sees something of it from where they are. The others are needed when something moves.
    pub in_view: bool,
    /// The recipe. Serialised as RON, which is how recipes are given.
    #[serde(serialize_with = "written")]
    pub recipe: Node,
    /// The pass of it: what [`Catalog::compile`] takes.
    pub pass: String,
    /// Canonical hash of the linked program. Needs of equal hash, state and constants share one pipeline.
    #[serde(serialize_with = "hexadecimal")]
    pub hash: u128,
    /// `category/name` of each module in the tree, defaults included, in the order of the tree, each once.
    pub modules: Vec<String>,
    /// Fixed-function state, or the entry point that computes.
    pub state: PipelineState,
    /// Pipeline-overridable constants that the frame sets.
    pub constants: Constants,
}

// Serde hands a reference.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn hexadecimal<S: serde::Serializer>(hash: &u128, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&format!("{hash:032x}"))
}

fn written<S: serde::Serializer>(recipe: &Node, to: S) -> Result<S::Ok, S::Error> {
    let text = ron::to_string(recipe).map_err(serde::ser::Error::custom)?;
    to.serialize_str(&text)
}

/// Everything that a frame will be drawn with, compiled without a GPU: what is in view first, in the order of the frame, then what objects
/// outside of the view would need. The HDR frame is taken to be `Rgba32Float`; see [`Renderer::needs`](super::Renderer::needs) for a
/// certain GPU.
///
/// # Errors
/// A recipe is wrong, or the frame's parts do not fit together.
pub fn needs(catalog: &Arc<Catalog>, frame: &Frame) -> Result<Vec<Need>, RuntimeError> {
    let programs = Programs::new(Arc::clone(catalog));
    let whole = Cut {
        whole: true,
        ..Cut::default()
    };
    let plan = Plan::of(&programs, frame, FULL, &whole)?;
    Ok(requests(&plan, frame)?.iter().map(Request::need).collect())
}

/// A need, with the look that has it.
#[derive(Clone)]
pub(crate) struct Request<'l> {
    pub stage: Stage,
    pub in_view: bool,
    /// The looks of all that have it, by their materials; [`Request::look`] is that of the first.
    pub materials: Vec<usize>,
    pub look: &'l Look<'l>,
    pub state: PipelineState,
    pub constants: Constants,
}

/// What tells pipelines apart.
pub(crate) type PipelineKey = (u128, PipelineState, Vec<(String, u64)>);

impl Request<'_> {
    pub fn need(&self) -> Need {
        let program = &self.look.program;
        let mut modules = Vec::new();
        for line in program.tree() {
            let module = format!("{}/{}", line.category, line.module);
            if !modules.contains(&module) {
                modules.push(module);
            }
        }
        Need {
            stage: self.stage,
            in_view: self.in_view,
            recipe: self.look.root.clone(),
            pass: program.reflection().pass.clone(),
            hash: program.hash(),
            modules,
            state: self.state.clone(),
            constants: self.constants.clone(),
        }
    }

    pub fn key(&self) -> PipelineKey {
        (self.look.program.hash(), self.state.clone(), bits(&self.constants))
    }

    /// Makes the pipeline, if it is not there.
    pub fn make(&self, pipelines: &Pipelines) -> Result<(), GpuError> {
        make(pipelines, &self.look.program, &self.state, &self.constants)
    }

    /// Whether the pipeline is there.
    pub fn is_made(&self, pipelines: &Pipelines) -> bool {
        let program = &*self.look.program;
        match &self.state {
            PipelineState::Compute(entry) => pipelines.has_compute(program, entry, &self.constants),
            PipelineState::Render(state) => pipelines.has_render(&RenderRequest {
                program,
                state: *state,
                constants: self.constants.clone(),
            }),
        }
    }
}

/// Makes a pipeline, if it is not there.
pub(crate) fn make(pipelines: &Pipelines, program: &Program, state: &PipelineState, constants: &Constants) -> Result<(), GpuError> {
    match state {
        PipelineState::Compute(entry) => pipelines.compute(program, entry, constants).map(drop),
        PipelineState::Render(state) => {
            let request = RenderRequest {
                program,
                state: *state,
                constants: constants.clone(),
            };
            pipelines.render(&request).map(drop)
        }
    }
}

/// The pipelines that a plan draws with, each program and state once: those in view first, in the order of the frame.
pub(crate) fn requests<'l>(plan: &'l Plan<'l>, frame: &Frame) -> Result<Vec<Request<'l>>, DataError> {
    let bounds = world_bounds(&frame.draws);
    let seen = |eye: &Eye, list: &List, run: &std::ops::Range<u32>| {
        let members = &list.order[run.start as usize..run.end as usize];
        members.iter().any(|draw| eye.sees(&bounds[*draw]))
    };
    let mut found = Found::default();
    for (index, (map, lists)) in plan.maps.iter().zip(&plan.map_lists).enumerate() {
        for (eye, list) in map.eyes.iter().zip(lists) {
            for run in &list.runs {
                if let Some(look) = plan.casters.get(&(index, frame.draws[run.draw].material)) {
                    let state = PipelineState::Render(CASTER);
                    found.add(Stage::ShadowMap, seen(eye, list, &run.objects), look, state)?;
                }
            }
        }
    }
    found.computes(Stage::Before, &plan.before)?;
    for run in &plan.list.runs {
        let draw = &frame.draws[run.draw];
        if let Some(look) = &plan.forward[draw.material] {
            let state = PipelineState::Render(scene_state(draw, plan.hdr));
            found.add(Stage::Scene, seen(&plan.eye, &plan.list, &run.objects), look, state)?;
        }
    }
    if let Some(look) = &plan.display {
        found.computes(Stage::After, &plan.after)?;
        found.add(Stage::Display, true, look, PipelineState::Render(SCREEN))?;
    }
    // Stable: within each half the order of the frame stays.
    found.list.sort_by_key(|request| !request.in_view);
    Ok(found.list)
}

/// One request for each distinct pipeline.
pub(crate) fn distinct<'r, 'l>(requests: &'r [Request<'l>]) -> Vec<&'r Request<'l>> {
    let mut keys = HashSet::new();
    requests.iter().filter(|request| keys.insert(request.key())).collect()
}

/// A stage and a program by its address (equal recipes share theirs), with what makes it a pipeline.
type Known = (Stage, usize, PipelineState, Vec<(String, u64)>);

#[derive(Default)]
struct Found<'l> {
    list: Vec<Request<'l>>,
    places: HashMap<Known, usize>,
}

impl<'l> Found<'l> {
    fn add(&mut self, stage: Stage, in_view: bool, look: &'l Look<'l>, state: PipelineState) -> Result<(), DataError> {
        let constants = overridden(look)?;
        let known = (stage, Arc::as_ptr(&look.program).addr(), state.clone(), bits(&constants));
        let place = *self.places.entry(known).or_insert(self.list.len());
        match self.list.get_mut(place) {
            Some(request) => {
                request.in_view |= in_view;
                if !request.materials.contains(&look.id) {
                    request.materials.push(look.id);
                }
            }
            None => self.list.push(Request {
                stage,
                in_view,
                materials: vec![look.id],
                look,
                state,
                constants,
            }),
        }
        Ok(())
    }

    fn computes(&mut self, stage: Stage, computes: &'l [Compute<'l>]) -> Result<(), DataError> {
        for Compute { entry, look, .. } in computes {
            self.add(stage, true, look, PipelineState::Compute(entry.clone()))?;
        }
        Ok(())
    }
}
