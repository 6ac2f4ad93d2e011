//! All that a library declares, loaded once.

mod load;
mod reload;
mod signature;
mod variants;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use indexmap::IndexMap;
use naga::valid::Capabilities;
use rustc_hash::FxHashMap as HashMap;

pub use signature::Signature;

use crate::contracts;
use crate::diagnostics::{Diagnostic, Report, SourceFile, codes};
use crate::library::Library;
use crate::limits;
use crate::manifest::{CategoryManifest, ModuleManifest, Param, ParamMode, Typed, Value, typed};
use crate::parse::scan::{Item, ItemKind, scan};
use crate::parse::{Interface, Needs, SlotNeed, Unit, brackets, check_interface, compose, parse_unit};
use crate::resolve::Place;
use load::{Declared, declared, read};

pub(crate) use variants::{Constants, Variants};

/// A category with its name.
#[derive(Debug)]
pub struct Category {
    /// Name of its folder.
    pub name: String,
    /// Its declaration.
    pub manifest: CategoryManifest,
    /// `category.ron`.
    pub source: Arc<SourceFile>,
}

/// A module with its name.
#[derive(Debug)]
pub struct Module {
    /// Name of its folder.
    pub name: String,
    /// Its category's name; empty for modules that the compiler makes itself.
    pub category: String,
    /// Its declaration.
    pub manifest: ModuleManifest,
    /// `module.ron`.
    pub source: Arc<SourceFile>,
    /// Bytes of the files in its folder that its resources name.
    pub data: IndexMap<String, Arc<[u8]>>,
    /// Its parsed text.
    pub(crate) variants: Variants,
}

/// The manifests of a library, and a cache of its parsed WGSL. Cheap to load, shared between threads.
pub struct Catalog {
    library: Arc<dyn Library>,
    categories: IndexMap<String, Arc<Category>>,
    modules: Vec<Arc<Module>>,
    /// Modules by their names without category, in their order.
    by_name: HashMap<String, Vec<usize>>,
    interfaces: Mutex<HashMap<String, Arc<Interface>>>,
    interface_units: Mutex<HashMap<String, Arc<Unit>>>,
    /// How many texts it has parsed.
    parsed: AtomicUsize,
}

impl std::fmt::Debug for Catalog {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Catalog")
            .field("categories", &self.categories.len())
            .field("modules", &self.modules.len())
            .finish_non_exhaustive()
    }
}

impl Catalog {
    /// Reads all manifests of the library. WGSL is read and parsed when a recipe first needs it.
    ///
    /// A folder of the root is a category if it has a `category.ron`. Other folders are none of ours, unless modules stand in them.
    ///
    /// # Errors
    /// A manifest is no RON, or says something that cannot be.
    pub fn load(library: Arc<dyn Library>) -> Result<Self, Report> {
        let Declared { categories, modules } = declared(library.as_ref())?;
        let catalog = Self {
            library,
            categories,
            by_name: by_name(&modules),
            modules,
            interfaces: Mutex::default(),
            interface_units: Mutex::default(),
            parsed: AtomicUsize::new(0),
        };
        Report::unless_empty(contracts::unknown_interfaces(&catalog))?;
        Ok(catalog)
    }

    /// The library that it was loaded from.
    pub fn library(&self) -> &Arc<dyn Library> {
        &self.library
    }

    /// Categories in the order in which lists show them.
    pub fn categories(&self) -> impl Iterator<Item = &Arc<Category>> {
        self.categories.values()
    }

    /// The category of this name.
    pub fn category(&self, name: &str) -> Option<&Arc<Category>> {
        self.categories.get(name)
    }

    /// Modules, sorted by category order and name.
    pub fn modules(&self) -> impl Iterator<Item = &Arc<Module>> {
        self.modules.iter()
    }

    /// Names of the modules that fit a slot of this interface.
    pub fn fits(&self, interface: &str) -> Vec<String> {
        self.modules
            .iter()
            .filter(|m| m.category == interface)
            .map(|m| m.name.clone())
            .collect()
    }

    /// The module of this name, or `category/name`.
    ///
    /// # Errors
    /// There is none (says the nearest names), or several categories have one.
    pub fn module(&self, name: &str) -> Result<&Arc<Module>, Report> {
        self.find(name, None).map_err(Report::from)
    }

    /// The module that this name means in a slot: of several with the name the one that fits.
    ///
    /// # Errors
    /// Those of [`Catalog::module`]. A module that does not fit is none.
    pub fn module_for(&self, interface: &str, name: &str) -> Result<&Arc<Module>, Report> {
        self.find(name, Some((interface, ""))).or_else(|_| self.module(name))
    }

    /// The module that a node of a recipe names, for a slot (interface and slot name) or as a root.
    pub(crate) fn module_at(&self, name: &str, slot: Option<(&str, &str)>, place: impl FnOnce() -> Place) -> Result<Arc<Module>, Report> {
        self.find(name, slot).map(Arc::clone).map_err(|mut diagnostic| {
            // The first place is the primary one: where the name was written.
            let place = place();
            let text = if diagnostic.code == codes::WRONG_CATEGORY {
                "does not fit here"
            } else {
                "named here"
            };
            diagnostic.labels.insert(
                0,
                crate::diagnostics::Label {
                    span: place.name_span(),
                    file: place.file,
                    text: text.to_owned(),
                },
            );
            Report::from(diagnostic)
        })
    }

    fn find(&self, name: &str, slot: Option<(&str, &str)>) -> Result<&Arc<Module>, Diagnostic> {
        let (category, short) = match name.split_once('/') {
            Some((category, short)) => (Some(category), short),
            None => (None, name),
        };
        let named = self.by_name.get(short).into_iter().flatten();
        let all = named
            .map(|&index| &self.modules[index])
            .filter(|m| category.is_none_or(|c| c == m.category));
        let Some((interface, slot)) = slot else {
            let all: Vec<_> = all.collect();
            return match all[..] {
                [] => Err(self.unknown(name, None)),
                [one] => Ok(one),
                _ => {
                    let full: Vec<String> = all.iter().map(|m| format!("`{}/{}`", m.category, m.name)).collect();
                    Err(
                        Diagnostic::new(codes::AMBIGUOUS_NAME, format!("several modules are called `{name}`"))
                            .note(format!("write one of {}", full.join(", "))),
                    )
                }
            };
        };
        if let Some(module) = all.clone().find(|m| m.category == interface) {
            return Ok(module);
        }
        match all.clone().next() {
            None => Err(self.unknown(name, Some(interface))),
            Some(other) => {
                let fits = self.fits(interface);
                let fits = if fits.is_empty() { "none".to_owned() } else { fits.join(", ") };
                Err(Diagnostic::new(
                    codes::WRONG_CATEGORY,
                    format!(
                        "`{}` is a module of `{}`; the slot `{slot}` takes modules of `{interface}`",
                        other.name, other.category
                    ),
                )
                .note(format!("modules of `{interface}`: {fits}")))
            }
        }
    }

    fn unknown(&self, name: &str, interface: Option<&str>) -> Diagnostic {
        let known = self
            .modules
            .iter()
            .filter(|m| interface.is_none_or(|i| m.category == i))
            .map(|m| m.name.as_str());
        Diagnostic::new(codes::UNKNOWN_MODULE, format!("there is no module `{name}`")).suggest(name, "modules", known)
    }

    /// Text of a file of the library; `None` where there is none.
    pub(crate) fn text(&self, path: &str) -> Result<Option<String>, Report> {
        read(self.library.as_ref(), path)
    }

    /// A category's interface, scanned.
    pub(crate) fn interface(&self, name: &str) -> Result<Arc<Interface>, Report> {
        if let Some(done) = lock(&self.interfaces).get(name) {
            return Ok(Arc::clone(done));
        }
        let interface = Arc::new(self.read_interface(name)?);
        // What it offers may be declared by what it uses; those are looked at themselves when they are asked for.
        let mut known = vec![name.to_owned()];
        let mut used = Vec::new();
        let mut queue = interface.category.manifest.uses.clone();
        while interface.category.manifest.offers.iter().any(|f| interface.scan.item(f).is_none()) {
            let Some(next) = queue.pop() else { break };
            if !known.contains(&next) {
                let other = self.read_interface(&next)?;
                queue.extend(other.category.manifest.uses.iter().cloned());
                used.push(other);
                known.push(next);
            }
        }
        contracts::named_functions(&interface, &used)?;
        Ok(first(&self.interfaces, name, interface))
    }

    fn read_interface(&self, name: &str) -> Result<Interface, Report> {
        let Some(category) = self.categories.get(name) else {
            let known = self.categories.keys().map(String::as_str);
            let diagnostic = Diagnostic::new(codes::UNKNOWN_INTERFACE, format!("there is no category `{name}`"));
            return Err(diagnostic.suggest(name, "categories", known).into());
        };
        let path = format!("{name}/interface.wgsl");
        let file = match read(self.library.as_ref(), &path)? {
            Some(text) => SourceFile::new(path, text),
            None => {
                return Err(
                    Diagnostic::new(codes::MISSING_INTERFACE, format!("the category `{name}` has no `interface.wgsl`"))
                        .at(&category.source, 0..0, "declared here")
                        .into(),
                );
            }
        };
        limits::check_wgsl(&file)?;
        let scan = scan(&file.text);
        brackets(&file, &scan)?;
        Ok(Interface {
            category: Arc::clone(category),
            file,
            scan,
        })
    }

    /// A category's interface, parsed with its neutral bodies.
    pub(crate) fn interface_unit(&self, name: &str) -> Result<Arc<Unit>, Report> {
        if let Some(done) = lock(&self.interface_units).get(name) {
            return Ok(Arc::clone(done));
        }
        let interface = self.interface(name)?;
        let needs = Needs {
            uses: interface.category.manifest.uses.clone(),
            ..Needs::default()
        };
        let composed = compose(&interface.file, &interface.scan, &needs, &|n| self.interface(n))?;
        let unit = parse_unit(
            Arc::clone(&interface.file),
            interface.scan.clone(),
            composed,
            needs,
            Some(name.to_owned()),
        )?;
        contracts::interface_unit(&interface.category, &unit)?;
        let unit = Arc::new(unit);
        Ok(first(&self.interface_units, name, unit))
    }

    /// A module, parsed with these constants.
    pub(crate) fn unit(
        &self,
        module: &Arc<Module>,
        constants: &IndexMap<String, (Value, Typed)>,
        variant: &Constants,
    ) -> Result<Arc<Unit>, Report> {
        if let Some(done) = module.variants.get(variant) {
            return Ok(done);
        }
        let path = format!("{0}/{1}/{1}.wgsl", module.category, module.name);
        let file = match self.library.file(&path)? {
            Some(file) => file,
            None => {
                return Err(Diagnostic::new(codes::MISSING_WGSL, format!("`{path}` is not there"))
                    .at(&module.source, 0..0, "declared here")
                    .note("a module's WGSL is called like its folder")
                    .into());
            }
        };
        let unit = Arc::new(self.parse_module(module, file, constants)?);
        Ok(module.variants.insert(variant.clone(), unit))
    }

    /// Parses a module's text.
    pub(crate) fn parse_module(
        &self,
        module: &Module,
        file: Arc<SourceFile>,
        constants: &IndexMap<String, (Value, Typed)>,
    ) -> Result<Unit, Report> {
        limits::check_wgsl(&file)?;
        self.parsed.fetch_add(1, Ordering::Relaxed);
        let scan = scan(&file.text);
        brackets(&file, &scan)?;
        let needs = needs(module, constants)?;
        let composed = compose(&file, &scan, &needs, &|n| self.interface(n))?;
        let unit = parse_unit(file, scan, composed, needs, None).map_err(|report| self.blame(report))?;
        if !module.category.is_empty() {
            check_interface(
                &unit,
                self.interface(&module.category)?.as_ref(),
                self.interface_unit(&module.category)?.as_ref(),
            )?;
        }
        Ok(unit)
    }

    /// Of an error in an interface's text that showed in a module, the one that the interface has by itself.
    fn blame(&self, report: Report) -> Report {
        let file = report
            .diagnostics
            .first()
            .and_then(|d| d.labels.first())
            .map(|l| l.file.name.as_str());
        let category = file
            .and_then(|name| name.strip_suffix("/interface.wgsl"))
            .filter(|c| self.categories.contains_key(*c));
        category.and_then(|category| self.interface_unit(category).err()).unwrap_or(report)
    }

    /// The functions that a category's modules define, with comment, signature and neutral body as the interface has them;
    /// none for categories of roots, whose modules have entry points of their own.
    ///
    /// # Errors
    /// There is no such category, or its interface cannot be read.
    pub fn functions(&self, category: &str) -> Result<IndexMap<String, String>, Report> {
        let interface = self.interface(category)?;
        let offers = &interface.category.manifest.offers;
        let functions = interface
            .scan
            .items
            .iter()
            .filter(|item| item.kind == ItemKind::Function && !offers.contains(&item.name));
        let text = |item: &Item| interface.file.text[item.doc_start..item.span.end].to_owned();
        Ok(functions.map(|item| (item.name.clone(), text(item))).collect())
    }

    /// Checks a module alone: its manifest's references and its WGSL with every parameter as declared.
    ///
    /// # Errors
    /// Anything wrong that can be known without a recipe.
    pub fn check_module(&self, name: &str) -> Result<(), Report> {
        let module = self.module(name)?;
        let mut constants = IndexMap::new();
        for (name, param) in module.manifest.params.iter().filter(|(_, p)| p.mode == ParamMode::Constant) {
            constants.insert(name.clone(), (param.default.clone(), default_of(module, name, param)?));
        }
        let unit = self.unit(module, &constants, &Variants::key(&constants))?;
        crate::resolve::check_resources(module, &unit)?;
        contracts::module_references(self, module, &unit)
    }
}

fn by_name(modules: &[Arc<Module>]) -> HashMap<String, Vec<usize>> {
    let mut by_name: HashMap<String, Vec<usize>> = HashMap::default();
    for (index, module) in modules.iter().enumerate() {
        by_name.entry(module.name.clone()).or_default().push(index);
    }
    by_name
}

fn needs(module: &Module, constants: &IndexMap<String, (Value, Typed)>) -> Result<Needs, Report> {
    let manifest = &module.manifest;
    let mut needs = Needs {
        implements: Some(module.category.clone()).filter(|c| !c.is_empty()),
        slots: manifest
            .slots
            .iter()
            .map(|(name, slot)| SlotNeed {
                name: name.clone(),
                interface: slot.interface.clone(),
                prefix: slot.prefix.clone(),
            })
            .collect(),
        uses: manifest.uses.clone(),
        instances: manifest.instances.clone(),
        manifest: Some(Arc::clone(&module.source)).filter(|_| !module.category.is_empty()),
        // Names are known to be capabilities since the manifest was checked.
        capabilities: manifest
            .capabilities
            .iter()
            .filter_map(|name| Capabilities::from_name(name))
            .collect(),
        ..Needs::default()
    };
    for (name, param) in &manifest.params {
        if let Some((_, value)) = constants.get(name) {
            needs.constants.insert(name.clone(), *value);
            continue;
        }
        match param.mode {
            ParamMode::Override => {
                needs
                    .overrides
                    .insert(name.clone(), (param.clone(), default_of(module, name, param)?));
            }
            _ => {
                needs.uniforms.insert(name.clone(), param.clone());
            }
        }
    }
    Ok(needs)
}

fn default_of(module: &Module, name: &str, param: &Param) -> Result<Typed, Report> {
    typed(param, &param.default).map_err(|error| {
        let place = Place::new(&module.source).keys(&["params", name, "default"]);
        error.diagnostic(name, &module.source, place.span()).into()
    })
}

/// Keeps what was made, unless another thread was faster: whoever asks gets the one that was there first, since linking goes by
/// identity.
fn first<T>(kept: &Mutex<HashMap<String, Arc<T>>>, name: &str, made: Arc<T>) -> Arc<T> {
    Arc::clone(lock(kept).entry(name.to_owned()).or_insert(made))
}

/// A panic while the lock was held can only have left a cache entry out: the maps are never half changed.
pub(crate) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
