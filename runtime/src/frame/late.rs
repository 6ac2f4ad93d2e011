//! Frames that never wait for a compiler: what is not ready is made in the background, and drawn with something more general until then.

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use shadewright_compiler::manifest::Node;

use super::draw::{CASTER, overridden};
use super::jobs::{Job, Jobs, Task};
use super::list::Cut;
use super::needs::{PipelineState, Request, Stage, make, requests};
use super::plan::{Plan, compute_passes, used_materials};
use super::programs::{Programs, text_of};
use super::render::Renderer;
use super::thaw::thawed;
use super::{Frame, Material, Targets};
use crate::gpu::RuntimeError;
use crate::gpu::pipeline::{Pipelines, bits};

/// Something more general to draw with.
#[allow(clippy::large_enum_variant, reason = "a handful of them exist, in a list")]
#[derive(Clone, Debug)]
pub enum Fallback {
    /// The same recipe with those of its frozen parameters as uniforms that can be. There is none where nothing is frozen.
    Thawed,
    /// Another recipe, with settings of its own.
    Material(Material),
}

/// What may be drawn instead of what is not ready, best first. By itself: the same recipes, thawed.
#[derive(Clone, Debug)]
pub struct Fallbacks {
    /// For the frame's material of this index.
    pub materials: HashMap<usize, Vec<Fallback>>,
    /// For all materials that are not named.
    pub otherwise: Vec<Fallback>,
    /// For the display pass.
    pub display: Vec<Fallback>,
}

impl Default for Fallbacks {
    fn default() -> Self {
        Self {
            materials: HashMap::new(),
            otherwise: vec![Fallback::Thawed],
            display: vec![Fallback::Thawed],
        }
    }
}

/// A part of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Part {
    /// What has the frame's material of this index.
    Material(usize),
    /// The shadows of what has it.
    Shadows(usize),
    /// The display image.
    Display,
}

/// A part of a frame that is not drawn as the frame says.
#[derive(Clone, Debug)]
pub struct Late {
    /// Which.
    pub part: Part,
    /// Place of the fallback it is drawn with among those given for it. `None`: it waits, and is not drawn.
    pub shown: Option<usize>,
    /// Whether something that a later frame will show instead is under way.
    pub compiling: bool,
    /// Why it will never be drawn as the frame says.
    pub error: Option<Arc<RuntimeError>>,
}

impl Renderer {
    /// Draws a frame with what there is, and says what is drawn otherwise than the frame says. Programs and pipelines that are missing are made
    /// in the background, in the order in which the frame needs them; a later frame shows them. What the latest frame does not need any
    /// more, and nobody has begun, is not made.
    ///
    /// A part is drawn with the first of its fallbacks that is there: see [`Renderer::fallback_frame`]. A fallback is made in the background only
    /// where all before it have failed.
    ///
    /// # Errors
    /// As for [`Renderer::render`], but what fails to compile is in [`Late::error`].
    pub fn render_now(&mut self, frame: &Frame, fallbacks: &Fallbacks) -> Result<(Targets, Vec<Late>), RuntimeError> {
        self.at_once(frame, fallbacks, Self::show)
    }

    /// Waits until everything that the frame needs is there or has failed. [`Renderer::render_now`] then shows all that can be shown; what is
    /// left is returned.
    ///
    /// # Errors
    /// As for [`Renderer::render_now`].
    pub fn settle(&mut self, frame: &Frame, fallbacks: &Fallbacks) -> Result<Vec<Late>, RuntimeError> {
        loop {
            let ((), late) = self.at_once(frame, fallbacks, |_, _, _| Ok(()))?;
            if !late.iter().any(|late| late.compiling) {
                return Ok(late);
            }
            self.jobs.wait();
        }
    }

    /// Begins nothing more of what is to be made in the background, and forgets what has failed: the next frame that needs it asks again.
    pub fn cancel(&self) {
        self.jobs.cancel();
    }

    /// The frame as its fallbacks draw it: [`Renderer::prepare`] it to have them there. What has no fallback is as it was.
    pub fn fallback_frame(&self, frame: &Frame, fallbacks: &Fallbacks) -> Frame {
        let mut general = frame.clone();
        for id in 0..=frame.materials.len() {
            if let Some((material, _)) = given(&self.programs, frame, fallbacks, id).into_iter().next() {
                replace(&mut general, id, material);
            }
        }
        general
    }

    fn at_once<R>(
        &mut self,
        frame: &Frame,
        fallbacks: &Fallbacks,
        then: impl FnOnce(&mut Self, &Frame, &Plan) -> Result<R, RuntimeError>,
    ) -> Result<(R, Vec<Late>), RuntimeError> {
        let hdr = self.hdr(frame)?;
        let mut choice = Choice {
            programs: &self.programs,
            pipelines: &self.pipelines,
            jobs: &self.jobs,
            frame,
            fallbacks,
            parts: vec![Chosen::default(); frame.materials.len() + 1],
            shadows: HashMap::new(),
            wanted: Vec::new(),
            known: HashSet::new(),
        };
        for id in used_materials(frame)? {
            choice.settle(id);
        }
        if frame.display.is_some() {
            choice.settle(frame.materials.len());
        }
        loop {
            let shown = choice.shown();
            let absent: Vec<bool> = choice.parts.iter().map(|part| !part.ready).collect();
            let cut = Cut {
                whole: false,
                absent: &absent,
                at_once: true,
            };
            let mut plan = Plan::of(choice.programs, &shown, hdr, &cut)?;
            if choice.look_again(&mut plan, &shown)? {
                continue;
            }
            let late = choice.late();
            let Choice { wanted, .. } = choice;
            self.jobs.want(wanted)?;
            return Ok((then(self, &shown, &plan)?, late));
        }
    }
}

/// The frame's own material, or the display pass after the last.
fn own(frame: &Frame, id: usize) -> Option<&Material> {
    if id == frame.materials.len() {
        frame.display.as_ref()
    } else {
        frame.materials.get(id)
    }
}

/// A part's fallbacks with their places among those that are given for it.
fn given(programs: &Programs, frame: &Frame, fallbacks: &Fallbacks, id: usize) -> Vec<(Material, usize)> {
    let Some(own) = own(frame, id) else { return Vec::new() };
    let given = match fallbacks.materials.get(&id) {
        _ if id == frame.materials.len() => &fallbacks.display,
        Some(given) => given,
        None => &fallbacks.otherwise,
    };
    let material = |(place, fallback): (usize, &Fallback)| match fallback {
        Fallback::Thawed => thawed(programs, &frame.lights, own).map(|material| (material, place)),
        Fallback::Material(material) => Some((material.clone(), place)),
    };
    given.iter().enumerate().filter_map(material).collect()
}

fn replace(frame: &mut Frame, id: usize, material: Material) {
    match frame.materials.get_mut(id) {
        Some(own) => *own = material,
        None => frame.display = Some(material),
    }
}

/// How something stands that a part needs.
enum Standing {
    There,
    /// Neither there nor failed, and how to make it.
    Missing(Vec<(Task, Job)>),
    Failed(Arc<RuntimeError>),
}

impl Standing {
    /// The same, where somebody else sees to the jobs.
    fn without_jobs(&self) -> Self {
        match self {
            Self::There => Self::There,
            Self::Missing(_) => Self::Missing(Vec::new()),
            Self::Failed(error) => Self::Failed(Arc::clone(error)),
        }
    }
}

/// What a part is drawn with.
#[derive(Clone, Default)]
struct Chosen {
    ready: bool,
    /// Instead of the frame's own: the material, and its place among the fallbacks.
    fallback: Option<(Material, usize)>,
    /// Found where the frame's own is not ready.
    candidates: Option<Vec<(Material, usize)>>,
    /// 0 for the frame's own, then fallbacks.
    at: usize,
    /// Something better is being made.
    compiling: bool,
    error: Option<Arc<RuntimeError>>,
}

/// Finds out with what each part of a frame can be drawn.
struct Choice<'s, 'f> {
    programs: &'s Arc<Programs>,
    pipelines: &'s Arc<Pipelines>,
    jobs: &'s Jobs,
    frame: &'f Frame,
    fallbacks: &'f Fallbacks,
    /// By material, then the display pass.
    parts: Vec<Chosen>,
    /// By material; those that are not drawn into some map.
    shadows: HashMap<usize, (bool, Option<Arc<RuntimeError>>)>,
    wanted: Vec<(Task, Job)>,
    known: HashSet<Task>,
}

impl<'f> Choice<'_, 'f> {
    /// Takes the first candidate from the present one on whose programs are all there.
    fn settle(&mut self, id: usize) {
        loop {
            let Some(own) = own(self.frame, id) else { return };
            let part = &mut self.parts[id];
            part.ready = false;
            part.fallback = match part.at.checked_sub(1) {
                None => None,
                Some(number) => {
                    let candidates = part
                        .candidates
                        .get_or_insert_with(|| given(self.programs, self.frame, self.fallbacks, id));
                    match candidates.get(number) {
                        Some(candidate) => Some(candidate.clone()),
                        None => return,
                    }
                }
            };
            let recipe = Arc::clone(&part.fallback.as_ref().map_or(own, |(material, _)| material).recipe);
            let standing = self.programs_of(&recipe);
            if matches!(standing, Standing::There) {
                self.parts[id].ready = true;
                return;
            }
            self.pass_over(id, standing);
        }
    }

    /// Goes on to the next candidate. What is missing is made, unless something better is.
    fn pass_over(&mut self, id: usize, standing: Standing) {
        let part = &mut self.parts[id];
        part.at += 1;
        match standing {
            Standing::There => {}
            Standing::Failed(error) => drop(part.error.get_or_insert(error)),
            Standing::Missing(jobs) => {
                if !part.compiling {
                    part.compiling = true;
                    self.want(jobs);
                }
            }
        }
    }

    fn want(&mut self, jobs: Vec<(Task, Job)>) {
        for (task, job) in jobs {
            if self.known.insert(task.clone()) {
                self.wanted.push((task, job));
            }
        }
    }

    /// The programs of a recipe's own pass and of its compute passes.
    fn programs_of(&self, recipe: &Arc<Node>) -> Standing {
        let main = self.program(recipe, "main");
        let Some(program) = self.programs.find(recipe, "main").filter(|_| matches!(main, Standing::There)) else {
            return main;
        };
        let mut missing = Vec::new();
        for pass in compute_passes(&program) {
            match self.program(recipe, &pass) {
                Standing::There => {}
                Standing::Missing(jobs) => missing.extend(jobs),
                failed @ Standing::Failed(_) => return failed,
            }
        }
        if missing.is_empty() {
            Standing::There
        } else {
            Standing::Missing(missing)
        }
    }

    fn program(&self, recipe: &Arc<Node>, pass: &str) -> Standing {
        if self.programs.find(recipe, pass).is_some() {
            return Standing::There;
        }
        let task = Task::Program(text_of(recipe), pass.to_owned());
        if let Some(error) = self.jobs.failure(&task) {
            return Standing::Failed(error);
        }
        let (programs, recipe, pass) = (Arc::clone(self.programs), Arc::clone(recipe), pass.to_owned());
        Standing::Missing(vec![(task, Box::new(move || Ok(programs.get(&recipe, &pass).map(drop)?)))])
    }

    fn pipeline(&self, request: &Request) -> Standing {
        if request.is_made(self.pipelines) {
            return Standing::There;
        }
        let task = Task::Pipeline(request.key());
        if let Some(error) = self.jobs.failure(&task) {
            return Standing::Failed(error);
        }
        let (pipelines, program) = (Arc::clone(self.pipelines), Arc::clone(&request.look.program));
        let (state, constants) = (request.state.clone(), request.constants.clone());
        Standing::Missing(vec![(task, Box::new(move || Ok(make(&pipelines, &program, &state, &constants)?)))])
    }

    /// The frame with what was chosen.
    fn shown(&self) -> Cow<'f, Frame> {
        let mut frame = Cow::Borrowed(self.frame);
        for (id, part) in self.parts.iter().enumerate() {
            if let Some((material, _)) = part.fallback.as_ref().filter(|_| part.ready) {
                replace(frame.to_mut(), id, material.clone());
            }
        }
        frame
    }

    /// Looks which pipelines are missing. Parts that lack one get the next candidate (`true`: plan again); casters that lack theirs are left out.
    fn look_again(&mut self, plan: &mut Plan, frame: &Frame) -> Result<bool, RuntimeError> {
        let mut lacking = Vec::new();
        let mut dropped = HashSet::new();
        self.shadows.clear();
        for request in requests(plan, frame)? {
            let standing = self.pipeline(&request);
            match (request.stage, standing) {
                (_, Standing::There) => {}
                (Stage::ShadowMap, standing) => {
                    dropped.insert(request.key());
                    request.materials.iter().for_each(|id| self.shadowless(*id, &standing));
                    self.want_if(standing);
                }
                (_, standing) => lacking.push((request.materials.clone(), standing)),
            }
        }
        for (id, root) in std::mem::take(&mut plan.waiting_casters) {
            let standing = self.program(&Arc::new(root), "main");
            self.shadowless(id, &standing);
            self.want_if(standing);
        }
        plan.casters.retain(|_, look| {
            let key = |constants| (look.program.hash(), PipelineState::Render(CASTER), bits(&constants));
            overridden(look).is_ok_and(|constants| !dropped.contains(&key(constants)))
        });
        let hopeful: Vec<bool> = self.parts.iter().map(|part| !part.compiling).collect();
        let mut moved = Vec::new();
        for (materials, standing) in lacking {
            for id in &materials {
                if !moved.contains(id) {
                    moved.push(*id);
                    self.pass_over(*id, standing.without_jobs());
                }
            }
            if materials.iter().any(|id| hopeful[*id]) {
                self.want_if(standing);
            }
        }
        for id in &moved {
            self.settle(*id);
        }
        Ok(!moved.is_empty())
    }

    fn want_if(&mut self, standing: Standing) {
        if let Standing::Missing(jobs) = standing {
            self.want(jobs);
        }
    }

    fn shadowless(&mut self, id: usize, standing: &Standing) {
        let (compiling, error) = self.shadows.entry(id).or_default();
        match standing {
            Standing::There => {}
            Standing::Missing(_) => *compiling = true,
            Standing::Failed(why) => drop(error.get_or_insert_with(|| Arc::clone(why))),
        }
    }

    /// What is drawn otherwise than the frame says, in the order of the parts.
    fn late(&self) -> Vec<Late> {
        let mut late = Vec::new();
        for (id, part) in self.parts.iter().enumerate() {
            if part.at > 0 {
                late.push(Late {
                    part: if id == self.frame.materials.len() {
                        Part::Display
                    } else {
                        Part::Material(id)
                    },
                    shown: part.fallback.as_ref().filter(|_| part.ready).map(|(_, place)| *place),
                    compiling: part.compiling,
                    error: part.error.clone(),
                });
            }
        }
        late.extend(self.shadows.iter().map(|(id, (compiling, error))| Late {
            part: Part::Shadows(*id),
            shown: None,
            compiling: *compiling,
            error: error.clone(),
        }));
        late.sort_by_key(|late| late.part);
        late
    }
}
