//! What the library has for a place.

use std::sync::Arc;

use crate::catalog::Module;
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::manifest::Arity;
use crate::resolve::{Place, Way};

use super::super::format::FitsChoice;
use super::super::tree::{Expr, ExprId};
use super::{Around, Opener, Source, bounds, full_name};

impl Opener<'_> {
    /// All modules that fit.
    pub(super) fn fits(&mut self, fits: &FitsChoice, depth: u32, around: &Around, place: &Place) -> Result<Option<ExprId>, Report> {
        let (interface, arity) = match (&around.hole, &fits.of) {
            (Some((interface, _, arity)), None) => (interface.clone(), *arity),
            (None, Some(category)) if self.catalog.category(category).is_some() => (category.clone(), Arity::Single),
            (None, Some(category)) => {
                let at = place.keys(&["of"]);
                let known = self.catalog.categories().map(|c| c.name.as_str());
                return Err(
                    Diagnostic::new(codes::UNKNOWN_INTERFACE, format!("there is no category `{category}`"))
                        .at(&at.file, at.span(), "no such category")
                        .suggest(category, "categories", known)
                        .into(),
                );
            }
            (hole, _) => {
                let label = if hole.is_some() {
                    "the slot says of which category"
                } else {
                    "of which category?"
                };
                return Err(Diagnostic::new(codes::BAD_CHOICE, "`of` is for the root, which stands in no slot")
                    .at(&place.file, place.span(), label)
                    .into());
            }
        };
        self.known_names(&fits.without, place)?;
        let all: Vec<Arc<Module>> = self.catalog.modules().filter(|m| m.category == interface).map(Arc::clone).collect();
        let range = match arity {
            Arity::Single => (1, 1),
            Arity::Optional => bounds(fits.min, Some(fits.max.unwrap_or(1).min(1)), all.len(), place)?,
            Arity::List => bounds(fits.min, fits.max, all.len(), place)?,
        };
        let named = |m: &Module| fits.without.iter().any(|w| *w == m.name || *w == full_name(m));
        let fitting: Vec<Arc<Module>> = all
            .into_iter()
            .filter(|m| !named(m) && !around.above.contains(&full_name(m)))
            .collect();
        let source = Source::Fitting(fits, depth);
        let quiet = Around {
            quiet: true,
            ..around.clone()
        };
        if arity == Arity::List {
            let mut found = Vec::new();
            for (index, module) in fitting.iter().enumerate() {
                let around = quiet.element(index);
                let point = self.point(&around, &around.path, vec!["absent".to_owned(), module.name.clone()]);
                if let Some(id) = self.module(module, source, &around.under(point, 1), place)? {
                    found.push((point, id, module.name.clone()));
                }
            }
            return self.some_of(found, range, around, place);
        }
        let mut names: Vec<String> = fitting.iter().map(|m| m.name.clone()).collect();
        if range.0 == 0 {
            names.insert(0, "nothing".to_owned());
        }
        let point = self.point(around, &around.path, names);
        let mut options = Vec::new();
        if range.0 == 0 {
            options.push(Some(self.push(Expr::List(Vec::new()), (0, 0), place)?));
        }
        for module in fitting.iter().filter(|_| range.1 > 0) {
            let around = quiet.under(point, options.len() as u32);
            options.push(self.module(module, source, &around, place)?);
        }
        self.one_of(point, options, place)
    }

    fn known_names(&self, names: &[String], place: &Place) -> Result<(), Report> {
        for (index, name) in names.iter().enumerate() {
            if !self.catalog.modules().any(|m| *name == m.name || *name == full_name(m)) {
                let at = place.keys(&["without"]).then(Way::Index(index));
                let known = self.catalog.modules().map(|m| m.name.as_str());
                return Err(Diagnostic::new(codes::UNKNOWN_MODULE, format!("there is no module `{name}`"))
                    .at(&at.file, at.span(), "named here")
                    .suggest(name, "modules", known)
                    .into());
            }
        }
        Ok(())
    }
}
