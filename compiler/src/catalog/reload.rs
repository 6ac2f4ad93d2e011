//! Reading a library again after an edit, keeping what the edit does not touch.

use std::sync::Arc;

use super::load::{Declared, declared, read};
use super::{Catalog, Module, by_name, lock};
use crate::contracts;
use crate::diagnostics::Report;

impl Catalog {
    /// Reads the library again. Modules that no edit touches are kept with their parsed text: an edit of one module's file parses
    /// that module again, an edit of an interface those that use it. What a recipe then needs is parsed when it is compiled, as
    /// ever, and [`Program::is_current`](crate::Program::is_current) says which programs are to be compiled again.
    ///
    /// This catalog stays as it is, so an edit that cannot be loaded costs nothing.
    ///
    /// # Errors
    /// As for [`Catalog::load`].
    pub fn reload(&self) -> Result<Self, Report> {
        let Declared { categories, mut modules } = declared(self.library.as_ref())?;
        let mut catalog = Self {
            library: Arc::clone(&self.library),
            categories,
            modules: Vec::new(),
            by_name: Default::default(),
            interfaces: Default::default(),
            interface_units: Default::default(),
            parsed: Default::default(),
        };
        catalog.keep_interfaces(self)?;
        for module in &mut modules {
            let before = self.modules.iter().find(|m| m.category == module.category && m.name == module.name);
            if let Some(before) = before
                && catalog.is_untouched(before, module)?
            {
                *module = Arc::clone(before);
            }
        }
        catalog.by_name = by_name(&modules);
        catalog.modules = modules;
        Report::unless_empty(contracts::unknown_interfaces(&catalog))?;
        Ok(catalog)
    }

    /// How many texts of modules this catalog has parsed: what [`Catalog::reload`] saves can be counted.
    pub fn parsed(&self) -> usize {
        self.parsed.load(std::sync::atomic::Ordering::Relaxed)
    }

    /// Whether a module is this catalog's.
    pub(crate) fn has_module(&self, module: &Arc<Module>) -> bool {
        // Those that the compiler makes itself depend on their interfaces alone.
        module.category.is_empty() || self.modules.iter().any(|m| Arc::ptr_eq(m, module))
    }

    /// Keeps the interfaces whose declaration and text are as before, and so are all that they use.
    fn keep_interfaces(&mut self, before: &Self) -> Result<(), Report> {
        let mut kept: Vec<String> = Vec::new();
        for (name, interface) in lock(&before.interfaces).iter() {
            let declared = self.categories.get(name).map(|c| &c.source.text);
            if declared == Some(&interface.category.source.text)
                && read(self.library.as_ref(), &format!("{name}/interface.wgsl"))?.as_ref() == Some(&interface.file.text)
            {
                kept.push(name.clone());
            }
        }
        loop {
            let complete = |name: &String| {
                let uses = self.categories.get(name).map(|c| &c.manifest.uses);
                uses.is_some_and(|uses| uses.iter().all(|used| kept.contains(used)))
            };
            let still: Vec<String> = kept.iter().filter(|name| complete(name)).cloned().collect();
            if still.len() == kept.len() {
                break;
            }
            kept = still;
        }
        for name in kept {
            // What was declared before stays with its interface: modules are told apart by it.
            if let Some(category) = before.categories.get(&name) {
                self.categories.insert(name.clone(), Arc::clone(category));
            }
            if let Some(interface) = lock(&before.interfaces).get(&name) {
                lock(&self.interfaces).insert(name.clone(), Arc::clone(interface));
            }
            if let Some(unit) = lock(&before.interface_units).get(&name) {
                lock(&self.interface_units).insert(name, Arc::clone(unit));
            }
        }
        Ok(())
    }

    /// Whether a module's declaration, text and interfaces are as before.
    fn is_untouched(&self, before: &Module, module: &Module) -> Result<bool, Report> {
        let manifest = &module.manifest;
        let slots = manifest.slots.values().map(|slot| &slot.interface);
        let mut interfaces = slots.chain(&manifest.uses).chain([&module.category]);
        if before.source.text != module.source.text || before.data != module.data {
            return Ok(false);
        }
        let Some(unit) = before.variants.all().pop() else {
            // Never parsed: it is what it declares.
            return Ok(true);
        };
        if !interfaces.all(|name| lock(&self.interfaces).contains_key(name)) {
            return Ok(false);
        }
        let path = format!("{0}/{1}/{1}.wgsl", module.category, module.name);
        // Not the text alone: an edit in another file, of which this one is made, moves its places.
        Ok(self.library.file(&path)?.is_some_and(|file| file == unit.file))
    }
}
