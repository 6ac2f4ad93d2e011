//! Every way in which a module's slots can be filled: that it links, validates, and does what its parts let it.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::Ordering;

use rayon::prelude::*;
use serde::Serialize;
use serde_json::json;
use shadewright_compiler::manifest::{Filling, Node};
use shadewright_compiler::space::{Space, SpaceFile};
use shadewright_compiler::{Catalog, Report};
use shadewright_runtime::probe::Probe;

use super::bench::{Bench, Rows, surface, vector};
use super::{Draws, EQUAL, Effort, Property, Roles, draws, level, pairs};
use crate::measure::{MeasureError, Random};

/// Pairs of directions for each combination.
const PAIRS: usize = 64;
/// Directions that are drawn for each combination.
const DRAWN: usize = 32;
/// Combinations between two looks at whether to stop.
const CHUNK: usize = 64;
/// Samples of the chi-square test of each sampler.
const SAMPLES: usize = 30_000;

/// What came of all combinations of a module.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Combinations {
    /// The module, `category/name`.
    pub module: String,
    /// How many fillings there are; each was linked, validated and evaluated.
    pub count: usize,
    /// How many alternatives each slot has.
    pub slots: Vec<(String, usize)>,
    /// Programs among them that differ, of the reflectance.
    pub programs: usize,
    /// Programs that differ in what they draw, each held against its density.
    pub samplers: usize,
    /// Combinations of which every pair of alternatives is one, evaluated on the device too.
    pub on_device: usize,
    /// Combinations whose root and parts, where they can, all claim to be reciprocal.
    pub reciprocal: usize,
    /// Largest relative difference of what must be reciprocal, and of which.
    pub worst: (f64, String),
    /// Smallest probability of a sampler, and of which.
    pub least: (f64, String),
    /// What is wrong.
    pub faults: Vec<String>,
}

/// The space of a module's fillings, whose own slots have their defaults; a new module that fits is in it by being there.
///
/// # Errors
/// The module is not there, or has too many fillings.
pub fn space(catalog: &Catalog, module: &str) -> Result<Space, Report> {
    let manifest = &catalog.module(module)?.manifest;
    let fill: Vec<String> = manifest.slots.keys().map(|slot| format!("{slot:?}: (fits: Defaults)")).collect();
    let text = format!("(module: {module:?}, fill: {{{}}})", fill.join(", "));
    Space::open(catalog, &SpaceFile::parse("combinations", &text)?)
}

/// What one combination did.
#[derive(Default)]
struct Tried {
    faults: Vec<String>,
    program: u128,
    sampler: (u128, u128),
    /// Largest difference, of what must be reciprocal.
    difference: Option<f64>,
}

/// A module's functions, and inputs for all of its combinations.
struct Trial<'a> {
    catalog: &'a Catalog,
    reflectance: &'a str,
    draws: &'a Draws,
    /// Categories in which somebody claims to be reciprocal: of the others it means nothing.
    directed: BTreeSet<&'a str>,
    rows: [Rows; 2],
    numbers: Vec<[f32; 2]>,
}

/// Links, validates and evaluates every combination of a module's slots, holds every sampler that differs against its density, and evaluates a
/// cover of all pairs of alternatives on the device.
///
/// # Errors
/// The space is too large, the device fails, or somebody asked to stop. A combination that does not link is a fault.
pub fn combinations(bench: &Bench, role: &Roles, name: &str, effort: &Effort) -> Result<Combinations, MeasureError> {
    let module = format!("{}/{name}", role.category);
    let (Some(reflectance), Some(draws)) = (&role.declared.reflectance, &role.declared.draws) else {
        return Ok(Combinations::default());
    };
    let space = space(bench.catalog, &module)?;
    let nodes: Vec<Node> = space.iter()?.map(|permutation| permutation.recipe.root).collect();
    let mut random = Random::new(7, 13);
    let trial = Trial {
        catalog: bench.catalog,
        reflectance,
        draws,
        directed: bench
            .catalog
            .modules()
            .filter(|m| m.manifest.properties.iter().any(|p| p == Property::Reciprocal.claim()))
            .map(|m| m.category.as_str())
            .collect(),
        rows: pairs::some(PAIRS),
        numbers: (0..DRAWN).map(|_| [random.single(), random.single()]).collect(),
    };
    let mut found = Combinations {
        module,
        count: nodes.len(),
        slots: alternatives(&nodes),
        ..Combinations::default()
    };
    let (mut programs, mut samplers) = (BTreeSet::new(), BTreeMap::new());
    for (index, chunk) in nodes.chunks(CHUNK).enumerate() {
        (effort.progress)(index * CHUNK, nodes.len(), &found.module);
        if effort.cancel.load(Ordering::Relaxed) {
            return Err(MeasureError::Interrupted);
        }
        let tried: Vec<Tried> = chunk.par_iter().map(|node| trial.run(node)).collect();
        for (node, tried) in chunk.iter().zip(tried) {
            found
                .faults
                .extend(tried.faults.into_iter().map(|fault| format!("{}: {fault}", label(node))));
            programs.insert(tried.program);
            samplers.entry(tried.sampler).or_insert(node);
            if let Some(difference) = tried.difference {
                found.reciprocal += 1;
                if difference > found.worst.0 {
                    found.worst = (difference, label(node));
                }
            }
        }
    }
    found.programs = programs.len();
    found.samplers = samplers.len();
    found.least.0 = 1.0;
    let level = level(samplers.len() * draws::TESTS);
    for node in samplers.values() {
        let (p, at) = draws::of_recipe(bench, node, draws, true, SAMPLES)?;
        if p < found.least.0 {
            found.least = (p, format!("{}, {at}", label(node)));
        }
        if p < level {
            found.faults.push(format!("{}: draws with p {p:.1e}, {at}", label(node)));
        }
    }
    for permutation in space.pairwise()? {
        let node = permutation.recipe.root;
        found.on_device += 1;
        let values = bench.values(&node, reflectance, &trial.rows[0])?;
        if let Some(value) = values.iter().flatten().find(|x| !(x.is_finite() && **x >= 0.0)) {
            found.faults.push(format!("{}: {value} on the device", label(&node)));
        }
    }
    Ok(found)
}

/// The modules in a combination's slots.
fn label(node: &Node) -> String {
    let filled = node.fill.values().flat_map(|filling| match filling {
        Filling::One(node) => vec![node],
        Filling::Many(nodes) => nodes.iter().collect(),
    });
    filled.map(|node| node.module.as_str()).collect::<Vec<_>>().join(" + ")
}

fn alternatives(nodes: &[Node]) -> Vec<(String, usize)> {
    let mut slots: Vec<(String, BTreeSet<String>)> = Vec::new();
    for (slot, filling) in nodes.iter().flat_map(|node| &node.fill) {
        let text = json!(filling).to_string();
        match slots.iter_mut().find(|(name, _)| name == slot) {
            Some((_, texts)) => {
                texts.insert(text);
            }
            None => slots.push((slot.clone(), BTreeSet::from([text]))),
        }
    }
    slots.into_iter().map(|(slot, texts)| (slot, texts.len())).collect()
}

impl Trial<'_> {
    fn run(&self, node: &Node) -> Tried {
        let mut tried = Tried::default();
        if let Err(error) = self.attempt(node, &mut tried) {
            tried.faults.push(error.to_string());
        }
        tried
    }

    fn attempt(&self, node: &Node, tried: &mut Tried) -> Result<(), MeasureError> {
        let link = |function: &str| Probe::new(self.catalog, &node.clone().into(), function);
        let (reflect, sample, density) = (link(self.reflectance)?, link(&self.draws.sample)?, link(&self.draws.density)?);
        tried.program = reflect.program().hash();
        tried.sampler = (sample.program().hash(), density.program().hash());
        let values = self.rows[0].evaluate(&reflect)?;
        let swapped = self.rows[1].evaluate(&reflect)?;
        if let Some(value) = values.iter().chain(&swapped).flatten().find(|x| !(x.is_finite() && **x >= 0.0)) {
            tried.faults.push(format!("is {value}"));
        }
        if self.must_be_reciprocal(&node.module, node)? {
            let relative = |(a, b): (&f64, &f64)| (a - b).abs() / a.abs().max(b.abs()).max(1e-9);
            let difference = values
                .iter()
                .flatten()
                .zip(swapped.iter().flatten())
                .map(relative)
                .fold(0.0, f64::max);
            if difference > EQUAL {
                tried.faults.push(format!("is not reciprocal: {difference:.1e}"));
            }
            tried.difference = Some(difference);
        }
        // What is drawn is a direction, has a density, and a weight that is a number.
        let eye = json!([0.6, 0.0, 0.8]);
        let shared = || Rows::new(&surface(0.3, [0.3; 2], [0.3, 0.5, 0.9], [0.2, 0.3, 0.1])).sharing("v", eye.clone());
        let drawn = shared().pairs("u", &self.numbers).evaluate(&sample)?;
        let directions = || drawn.iter().map(|value| vector(value));
        let densities = shared().vectors(&self.draws.drawn, directions()).evaluate(&density)?;
        let reflected = shared().vectors("l", directions()).evaluate(&reflect)?;
        for ((l, p), f) in directions().zip(densities.iter().flatten()).zip(&reflected) {
            let weight = f.iter().copied().fold(0.0, f64::max) * l.z.max(0.0) / p;
            if l.z > 0.0 && !((l.length() - 1.0).abs() < 1e-4 && *p > 0.0 && p.is_finite() && weight.is_finite()) {
                tried.faults.push(format!("draws {l} with the density {p}, weight {weight}"));
                break;
            }
        }
        Ok(())
    }

    /// Whether the root and all parts that can claim it do; `name` is the node's with its category.
    fn must_be_reciprocal(&self, name: &str, node: &Node) -> Result<bool, Report> {
        let module = self.catalog.module(name)?;
        let claims = module.manifest.properties.iter().any(|p| p == Property::Reciprocal.claim());
        if self.directed.contains(module.category.as_str()) && !claims {
            return Ok(false);
        }
        for (slot, filling) in &node.fill {
            let nodes = match filling {
                Filling::One(node) => std::slice::from_ref(node),
                Filling::Many(nodes) => nodes,
            };
            for node in nodes {
                let interface = module.manifest.slots.get(slot).map_or("", |slot| &slot.interface);
                let bare = node.module.rsplit('/').next().unwrap_or_default();
                if !self.must_be_reciprocal(&format!("{interface}/{bare}"), node)? {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }
}
