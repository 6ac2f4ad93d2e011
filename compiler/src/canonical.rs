//! The canonical form: what a shader is, whatever its names, its order and its unused parts.
//!
//! A canonical module is one that the linker wrote: it walks from the entry points, so equal shaders come out in equal
//! order. Text is brought into it by linking it as the only module of a tree.

use std::sync::Arc;

use indexmap::IndexMap;

use crate::catalog::{Catalog, Module};
use crate::diagnostics::{Report, SourceFile};
use crate::hash::structural_hash;
use crate::library::Library;
use crate::link::link;
use crate::manifest::{ModuleManifest, Node};
use crate::parse::parse_whole;
use crate::plan::{Roots, plan, roomy};
use crate::resolve::{Instances, Place, resolve_root};

/// Hash of the canonical form of a complete WGSL text. Of a program's source form it is the program's hash.
///
/// # Errors
/// The text is no WGSL, has a type error, or no entry points.
pub fn canonical_hash(name: &str, wgsl: &str) -> Result<u128, Report> {
    canonical(name, wgsl, structural_hash)
}

/// The canonical form of a complete WGSL text.
///
/// # Errors
/// As for [`canonical_hash`].
pub fn canonical_module(name: &str, wgsl: &str) -> Result<naga::Module, Report> {
    canonical(name, wgsl, naga::Module::clone)
}

fn canonical<T: Send>(name: &str, wgsl: &str, of: impl FnOnce(&naga::Module) -> T + Send) -> Result<T, Report> {
    let catalog = Catalog::load(Arc::new(Nothing))?;
    let file = SourceFile::new(name, wgsl);
    let unit = parse_whole(Arc::clone(&file))?;
    let module = Arc::new(Module {
        name: name.to_owned(),
        category: String::new(),
        manifest: empty_manifest(),
        source: Arc::clone(&file),
        data: IndexMap::new(),
        variants: unit.into(),
    });
    let tree = resolve_root(&catalog, module, &Node::new(name), Place::new(&file))?;
    let instances = Instances::find(&catalog, &tree);
    let plan = plan(&catalog, tree, instances, &Roots::Main)?;
    Ok(roomy(plan.deep, || of(&link(&plan)))?)
}

/// A manifest that declares nothing.
pub(crate) fn empty_manifest() -> ModuleManifest {
    ModuleManifest {
        summary: String::new(),
        source: Vec::new(),
        slots: IndexMap::new(),
        uses: Vec::new(),
        params: IndexMap::new(),
        instances: IndexMap::new(),
        resources: IndexMap::new(),
        capabilities: Vec::new(),
        rules: Vec::new(),
        properties: Vec::new(),
        passes: IndexMap::new(),
        represents: Vec::new(),
    }
}

/// A library without anything.
struct Nothing;

impl Library for Nothing {
    fn folders(&self, _: &str) -> Vec<String> {
        Vec::new()
    }

    fn read(&self, _: &str) -> Result<Option<String>, String> {
        Ok(None)
    }
}
