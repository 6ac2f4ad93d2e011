//! What a frame needs: its programs, views, shadow maps and passes, all found before anything is drawn.

use indexmap::IndexMap;
use shadewright_compiler::manifest::{Dispatch, Node, PassDecl};
use shadewright_compiler::program::Program;
use shadewright_compiler::reflect::Pass;

use super::Frame;
use super::fill::Look;
use super::list::{Cut, List, world_bounds};
use super::maps::{Map, maps_of, scene_bounds};
use super::programs::{Programs, text_of};
use super::view::Eye;
use crate::gpu::{DataError, RuntimeError};

/// A frame's programs and views.
pub(crate) struct Plan<'a> {
    /// By material; `None` for materials that nothing shown or casting has.
    pub forward: Vec<Option<Look<'a>>>,
    pub maps: Vec<Map>,
    /// By map and material.
    pub casters: IndexMap<(usize, usize), Look<'a>>,
    /// Those of which the program is not compiled, by material, where only compiled ones were asked for.
    pub waiting_casters: Vec<(usize, Node)>,
    pub display: Option<Look<'a>>,
    /// Compute passes before the scene is drawn, and before the display pass: entry point, over what, and the program.
    pub before: Vec<Compute<'a>>,
    pub after: Vec<Compute<'a>>,
    pub eye: Eye,
    pub list: List,
    /// By map, then layer.
    pub map_lists: Vec<Vec<List>>,
    pub hdr: wgpu::TextureFormat,
}

/// A compute pass.
pub(crate) struct Compute<'a> {
    pub entry: String,
    pub over: Dispatch,
    pub look: Look<'a>,
}

impl<'a> Plan<'a> {
    /// Compiles what the frame needs, on all cores, and finds out from where it is seen. `hdr` is the format of the HDR frame.
    pub fn of(programs: &Programs, frame: &'a Frame, hdr: wgpu::TextureFormat, cut: &Cut) -> Result<Self, RuntimeError> {
        let mut used = used_materials(frame)?;
        used.retain(|id| !cut.lacks(*id));
        let display = frame.display.as_ref().filter(|_| !cut.lacks(frame.materials.len()));
        let shown = used.iter().map(|id| &frame.materials[*id]).chain(display);
        programs.get_many(shown.map(|m| ((*m.recipe).clone(), "main".to_owned())))?;
        let bounds = world_bounds(&frame.draws);
        let scene = scene_bounds(frame, &bounds);
        let eye = Eye::of_camera(&frame.camera, frame.size, frame.time);
        let mut plan = Self {
            forward: vec![None; frame.materials.len()],
            maps: Vec::new(),
            casters: IndexMap::new(),
            waiting_casters: Vec::new(),
            display: None,
            before: Vec::new(),
            after: Vec::new(),
            list: List::of_camera(&frame.draws, &bounds, &eye, cut),
            eye,
            map_lists: Vec::new(),
            hdr,
        };
        for id in used {
            let material = &frame.materials[id];
            let program = programs.get(&material.recipe, "main")?;
            let parts = (&*material.recipe, &material.settings, &*program);
            let maps = maps_of(programs, frame, parts, scene, &mut plan.maps)?;
            let look = Look {
                id,
                root: (*material.recipe).clone(),
                settings: &material.settings,
                program,
                maps,
            };
            plan.before.extend(computes(programs, &look)?);
            plan.forward[id] = Some(look);
        }
        if let Some(material) = display {
            let look = Look {
                id: frame.materials.len(),
                root: (*material.recipe).clone(),
                settings: &material.settings,
                program: programs.get(&material.recipe, "main")?,
                maps: Vec::new(),
            };
            plan.after = computes(programs, &look)?;
            plan.display = Some(look);
        }
        for map in &plan.maps {
            let of = |eye| List::of_casters(&frame.draws, &bounds, eye, cut);
            plan.map_lists.push(map.eyes.iter().map(of).collect());
        }
        plan.find_casters(programs, frame, cut)?;
        Ok(plan)
    }

    /// Whether this material, or the display pass after the last, is drawn with the recipe of this text.
    pub fn has(&self, id: usize, recipe: &str) -> bool {
        let look = self.forward.get(id).unwrap_or(&self.display);
        look.as_ref().is_some_and(|look| text_of(&look.root) == recipe)
    }

    /// The programs that draw materials into maps.
    fn find_casters(&mut self, programs: &Programs, frame: &Frame, cut: &Cut) -> Result<(), RuntimeError> {
        let mut wanted = IndexMap::new();
        for (index, (map, lists)) in self.maps.iter().zip(&self.map_lists).enumerate() {
            for run in lists.iter().flat_map(|list| &list.runs) {
                let id = frame.draws[run.draw].material;
                if let Some(main) = &self.forward[id] {
                    wanted
                        .entry((index, id))
                        .or_insert_with(|| (map.caster(programs, &main.root), main));
                }
            }
        }
        if !cut.at_once {
            programs.get_many(wanted.values().map(|(root, _)| (root.clone(), "main".to_owned())))?;
        }
        let (mut casters, mut waiting) = (IndexMap::new(), Vec::new());
        for (key, (root, main)) in wanted {
            if cut.at_once && programs.find(&root, "main").is_none() {
                waiting.push((main.id, root));
                continue;
            }
            let look = Look {
                program: programs.get(&root, "main")?,
                root,
                maps: Vec::new(),
                ..main.clone()
            };
            casters.insert(key, look);
        }
        (self.casters, self.waiting_casters) = (casters, waiting);
        Ok(())
    }
}

/// Materials of draws that are shown or cast, checked.
pub(crate) fn used_materials(frame: &Frame) -> Result<Vec<usize>, DataError> {
    let mut used = vec![false; frame.materials.len()];
    for (i, draw) in frame.draws.iter().enumerate() {
        let Some(seen) = used.get_mut(draw.material) else {
            let message = format!("material {} of {}", draw.material, frame.materials.len());
            return Err(DataError::new(format!("draws[{i}].material"), message));
        };
        if !draw.model.is_finite() {
            return Err(DataError::new(format!("draws[{i}].model"), "is not finite"));
        }
        if !(draw.bounds.min.is_finite() && draw.bounds.max.is_finite()) {
            return Err(DataError::new(format!("draws[{i}].bounds"), "is not finite"));
        }
        *seen |= draw.visible || draw.casts_shadow;
    }
    if !frame.camera.view_projection().is_finite() {
        return Err(DataError::new("camera", "is not finite"));
    }
    Ok((0..used.len()).filter(|i| used[*i]).collect())
}

/// What the compiler calls a pass.
fn name_of(pass: &Pass) -> String {
    format!("{}.{}", pass.instance, pass.name)
}

/// Names of the compute passes that a program's modules declare, in their order.
pub(crate) fn compute_passes(program: &Program) -> Vec<String> {
    let passes = program.reflection().passes.iter();
    passes
        .filter(|pass| matches!(pass.declared, PassDecl::Compute { .. }))
        .map(name_of)
        .collect()
}

/// The compute passes that a program's modules declare, in their order.
fn computes<'a>(programs: &Programs, look: &Look<'a>) -> Result<Vec<Compute<'a>>, RuntimeError> {
    let mut computes = Vec::new();
    for pass in &look.program.reflection().passes {
        if let PassDecl::Compute { entry, over } = &pass.declared {
            let program = programs.get(&look.root, &name_of(pass))?;
            let entry = program.reflection().entry_points.first().map_or(entry, |e| &e.name).clone();
            computes.push(Compute {
                entry,
                over: *over,
                look: Look { program, ..look.clone() },
            });
        }
    }
    Ok(computes)
}
