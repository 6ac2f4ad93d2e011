//! What a scene says of modules, held against their manifests; errors point into the scene.

use std::sync::Arc;

use indexmap::IndexMap;
use shadewright_compiler::diagnostics::{Diagnostic, Report, codes};
use shadewright_compiler::manifest::{Arity, Param, Parsed, ResourceKind, Slot, Step, Value, typed};
use shadewright_compiler::{Catalog, Module};

use super::assets::Assets;
use super::{Choice, Choices, Picture, Scene};
use crate::data::diagnose;

/// A scene under examination.
pub(super) struct Examiner<'a> {
    pub parsed: &'a Parsed<Scene>,
    pub catalog: &'a Catalog,
    pub assets: Assets,
    pub errors: Vec<Diagnostic>,
}

/// The path with more steps.
pub(super) fn join<'a>(path: &[Step<'a>], more: &[Step<'a>]) -> Vec<Step<'a>> {
    [path, more].concat()
}

impl<'a> Examiner<'a> {
    /// Notes an error at a path of the scene.
    pub(super) fn error(&mut self, path: &[Step], code: &'static str, message: impl Into<String>, label: impl Into<String>) {
        self.errors.push(self.parsed.error_at(path, code, message, label));
    }

    /// The module of this name.
    pub(super) fn module(&mut self, name: &str, path: &[Step]) -> Option<Arc<Module>> {
        self.found(self.catalog.module(name), path)
    }

    fn found(&mut self, found: Result<&Arc<Module>, Report>, path: &[Step]) -> Option<Arc<Module>> {
        match found {
            Ok(module) => Some(Arc::clone(module)),
            Err(report) => {
                let span = self.parsed.places.find_near(path);
                self.errors.extend(report.diagnostics.into_iter().map(|mut d| {
                    // The first place is the primary one: where the name was written.
                    let others = std::mem::take(&mut d.labels);
                    let mut d = d.at(&self.parsed.file, span.clone(), "named here");
                    d.labels.extend(others);
                    d
                }));
                None
            }
        }
    }

    /// Checks a choice that stands in a slot of this interface, and all below it.
    pub(super) fn choice(&mut self, choice: &Choice, interface: Option<&str>, path: &[Step]) {
        let named = join(path, &[Step::Key("module")]);
        let catalog = self.catalog;
        let found = interface.map_or_else(
            || catalog.module(&choice.module),
            |interface| catalog.module_for(interface, &choice.module),
        );
        let Some(module) = self.found(found, &named) else {
            return;
        };
        if let Some(interface) = interface
            && module.category != interface
        {
            let fits: Vec<&str> = self
                .catalog
                .modules()
                .filter(|m| m.category == interface)
                .map(|m| m.name.as_str())
                .collect();
            let span = self.parsed.places.find_near(&named);
            self.errors.push(
                Diagnostic::new(
                    codes::WRONG_CATEGORY,
                    format!(
                        "`{}` is of the category `{}`, a module of `{interface}` is needed",
                        module.name, module.category
                    ),
                )
                .at(&self.parsed.file, span, "named here")
                .note(format!("what fits: {}", fits.join(", "))),
            );
            return;
        }
        self.fill(&choice.fill, &module, &module.manifest.slots, &join(path, &[Step::Key("fill")]));
        self.values(
            &choice.freeze,
            &module,
            &module.manifest.params,
            &join(path, &[Step::Key("freeze")]),
        );
        self.values(
            &choice.params,
            &module,
            &module.manifest.params,
            &join(path, &[Step::Key("params")]),
        );
        for (name, picture) in &choice.textures {
            let at = join(path, &[Step::Key("textures"), Step::Key(name)]);
            let resources = &module.manifest.resources;
            let texture = |r: &shadewright_compiler::manifest::Resource| matches!(r.kind, ResourceKind::Texture { .. });
            if !resources.get(name).is_some_and(texture) {
                let known = resources.iter().filter(|(_, r)| texture(r)).map(|(n, _)| n.as_str());
                let span = self.parsed.places.find_near(&at);
                self.errors.push(
                    Diagnostic::new(codes::UNKNOWN_SCENE_NAME, format!("`{}` has no texture `{name}`", module.name))
                        .at(&self.parsed.file, span, "no such texture")
                        .suggest(name, "textures", known),
                );
            } else if let Picture::File(file) = picture
                && let Err(why) = self.assets.texture(file)
            {
                self.error(&at, codes::ASSET_UNREADABLE, format!("the picture `{file}` cannot be read"), why);
            }
        }
        self.files(choice, &module, path);
    }

    /// Checks what fills a module's slots.
    pub(super) fn fill(&mut self, fill: &IndexMap<String, Choices>, module: &Module, slots: &IndexMap<String, Slot>, path: &[Step]) {
        for (name, choices) in fill {
            let at = join(path, &[Step::Key(name)]);
            let Some(slot) = slots.get(name) else {
                let span = self.parsed.places.find_near(&at);
                self.errors.push(
                    Diagnostic::new(codes::UNKNOWN_SLOT, format!("`{}` has no slot `{name}`", module.name))
                        .at(&self.parsed.file, span, "no such slot")
                        .suggest(name, "slots", slots.keys().map(String::as_str)),
                );
                continue;
            };
            if slot.arity != Arity::List && choices.all().len() > 1 {
                let n = choices.all().len();
                self.error(
                    &at,
                    codes::TOO_MANY_FILLINGS,
                    format!("the slot `{name}` takes one module"),
                    format!("{n} modules"),
                );
                continue;
            }
            match choices {
                Choices::One(one) => self.choice(one, Some(&slot.interface), &at),
                Choices::Many(many) => {
                    for (i, one) in many.iter().enumerate() {
                        self.choice(one, Some(&slot.interface), &join(&at, &[Step::Index(i)]));
                    }
                }
            }
        }
    }

    /// Checks the files of data that a choice names, and that it names those without which its module cannot do.
    fn files(&mut self, choice: &Choice, module: &Module, path: &[Step]) {
        let resources = &module.manifest.resources;
        for (name, file) in &choice.files {
            let at = join(path, &[Step::Key("files"), Step::Key(name)]);
            let Some(format) = module.manifest.format_of(name) else {
                let known = resources.keys().filter(|name| module.manifest.format_of(name).is_some());
                let span = self
                    .parsed
                    .places
                    .find_key(&at)
                    .unwrap_or_else(|| self.parsed.places.find_near(&at));
                self.errors.push(
                    Diagnostic::new(codes::UNKNOWN_FILE, format!("`{}` takes no file `{name}`", module.name))
                        .at(&self.parsed.file, span, "no such resource")
                        .suggest(name, "resources that take a file", known.map(String::as_str)),
                );
                continue;
            };
            if let Err(error) = self.assets.data(file, format) {
                let located = |code, message, label| self.parsed.error_at(&at, code, message, label);
                let found = diagnose(file, &error, located);
                self.errors.push(found);
            }
        }
        for (name, resource) in resources {
            if let ResourceKind::Data { file: None, format } = &resource.kind
                && !choice.files.contains_key(name)
            {
                let format = format.as_deref().unwrap_or_default();
                let message = format!("`{}.{name}` needs a file of the format `{format}`", module.name);
                let named = join(path, &[Step::Key("module")]);
                let found = self.parsed.error_at(&named, codes::MISSING_FILE, message, "none is named here");
                self.errors.push(found.note(format!("name one: `files: {{\"{name}\": \"PATH\"}}`")));
            }
        }
    }

    /// Checks values of parameters or of a light's fields.
    pub(super) fn values(&mut self, values: &IndexMap<String, Value>, module: &Module, known: &IndexMap<String, Param>, path: &[Step]) {
        for (name, value) in values {
            let at = join(path, &[Step::Key(name)]);
            let span = self.parsed.places.find_near(&at);
            match known.get(name) {
                None => {
                    let key = self.parsed.places.find_key(&at).unwrap_or(span);
                    let mut error = Diagnostic::new(codes::UNKNOWN_PARAM, format!("`{}` has no parameter `{name}`", module.name))
                        .at(&self.parsed.file, key, "no such parameter")
                        .suggest(name, "parameters", known.keys().map(String::as_str));
                    if module.manifest.instances.contains_key(name) {
                        error = error.note("it is a field of each light: write it under `fields`");
                    } else if module.manifest.params.contains_key(name) {
                        error = error.note("it belongs to all lights of this kind: write it under `params`");
                    }
                    self.errors.push(error);
                }
                Some(param) => {
                    if let Err(error) = typed(param, value) {
                        self.errors.push(error.diagnostic(name, &self.parsed.file, span));
                    }
                }
            }
        }
    }

    /// What was found, or nothing.
    pub(super) fn finish(&mut self) -> Result<(), Report> {
        if self.errors.is_empty() {
            return Ok(());
        }
        Err(Report {
            diagnostics: std::mem::take(&mut self.errors),
        })
    }
}
