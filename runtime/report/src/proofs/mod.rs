//! What manifests claim of modules, and what must hold of all, measured on a device: for each property the worst case, and where it is.
//!
//! ```text
//! *.proofs.ron -> Roles: which function is what                                     (format)
//! Roles, module -> pairs of directions: reciprocal, isotropic, not negative, finite  (pairs)
//!               -> the albedo of white surfaces                                      (albedo)
//!               -> integrals over facets: normalised, projected area, weights        (facets)
//!               -> chi-square test of what is drawn, its weights                     (draws)
//! Roles, space  -> every filling of a module's slots                                 (combinations)
//! all of them   -> a list of Proof -> the table                                     (write::proofs)
//! ```

mod albedo;
mod bench;
mod combinations;
mod draws;
mod facets;
mod format;
mod pairs;

use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;
use shadewright_compiler::Module;

use crate::measure::MeasureError;

pub use albedo::{MOST as MOST_ALBEDO, White};
pub use bench::Bench;
pub use combinations::{Combinations, combinations, space};
pub use draws::{SIGNIFICANCE, TESTS, level};
pub use facets::{NORMALISED, WEIGHT};
pub use format::{Area, Declared, Draws, Roles, load, read};
pub use pairs::{EQUAL, PAIRS};

/// A property of a module.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub enum Property {
    /// Exchanging v and l changes nothing, relative.
    Reciprocal,
    /// Turning v and l about the normal changes nothing, relative.
    Isotropic,
    /// The least value.
    NotNegative,
    /// How many values are not finite.
    Finite,
    /// The largest share of the light.
    Share,
    /// The largest albedo of a white surface.
    Energy,
    /// How far the integral of D n.h is from 1.
    Normalised,
    /// How far the area of the facets that are seen is from that of the surface, relative.
    ProjectedArea,
    /// The smallest probability of the chi-square tests.
    Drawn,
    /// The largest weight of a sample.
    Weight,
}

impl Property {
    /// All, in the order of the table.
    pub const ALL: [Self; 10] = [
        Self::Reciprocal,
        Self::Isotropic,
        Self::NotNegative,
        Self::Finite,
        Self::Share,
        Self::Energy,
        Self::Normalised,
        Self::ProjectedArea,
        Self::Drawn,
        Self::Weight,
    ];

    /// The word by which a manifest claims it; empty where it must hold of everything that can have it.
    pub fn claim(self) -> &'static str {
        match self {
            Self::Reciprocal => "reciprocal",
            Self::Isotropic => "isotropic",
            Self::Energy => "energy_conserving",
            _ => "",
        }
    }
}

/// The worst case of a property of a module.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proof {
    /// `category/name`; of a pair both.
    pub module: String,
    /// What was measured.
    pub property: Property,
    /// Whether it is said to hold, or has to.
    pub claimed: bool,
    /// The worst value.
    pub worst: f64,
    /// Where that is.
    pub at: String,
    /// What the value must not exceed, or of [`Property::NotNegative`] and [`Property::Drawn`] not fall below.
    pub bound: f64,
}

impl Proof {
    fn new(module: &Module, property: Property, worst: f64, at: String, bound: f64) -> Self {
        let claim = property.claim();
        Self {
            module: format!("{}/{}", module.category, module.name),
            property,
            claimed: claim.is_empty() || module.manifest.properties.iter().any(|p| p == claim),
            worst,
            at,
            bound,
        }
    }

    fn of_pair(area: &Area, property: Property, worst: f64, at: String, bound: f64) -> Self {
        Self {
            module: format!("{} with {}", area.distribution, area.masking),
            property,
            claimed: true,
            worst,
            at,
            bound,
        }
    }

    /// Whether the worst case is within the bound.
    pub fn holds(&self) -> bool {
        match self.property {
            Property::NotNegative | Property::Drawn => self.worst >= self.bound,
            _ => self.worst <= self.bound,
        }
    }

    /// Whether it is claimed and does not hold.
    pub fn is_broken(&self) -> bool {
        self.claimed && !self.holds()
    }
}

/// How much is done.
pub struct Effort<'a> {
    /// Samples of a chi-square test; none at 0.
    pub samples: usize,
    /// Whether everything else is measured.
    pub others: bool,
    /// Which modules (`category/name`) are looked at; of pairs either.
    pub modules: &'a dyn Fn(&str) -> bool,
    /// Set to stop after the step that is being done.
    pub cancel: &'a AtomicBool,
    /// Called with what is done next: steps done, all steps, and its name.
    pub progress: &'a dyn Fn(usize, usize, &str),
}

/// Proves what a library's modules claim, in the order of the library.
///
/// # Errors
/// A module cannot be linked, the device fails, or somebody asked to stop.
pub fn prove(bench: &Bench, roles: &[Roles], effort: &Effort) -> Result<Vec<Proof>, MeasureError> {
    let mut found = Vec::new();
    let of = |roles: &Roles| {
        let modules = bench.catalog.modules().filter(|m| m.category == roles.category);
        modules
            .filter(|m| (effort.modules)(&format!("{}/{}", m.category, m.name)))
            .cloned()
            .collect::<Vec<_>>()
    };
    let steps: usize = roles.iter().map(|roles| of(roles).len()).sum();
    let mut done = 0;
    for role in roles {
        for module in of(role) {
            (effort.progress)(done, steps, &format!("{}/{}", module.category, module.name));
            if effort.cancel.load(Ordering::Relaxed) {
                return Err(MeasureError::Interrupted);
            }
            found.extend(prove_module(bench, &role.declared, &module, effort)?);
            done += 1;
        }
        if effort.others {
            for area in &role.declared.areas {
                if (effort.modules)(&area.distribution) || (effort.modules)(&area.masking) {
                    found.extend(prove_pair(bench, roles, role, area)?);
                }
            }
        }
    }
    // Many tests are taken together.
    let tests = found.iter().filter(|p| p.property == Property::Drawn).count() * TESTS;
    for proof in &mut found {
        if proof.property == Property::Drawn {
            proof.bound = level(tests);
        }
    }
    Ok(found)
}

fn prove_module(bench: &Bench, declared: &Declared, module: &Module, effort: &Effort) -> Result<Vec<Proof>, MeasureError> {
    let mut found = Vec::new();
    if effort.others {
        if let Some(function) = &declared.reflectance {
            found.extend(pairs::prove(bench, module, function, false)?);
            found.extend(albedo::prove(bench, module, function)?);
        }
        if let Some(function) = &declared.masking {
            found.extend(pairs::prove(bench, module, function, true)?);
        }
        if let Some(function) = &declared.share {
            found.extend(pairs::prove_share(bench, module, function)?);
        }
        if let Some(function) = &declared.distribution {
            found.extend(facets::prove(bench, module, function)?);
        }
    }
    if let Some(draws) = &declared.draws {
        if effort.samples > 0 {
            found.push(draws::prove(bench, module, draws, declared.reflectance.is_some(), effort.samples)?);
        }
        if let Some(reflectance) = declared.reflectance.as_ref().filter(|_| effort.others) {
            found.push(draws::prove_weight(bench, module, reflectance, draws)?);
        }
    }
    Ok(found)
}

/// The masking is declared in `role`; the distribution's functions are in its own category's.
fn prove_pair(bench: &Bench, roles: &[Roles], role: &Roles, area: &Area) -> Result<Vec<Proof>, MeasureError> {
    let category = bench.catalog.module(&area.distribution)?.category.clone();
    let of_facets = roles.iter().find(|r| r.category == category).map(|r| &r.declared);
    let distribution = of_facets.and_then(|declared| declared.distribution.as_ref());
    let (Some(distribution), Some(masking)) = (distribution, &role.declared.masking) else {
        return Ok(Vec::new());
    };
    let mut found = vec![facets::prove_area(bench, area, distribution, masking)?];
    if let Some(draws) = of_facets.and_then(|declared| declared.draws.as_ref()).filter(|_| area.seen) {
        found.push(facets::prove_weight(bench, area, distribution, masking, draws)?);
    }
    Ok(found)
}
