//! A key for a cache of compiled passes, known before anything is compiled.

use std::collections::BTreeSet;
use std::hash::Hasher;
use std::sync::Arc;

use siphasher::sip128::{Hasher128, SipHasher13};

use crate::catalog::{Catalog, Module};
use crate::diagnostics::Report;
use crate::manifest::PassDecl;
use crate::program::Recipe;
use crate::resolve::{Place, Tree, resolve, resolve_root};

/// Version of naga, which canonical hashes and emitted text depend on.
pub const NAGA: &str = "30.0.1";

impl Catalog {
    /// A key of what [`Catalog::compile`] makes of a pass, for a cache on disk: nothing is parsed or linked for it.
    ///
    /// Equal keys mean equal products. It depends on the versions of this crate and of naga, on the pass's name, on the tree that the
    /// recipe stands for (not on how it is written), and on the text of every file that the tree can reach: manifest and WGSL of its
    /// modules and of the roots of their passes, declaration and text of their interfaces. Modules that it does not reach may change.
    /// It does not depend on the order of folders, on threads, or on the process.
    ///
    /// WGSL is read anew from the library; manifests are those that the catalog was loaded with.
    ///
    /// # Errors
    /// The recipe stands for no tree, or a file cannot be read. A pass that does not exist is no error here.
    pub fn key(&self, recipe: &Recipe, pass: &str) -> Result<u128, Report> {
        let mut key = Key(SipHasher13::new());
        for text in ["shadewright key 2", env!("CARGO_PKG_VERSION"), NAGA, pass] {
            key.text(text);
        }
        let mut reached = Reached::default();
        self.add_tree(&mut key, &mut reached, &resolve(self, recipe)?)?;
        for (path, module) in reached.modules {
            key.text(&path);
            key.text(&module.source.text);
            key.text(&self.text(&format!("{path}/{}.wgsl", module.name))?.unwrap_or_default());
        }
        // What an interface's text names may stand in the interfaces that it uses.
        let mut queue: Vec<String> = reached.categories.into_iter().collect();
        let mut known = BTreeSet::new();
        while let Some(name) = queue.pop() {
            if let Some(category) = self.category(&name).filter(|_| known.insert(name)) {
                queue.extend(category.manifest.uses.iter().cloned());
            }
        }
        for name in known {
            key.text(&name);
            key.text(self.category(&name).map_or("", |category| &category.source.text));
            key.text(&self.text(&format!("{name}/interface.wgsl"))?.unwrap_or_default());
        }
        Ok(key.finish())
    }

    fn add_tree(&self, key: &mut Key, reached: &mut Reached, tree: &Tree) -> Result<(), Report> {
        for (index, node) in tree.nodes.iter().enumerate() {
            let module = &node.module;
            key.text(&tree.path(index));
            key.text(&module.category);
            key.text(&module.name);
            key.text(node.label.as_deref().unwrap_or_default());
            for (name, (_, value)) in &node.constants {
                key.text(name);
                key.text(&value.wgsl());
            }
            key.text("");
            for (name, file) in &node.files {
                key.text(name);
                key.text(file);
            }
            key.text("");
            reached.categories.insert(module.category.clone());
            reached.categories.extend(module.manifest.uses.iter().cloned());
            reached
                .categories
                .extend(module.manifest.slots.values().map(|slot| slot.interface.clone()));
            let path = format!("{}/{}", module.category, module.name);
            if reached.modules.iter().any(|(known, _)| *known == path) {
                continue;
            }
            reached.modules.push((path, Arc::clone(module)));
            for (own, declared) in &module.manifest.passes {
                // Slots that the pass inherits are filled from this tree, which is in the key already.
                if let PassDecl::Draw { root, .. } = declared {
                    let place = Place::new(&module.source).keys(&["passes", own, "root"]);
                    let root_module = self.module_at(&root.module, None, || place.clone())?;
                    self.add_tree(key, reached, &resolve_root(self, root_module, root, place)?)?;
                }
            }
        }
        Ok(())
    }
}

/// What goes into a key.
#[derive(Default)]
struct Reached {
    modules: Vec<(String, Arc<Module>)>,
    categories: BTreeSet<String>,
}

struct Key(SipHasher13);

impl Key {
    fn text(&mut self, text: &str) {
        self.0.write(&(text.len() as u64).to_le_bytes());
        self.0.write(text.as_bytes());
    }

    fn finish(&self) -> u128 {
        let hash = self.0.finish128();
        u128::from(hash.h1) | u128::from(hash.h2) << 64
    }
}

#[cfg(test)]
mod tests {
    use super::NAGA;

    /// Catches a naga that was moved to another version without the keys of its products.
    #[test]
    fn the_version_is_that_of_the_dependency() {
        let manifest = include_str!("../../Cargo.toml");
        assert!(manifest.contains(&format!("\nnaga = {{ version = \"={NAGA}\"")));
    }
}
