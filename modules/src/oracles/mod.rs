//! What the modules must compute, in double precision, written from the papers.
//!
//! Each function is the textbook form of its formula, in angles where the paper has angles: none is a translation of
//! the WGSL, which uses other forms for the sake of 32-bit floats. `tests/oracles.rs` pins them to published values and
//! to identities that they must obey.
//!
//! The truth of a module is in its folder: `truth.rs` names, for functions of its interface, what they should give
//! ([`TRUTHS`](self) of that file, found by the build script as the modules are). A category's folder may have one for
//! what its modules approximate.

pub mod albedo;
pub mod anisotropic;
pub mod appearance;
pub mod area;
pub mod cosines;
pub mod display;
pub mod drawn;
pub mod lights;
pub mod lobes;
pub mod quadrature;
pub mod reflection;
pub mod shadows;

use glam::DVec3;
use serde_json::Value as Json;

/// What a function should give at a configuration: its numbers in the order of the result's members and components.
pub type Truth = fn(&At) -> Vec<f64>;

/// The numbers of a table that the project computes itself: equal bits on every machine.
pub type Table = fn() -> Vec<f32>;

/// What computes a table of a module's folder, `category/name`, by the resource's name.
pub fn table(folder: &str, resource: &str) -> Option<Table> {
    let (_, tables) = folders::TABLES.iter().find(|(of, _)| *of == folder)?;
    tables.iter().find(|(of, _)| *of == resource).map(|(_, table)| *table)
}

/// Every table that the project computes: folder, resource and what computes it, sorted by folder.
pub fn tables() -> impl Iterator<Item = (&'static str, &'static str, Table)> {
    let all = folders::TABLES.iter();
    all.flat_map(|(folder, tables)| tables.iter().map(|(resource, table)| (*folder, *resource, *table)))
}

/// The `truth.rs` and `table.rs` of every folder, as modules of this one.
mod folders {
    include!(concat!(env!("OUT_DIR"), "/truths.rs"));
}

/// The truth of a folder, `category/name` or `category`, for a function of its interface.
pub fn truth(folder: &str, function: &str) -> Option<Truth> {
    let (_, truths) = folders::ALL.iter().find(|(of, _)| *of == folder)?;
    truths.iter().find(|(of, _)| *of == function).map(|(_, truth)| *truth)
}

/// Another number for other texts of the truths: what is kept of a report is of these.
pub const DIGEST: u64 = folders::DIGEST;

/// Folders that have truths, sorted.
pub fn folders() -> impl Iterator<Item = &'static str> {
    folders::ALL.iter().map(|(folder, _)| *folder)
}

/// One configuration: the arguments of a function, the parameters of its module and its instances, every number as a device gets it.
#[derive(Clone, Copy, Debug)]
pub struct At<'a> {
    /// Arguments by name, defaults filled in.
    pub inputs: &'a Json,
    /// Parameters of the module by name, in the parameters' units, defaults filled in.
    pub params: &'a Json,
    /// Instances of the module, defaults filled in.
    pub instances: &'a [Json],
}

impl At<'_> {
    /// A number of the arguments, by its path: `s.alpha`. NaN where there is none, which no report takes for a truth.
    pub fn number(&self, path: &str) -> f64 {
        number(find(self.inputs, path))
    }

    /// A vector of the arguments.
    pub fn vector(&self, path: &str) -> DVec3 {
        vector(find(self.inputs, path))
    }

    /// A parameter that is a number.
    pub fn param(&self, name: &str) -> f64 {
        number(self.params.get(name))
    }

    /// A parameter that is a vector or a colour.
    pub fn param_vector(&self, name: &str) -> DVec3 {
        vector(self.params.get(name))
    }

    /// A number of an instance.
    pub fn instance(&self, index: usize, name: &str) -> f64 {
        number(self.instances.get(index).and_then(|fields| fields.get(name)))
    }

    /// A vector of an instance.
    pub fn instance_vector(&self, index: usize, name: &str) -> DVec3 {
        vector(self.instances.get(index).and_then(|fields| fields.get(name)))
    }
}

fn find<'a>(json: &'a Json, path: &str) -> Option<&'a Json> {
    path.split('.').try_fold(json, |at, step| at.get(step))
}

fn number(json: Option<&Json>) -> f64 {
    match json {
        Some(Json::Bool(b)) => f64::from(u8::from(*b)),
        Some(json) => json.as_f64().unwrap_or(f64::NAN),
        None => f64::NAN,
    }
}

fn vector(json: Option<&Json>) -> DVec3 {
    let component = |i: usize| number(json.and_then(|json| json.get(i)));
    DVec3::new(component(0), component(1), component(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Catches a table without a folder's truths, and a truth found under another folder's name.
    #[test]
    fn truths_are_found_by_folder() {
        assert!(truth("ndf/ggx", "distribution").is_some());
        assert!(truth("ndf/ggx", "brdf").is_none());
        assert!(truth("ndf", "distribution").is_none());
        let all: Vec<_> = folders().collect();
        assert!(all.is_sorted() && all.len() > 5, "{all:?}");
    }

    /// Catches a missing number taken for 0.
    #[test]
    fn what_is_missing_is_no_number() {
        let (inputs, params) = (json!({"s": {"alpha": 0.5, "normal": [0, 0, 1]}}), json!({"on": true}));
        let at = At {
            inputs: &inputs,
            params: &params,
            instances: &[],
        };
        assert_eq!((at.number("s.alpha"), at.param("on"), at.vector("s.normal")), (0.5, 1.0, DVec3::Z));
        assert!(
            at.number("s.alhpa").is_nan() && at.number("s").is_nan() && at.vector("s.alpha").x.is_nan() && at.instance(0, "x").is_nan()
        );
    }
}
