//! A space's text and a catalog to the tree of all its alternatives.

mod fits;

use std::collections::HashMap;
use std::sync::Arc;

use naga::valid::Capabilities;

use crate::catalog::{Catalog, Module};
use crate::diagnostics::{Diagnostic, Report, codes};
use crate::limits::{LIST_LENGTH, TREE_DEPTH};
use crate::manifest::{Among, Arity, ParamMode, Slot, default_of};
use crate::resolve::fill::{bad_label, circle, is_identifier, missing_filling, too_deep, unknown_params, unknown_slots, wrong_number};
use crate::resolve::{Place, Way};

use super::amounts::{self, Amounts};
use super::format::{Choice, Fits, FitsChoice, Limits, SpaceFile, SpaceNode, SpaceRule};
use super::signature::Own;
use super::tree::{Expr, ExprId, ModuleExpr, Part, PartKind, Point, Tree};
use super::values::{shown, values};
use super::watch::rules_of;

/// Most expressions of an opened space ([`codes::SPACE_TOO_LARGE`]).
pub const MOST_EXPRESSIONS: usize = 1 << 18;

/// How many levels of slots `fits: Open` opens where nothing is said.
pub const OPEN_DEPTH: u32 = 8;

/// Opens a space. The root is the tree's last expression; the tree is empty where nothing can stand at the root.
///
/// # Errors
/// A name, slot, parameter, value or bound is wrong, or there are too many alternatives.
pub fn open(catalog: &Catalog, file: &SpaceFile) -> Result<Tree, Report> {
    check_limits(&file.limits, file)?;
    let mut opener = Opener {
        catalog,
        rules: &file.rules,
        limits: &file.limits,
        tree: Tree::default(),
        lengths: Vec::new(),
        defaults: Vec::new(),
        amounts: HashMap::new(),
    };
    let place = root_place(file);
    let around = Around {
        hole: None,
        parent: None,
        point: None,
        depth: 0,
        path: "main".to_owned(),
        above: Vec::new(),
        quiet: false,
    };
    let root = opener.choice(&file.root, &around, &place)?;
    let Some(root) = root else { return Ok(Tree::default()) };
    if opener.lengths[root] != (1, 1) {
        return Err(Diagnostic::new(codes::BAD_CHOICE, "a recipe has exactly one root")
            .at(&place.file, place.span(), "this is not always one module")
            .into());
    }
    let mut tree = opener.tree;
    for point in &mut tree.points {
        point.first_value = tree.values;
        tree.values += point.options.len();
    }
    Ok(tree)
}

/// Where the root's choice stands in the text.
pub fn root_place(file: &SpaceFile) -> Place {
    let whole = Place::new(&file.source);
    if file.framed { whole.keys(&["root"]) } else { whole }
}

fn check_limits(limits: &Limits, file: &SpaceFile) -> Result<(), Report> {
    for (index, name) in limits.lacks.iter().enumerate() {
        if Capabilities::from_name(name).is_none() {
            let at = Place::new(&file.source).keys(&["limits", "lacks"]).then(Way::Index(index));
            let known = Capabilities::all().iter_names().map(|(name, _)| name);
            return Err(
                Diagnostic::new(codes::UNKNOWN_CAPABILITY, format!("there is no capability `{name}`"))
                    .at(&at.file, at.span(), "unknown")
                    .suggest(name, "capabilities", known)
                    .into(),
            );
        }
    }
    Ok(())
}

/// What surrounds a choice.
#[derive(Clone)]
struct Around {
    /// Slot that is filled: its interface, name and arity. Inside brackets a slot's elements are single.
    hole: Option<(String, String, Arity)>,
    /// The module with the slot, and its tags.
    parent: Option<(Arc<Module>, Vec<String>)>,
    /// Nearest choice around it, with its option.
    point: Option<(usize, u32)>,
    /// Slots above it.
    depth: usize,
    /// Slot path.
    path: String,
    /// Modules that it stands in, outermost first.
    above: Vec<String>,
    /// Whether the library itself was asked what fits: then what cannot be is left out instead of being an error.
    quiet: bool,
}

impl Around {
    /// The same, below an option of a choice.
    fn under(&self, point: usize, option: u32) -> Self {
        Self {
            point: Some((point, option)),
            ..self.clone()
        }
    }

    /// An element of a list.
    fn element(&self, index: usize) -> Self {
        let mut around = self.clone();
        around.path = format!("{}[{index}]", self.path);
        if let Some((.., arity)) = &mut around.hole {
            *arity = Arity::Single;
        }
        around
    }
}

/// Where a module was named.
#[derive(Clone, Copy)]
enum Source<'a> {
    /// In the space or in a default.
    Written(&'a SpaceNode),
    /// Nowhere: it fits.
    Fitting(&'a FitsChoice, u32),
}

struct Opener<'a> {
    catalog: &'a Catalog,
    rules: &'a [SpaceRule],
    limits: &'a Limits,
    tree: Tree,
    /// Fewest and most modules of each expression.
    lengths: Vec<(u32, u32)>,
    /// Modules whose defaults are being expanded, outermost first.
    defaults: Vec<Arc<Module>>,
    amounts: HashMap<String, Amounts>,
}

impl Opener<'_> {
    fn push(&mut self, expr: Expr, length: (u32, u32), place: &Place) -> Result<ExprId, Report> {
        if self.tree.exprs.len() >= MOST_EXPRESSIONS {
            return Err(Diagnostic::new(codes::SPACE_TOO_LARGE, "the space has too many alternatives")
                .at(&place.file, place.name_span(), "with these")
                .note(format!("at most {MOST_EXPRESSIONS} are taken, those inside one another counted"))
                .note("open fewer levels (`depth`), or leave modules out (`without`)")
                .into());
        }
        self.tree.exprs.push(expr);
        self.lengths.push(length);
        Ok(self.tree.exprs.len() - 1)
    }

    fn point(&mut self, around: &Around, path: &str, mut options: Vec<String>) -> usize {
        for index in (1..options.len()).rev() {
            let same = options[..index].iter().filter(|other| **other == options[index]).count();
            if same > 0 {
                options[index] = format!("{} ({})", options[index], same + 1);
            }
        }
        self.tree.points.push(Point {
            parent: around.point,
            path: path.to_owned(),
            options,
            first_value: 0,
        });
        self.tree.points.len() - 1
    }

    /// An expression for a choice; `None` where it can never be made.
    fn choice(&mut self, choice: &Choice, around: &Around, place: &Place) -> Result<Option<ExprId>, Report> {
        match choice {
            Choice::Node(node) => self.written(node, around, place),
            Choice::List(list) => {
                let mut row = Vec::with_capacity(list.len());
                for (index, element) in list.iter().enumerate() {
                    let at = place.then(Way::Index(index));
                    row.push(self.choice(element, &around.element(index), &at)?);
                }
                let Some(row) = row.into_iter().collect::<Option<Vec<ExprId>>>() else {
                    return Ok(None);
                };
                let length = row.iter().fold((0u32, 0u32), |sum, &id| add(sum, self.lengths[id]));
                Ok(Some(self.push(Expr::List(row), length, place)?))
            }
            Choice::OneOf(of) => {
                let at = place.keys(&["one_of"]);
                if of.is_empty() {
                    return Err(empty(&at));
                }
                let point = self.point(around, &around.path, of.iter().map(name_of).collect());
                let mut options = Vec::with_capacity(of.len());
                for (k, option) in of.iter().enumerate() {
                    options.push(self.choice(option, &around.under(point, k as u32), &at.then(Way::Index(k)))?);
                }
                self.one_of(point, options, place)
            }
            Choice::SomeOf { of, min, max } => {
                let at = place.keys(&["some_of"]);
                let range = bounds(*min, *max, of.len(), place)?;
                let names: Vec<String> = of.iter().map(name_of).collect();
                let mut found = Vec::new();
                for (index, element) in of.iter().enumerate() {
                    let around = around.element(index);
                    let point = self.point(&around, &around.path, vec!["absent".to_owned(), names[index].clone()]);
                    if let Some(id) = self.choice(element, &around.under(point, 1), &at.then(Way::Index(index)))? {
                        found.push((point, id, names[index].clone()));
                    }
                }
                self.some_of(found, range, around, place)
            }
            Choice::Fits(fits) => self.fits(fits, fits.depth.unwrap_or(OPEN_DEPTH), around, place),
        }
    }

    fn one_of(&mut self, point: usize, options: Vec<Option<ExprId>>, place: &Place) -> Result<Option<ExprId>, Report> {
        let lengths = options.iter().flatten().map(|&id| self.lengths[id]);
        let length = lengths.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        match length {
            None => Ok(None),
            Some(length) => Ok(Some(self.push(Expr::OneOf { point, options }, length, place)?)),
        }
    }

    fn some_of(
        &mut self,
        found: Vec<(usize, ExprId, String)>,
        range: (u32, u32),
        around: &Around,
        place: &Place,
    ) -> Result<Option<ExprId>, Report> {
        if (found.len() as u32) < range.0 {
            return Ok(None);
        }
        let of: Vec<ExprId> = found.iter().map(|&(_, id, _)| id).collect();
        let fewest = of.iter().map(|&id| self.lengths[id].0).min().unwrap_or(0);
        let most = of.iter().map(|&id| self.lengths[id].1).max().unwrap_or(0);
        let range = (range.0, range.1.min(of.len() as u32));
        let length = (range.0.saturating_mul(fewest), range.1.saturating_mul(most));
        let expr = Expr::SomeOf {
            points: found.iter().map(|&(point, ..)| point).collect(),
            names: found.into_iter().map(|(.., name)| name).collect(),
            of,
            range,
            path: around.path.clone(),
        };
        Ok(Some(self.push(expr, length, place)?))
    }

    fn written(&mut self, node: &SpaceNode, around: &Around, place: &Place) -> Result<Option<ExprId>, Report> {
        let hole = around.hole.as_ref().map(|(interface, slot, _)| (interface.as_str(), slot.as_str()));
        let module = self.catalog.module_at(&node.module, hole, || place.clone())?;
        unknown_slots(&module, node.fill.keys(), || place.clone())?;
        unknown_params(&module, node.freeze.keys(), || place.clone())?;
        if let Some(label) = node.label.as_ref().filter(|label| !is_identifier(label)) {
            return Err(bad_label(label, place));
        }
        self.module(&module, Source::Written(node), around, place)
    }

    fn module(&mut self, module: &Arc<Module>, source: Source, around: &Around, place: &Place) -> Result<Option<ExprId>, Report> {
        if around.depth > TREE_DEPTH {
            return if around.quiet { Ok(None) } else { Err(too_deep(place)) };
        }
        let (tags, label) = match source {
            Source::Written(node) => (node.tags.clone(), node.label.clone()),
            Source::Fitting(..) => (Vec::new(), None),
        };
        let may_stand = self.may_stand(module, &tags, around);
        // What a person wrote is looked through for errors even where it cannot stand.
        if around.quiet && !may_stand {
            return Ok(None);
        }
        let parts = self.parts(module, source, &tags, around, place)?;
        let Some(parts) = parts.filter(|_| may_stand) else {
            return Ok(None);
        };
        let name = match source {
            Source::Written(node) => node.module.clone(),
            // In a slot the name alone tells, at the root only where no other category has it.
            Source::Fitting(..) if around.hole.is_some() || self.catalog.module(&module.name).is_ok() => module.name.clone(),
            Source::Fitting(..) => full_name(module),
        };
        let amounts = self.amounts(module)?;
        let expr = Expr::Module(Box::new(ModuleExpr {
            name,
            module: Arc::clone(module),
            label,
            parts,
            root: around.depth == 0,
            amounts,
            own: Own::default(),
            tags,
        }));
        Ok(Some(self.push(expr, (1, 1), place)?))
    }

    /// Whether the target's capabilities and the rules about the module above let it stand here.
    fn may_stand(&self, module: &Module, tags: &[String], around: &Around) -> bool {
        let lacked = module.manifest.capabilities.iter().any(|c| self.limits.lacks.contains(c));
        let kept = rules_of(module, tags, around.depth == 0, self.rules)
            .into_iter()
            .filter(|rule| rule.among == Among::Parent)
            .all(|rule| match &around.parent {
                // A tree that stands alone has no parent to judge by.
                None => true,
                Some((parent, tags)) => rule.tag.is_on(parent, tags) == rule.wanted,
            });
        kept && !lacked
    }

    fn amounts(&mut self, module: &Arc<Module>) -> Result<Amounts, Report> {
        let name = full_name(module);
        if let Some(&known) = self.amounts.get(&name) {
            return Ok(known);
        }
        let amounts = amounts::of_module(self.catalog, module, self.limits)?;
        self.amounts.insert(name, amounts);
        Ok(amounts)
    }

    fn parts(
        &mut self,
        module: &Arc<Module>,
        source: Source,
        tags: &[String],
        around: &Around,
        place: &Place,
    ) -> Result<Option<Vec<Part>>, Report> {
        let mut parts = Vec::new();
        for (name, param) in &module.manifest.params {
            let written = match source {
                Source::Written(node) => node.freeze.get(name),
                Source::Fitting(..) => None,
            };
            let (said, implicit) = match written {
                Some(written) => (values(name, param, written, &place.keys(&["freeze", name]))?, false),
                // A checked manifest's defaults fit.
                None if param.mode == ParamMode::Constant => match default_of(param) {
                    Ok(value) => (vec![(param.default.clone(), value)], true),
                    Err(_) => continue,
                },
                None => continue,
            };
            let names: Vec<String> = said.iter().map(|(value, _)| shown(value)).collect();
            let mut ids = Vec::with_capacity(said.len());
            for (value, typed) in said {
                let exact = Some(typed.wgsl());
                ids.push(Some(self.push(Expr::Value { value, exact }, (0, 0), place)?));
            }
            let expr = match ids.as_slice() {
                &[Some(only)] => only,
                _ => {
                    let point = self.point(around, &format!("{}.{name}", around.path), names);
                    self.push(Expr::OneOf { point, options: ids }, (0, 0), place)?
                }
            };
            parts.push(Part {
                kind: PartKind::Param(name.clone()),
                implicit,
                expr,
            });
        }
        let mut possible = true;
        for (name, slot) in &module.manifest.slots {
            match self.slot(module, source, tags, (name, slot), around, place)? {
                Some((expr, implicit)) => parts.push(Part {
                    kind: PartKind::Slot(name.clone(), slot.arity),
                    implicit,
                    expr,
                }),
                None => possible = false,
            }
        }
        Ok(Some(parts).filter(|_| possible))
    }

    /// What may stand in a slot, and whether that is its default.
    fn slot(
        &mut self,
        module: &Arc<Module>,
        source: Source,
        tags: &[String],
        (name, slot): (&String, &Slot),
        around: &Around,
        place: &Place,
    ) -> Result<Option<(ExprId, bool)>, Report> {
        let mut inner = Around {
            hole: Some((slot.interface.clone(), name.clone(), slot.arity)),
            parent: Some((Arc::clone(module), tags.to_vec())),
            point: around.point,
            depth: around.depth + 1,
            path: format!("{}.{name}", around.path),
            above: around.above.clone(),
            quiet: around.quiet,
        };
        inner.above.push(full_name(module));
        let written = match source {
            Source::Written(node) => node.fill.get(name),
            Source::Fitting(..) => None,
        };
        let (found, at, implicit) = match (written, source, &slot.default) {
            (Some(choice), ..) => {
                let at = place.keys(&["fill", name]);
                (self.choice(choice, &inner, &at)?, at, false)
            }
            (None, Source::Fitting(fits, depth), _) if fits.fits == Fits::Open && depth > 0 => {
                // Bounds are those of the place that asks.
                let below = FitsChoice {
                    of: None,
                    min: None,
                    max: None,
                    ..fits.clone()
                };
                return Ok(self.fits(&below, depth - 1, &inner, place)?.map(|id| (id, false)));
            }
            (None, _, Some(default)) => {
                let at = Place::new(&module.source).keys(&["slots", name, "default"]);
                if let Some(circle) = circle(&self.defaults, module, || at.clone()) {
                    return if around.quiet { Ok(None) } else { Err(circle) };
                }
                self.defaults.push(Arc::clone(module));
                let found = self.choice(&Choice::from(default), &inner, &at);
                self.defaults.pop();
                (found?, at, true)
            }
            (None, Source::Fitting(fits, _), None) if slot.arity == Arity::Single => {
                let below = FitsChoice {
                    fits: Fits::Defaults,
                    of: None,
                    min: None,
                    max: None,
                    ..fits.clone()
                };
                return Ok(self.fits(&below, 0, &inner, place)?.map(|id| (id, false)));
            }
            (None, Source::Written(_), None) if slot.arity == Arity::Single => {
                return if around.quiet {
                    Ok(None)
                } else {
                    Err(missing_filling(self.catalog, module, name, slot, place))
                };
            }
            (None, _, None) => return Ok(Some((self.push(Expr::List(Vec::new()), (0, 0), place)?, true))),
        };
        let Some(found) = found else { return Ok(None) };
        let (fewest, most) = self.lengths[found];
        let takes = match slot.arity {
            Arity::Single => (1, 1),
            Arity::Optional => (0, 1),
            Arity::List => (0, LIST_LENGTH as u32),
        };
        if most > takes.1 {
            return Err(wrong_number(most as usize, (name, slot.arity), module, &at));
        }
        if fewest < takes.0 {
            return Err(wrong_number(fewest as usize, (name, slot.arity), module, &at));
        }
        Ok(Some((found, implicit)))
    }
}

fn add(a: (u32, u32), b: (u32, u32)) -> (u32, u32) {
    (a.0.saturating_add(b.0), a.1.saturating_add(b.1))
}

fn full_name(module: &Module) -> String {
    format!("{}/{}", module.category, module.name)
}

/// What a choice is called in a list of options.
fn name_of(choice: &Choice) -> String {
    match choice {
        Choice::Node(node) => node.module.clone(),
        Choice::List(list) if list.is_empty() => "nothing".to_owned(),
        Choice::List(list) => list.iter().map(name_of).collect::<Vec<_>>().join(" + "),
        Choice::OneOf(of) => of.iter().map(name_of).collect::<Vec<_>>().join(" | "),
        Choice::SomeOf { of, .. } => format!("some of {}", of.iter().map(name_of).collect::<Vec<_>>().join(", ")),
        Choice::Fits(_) => "what fits".to_owned(),
    }
}

fn empty(at: &Place) -> Report {
    Diagnostic::new(codes::BAD_CHOICE, "there is nothing to choose from")
        .at(&at.file, at.span(), "empty")
        .into()
}

/// Fewest and most of so many.
fn bounds(min: Option<u32>, max: Option<u32>, number: usize, place: &Place) -> Result<(u32, u32), Report> {
    let fewest = min.unwrap_or(0);
    let most = max.unwrap_or(u32::MAX).min(number as u32);
    let wrong = |key: &str, label: String| {
        let at = place.keys(&[key]);
        let found = Diagnostic::new(codes::BAD_CHOICE, "no choice keeps these bounds").at(&at.file, at.span(), label);
        Err(Report::from(found))
    };
    if max.is_some_and(|max| max < fewest) {
        return wrong("min", format!("more than the `max` of {}", max.unwrap_or(0)));
    }
    if fewest as usize > number {
        return wrong("min", format!("there are only {number}"));
    }
    Ok((fewest, most))
}
