//! The files of a package, as wesl asks for them.

use std::borrow::Cow;
use std::cell::RefCell;
use std::sync::Arc;

use shadewright_compiler::diagnostics::{Diagnostic, Report, SourceFile, codes};
use shadewright_compiler::{Library, limits};
use wesl::syntax::{PathOrigin, TranslationUnit};
use wesl::{ModulePath, ResolveError, Resolver};

use super::tokens::tokens;

/// Reads files of a library and remembers them. What is wrong with one itself is kept with its place.
pub(super) struct Files<'a> {
    library: &'a dyn Library,
    seen: RefCell<Vec<(ModulePath, Arc<SourceFile>)>>,
    refused: RefCell<Option<Report>>,
}

impl<'a> Files<'a> {
    pub fn new(library: &'a dyn Library, path: ModulePath, root: Arc<SourceFile>) -> Self {
        Self {
            library,
            seen: RefCell::new(vec![(path, root)]),
            refused: RefCell::default(),
        }
    }

    /// What keeps a file from being read, if something did since it was asked last.
    pub fn take_refusal(&self) -> Option<Report> {
        self.refused.borrow_mut().take()
    }

    /// The files read so far: the module's own, then the others by name, since wesl asks for them in any order.
    pub fn seen(&self) -> Vec<(ModulePath, Arc<SourceFile>)> {
        let mut seen = self.seen.borrow().clone();
        if let Some((_, others)) = seen.split_first_mut() {
            others.sort_by(|(_, a), (_, b)| a.name.cmp(&b.name));
        }
        seen
    }

    /// The file of this path, if it was read.
    pub fn file(&self, path: &ModulePath) -> Option<Arc<SourceFile>> {
        self.seen.borrow().iter().find(|(p, _)| p == path).map(|(_, file)| Arc::clone(file))
    }

    /// `a/b.wesl`, or `a/b.wgsl` where there is none.
    fn find(&self, path: &ModulePath) -> Result<Option<Arc<SourceFile>>, Report> {
        if path.origin != PathOrigin::Absolute || path.components.is_empty() {
            return Ok(None);
        }
        for ending in ["wesl", "wgsl"] {
            let name = format!("{}.{ending}", path.components.join("/"));
            if let Some(file) = self.library.file(&name)? {
                limits::check_wgsl(&file)?;
                return Ok(Some(file));
            }
        }
        Ok(None)
    }
}

impl Resolver for Files<'_> {
    fn resolve_source<'a>(&'a self, path: &ModulePath) -> Result<Cow<'a, str>, ResolveError> {
        if let Some(file) = self.file(path) {
            return Ok(file.text.clone().into());
        }
        let nowhere = || ResolveError::ModuleNotFound(path.clone(), String::new());
        match self.find(path) {
            Ok(Some(file)) => {
                self.seen.borrow_mut().push((path.clone(), Arc::clone(&file)));
                Ok(file.text.clone().into())
            }
            Ok(None) => Err(nowhere()),
            Err(report) => {
                self.refused.borrow_mut().get_or_insert(report);
                Err(nowhere())
            }
        }
    }

    fn resolve_module(&self, path: &ModulePath) -> Result<TranslationUnit, ResolveError> {
        let source = self.resolve_source(path)?;
        let unit: TranslationUnit = source
            .parse()
            .map_err(|error| wesl::Diagnostic::from(error).with_module_path(path.clone(), None))?;
        // wesl follows re-exports that lead in a circle without end.
        if unit.imports.iter().any(|import| import.attributes.iter().any(|a| a.is_publish()))
            && let Some(file) = self.file(path)
        {
            let all = tokens(&file.text);
            let place = all.iter().find(|t| t.text == "publish").map_or(0..0, |t| t.span.clone());
            let refused = Diagnostic::new(codes::WESL_IMPORT, "an import that is passed on")
                .at(&file, place, "not taken")
                .note("import from the file that has the declaration");
            self.refused.borrow_mut().get_or_insert(refused.into());
            return Err(ResolveError::ModuleNotFound(path.clone(), String::new()));
        }
        Ok(unit)
    }
}
