//! Spaces multiplied out and judged one by one, as slowly and plainly as can be: what `space` is held against.
//! Nothing here is shared with it but the format and the manifests.

use shadewright_compiler::manifest::{Among, Arity, Filling, Node, ParamMode, Rule, Value, typed};
use shadewright_compiler::space::{Choice, Fits, FitsChoice, OPEN_DEPTH, Scale, SpaceFile, SpaceRule, Values};
use shadewright_compiler::{Catalog, Module};

/// A module with everything that stands in it.
#[derive(Clone, Debug)]
pub struct T {
    pub module: String,
    pub category: String,
    pub tags: Vec<String>,
    pub label: Option<String>,
    /// Frozen parameters.
    pub freeze: Vec<(String, Value)>,
    /// Slots with what stands in them; whether the recipe says so.
    pub slots: Vec<(String, Arity, bool, Vec<T>)>,
}

/// More trees than are worth judging one by one.
#[derive(Debug)]
pub struct TooMany;

pub struct Naive<'a> {
    pub catalog: &'a Catalog,
    pub most: usize,
}

#[derive(Clone)]
struct Place {
    interface: Option<(String, Arity)>,
    above: Vec<String>,
}

fn full(module: &Module) -> String {
    format!("{}/{}", module.category, module.name)
}

impl Naive<'_> {
    /// Every tree that the choices make, legal or not.
    pub fn trees(&self, file: &SpaceFile) -> Result<Vec<T>, TooMany> {
        let place = Place {
            interface: None,
            above: Vec::new(),
        };
        let all = self.choice(&file.root, &place)?;
        Ok(all.into_iter().map(|mut row| row.remove(0)).collect())
    }

    fn choice(&self, choice: &Choice, place: &Place) -> Result<Vec<Vec<T>>, TooMany> {
        let found = match choice {
            Choice::Node(node) => {
                let module = match &place.interface {
                    Some((interface, _)) => self.catalog.module(&format!("{interface}/{}", node.module)),
                    None => self.catalog.module(&node.module),
                };
                let module = module.unwrap_or_else(|report| panic!("{report}"));
                let written = |slot: &str| node.fill.get(slot).cloned();
                let trees = self.module(module, place, &written, None)?;
                let mut found: Vec<T> = trees
                    .into_iter()
                    .map(|mut t| {
                        t.tags.clone_from(&node.tags);
                        t.label.clone_from(&node.label);
                        t
                    })
                    .collect();
                for (name, param) in &module.manifest.params {
                    let Some(values) = node.freeze.get(name) else { continue };
                    let values: Vec<Value> = match values {
                        Values::One(value) => vec![value.clone()],
                        Values::Many(values) => values.clone(),
                        Values::Range(range) => {
                            assert_eq!(
                                (range.scale, range.step),
                                (Scale::Linear, None),
                                "the made-up spaces have no others"
                            );
                            let steps = range.steps.unwrap();
                            let value = |k| range.from + (range.to - range.from) * f64::from(k) / f64::from(steps);
                            (0..=steps).map(|k| Value::Number(value(k))).collect()
                        }
                    };
                    values.iter().for_each(|value| assert!(typed(param, value).is_ok()));
                    found = self.product(found, &values, |t, value| t.freeze.push((name.clone(), value.clone())))?;
                }
                found.into_iter().map(|t| vec![t]).collect()
            }
            Choice::List(list) => {
                let element = Place {
                    interface: place.interface.clone().map(|(interface, _)| (interface, Arity::Single)),
                    ..place.clone()
                };
                let mut rows = vec![Vec::new()];
                for choice in list {
                    let next = self.choice(choice, &element)?;
                    rows = self.product(rows, &next, |row, more| row.extend(more.iter().cloned()))?;
                }
                rows
            }
            Choice::OneOf(of) => {
                let mut all = Vec::new();
                for choice in of {
                    all.extend(self.choice(choice, place)?);
                }
                all
            }
            Choice::SomeOf { of, min, max } => {
                let mut all = Vec::new();
                for set in 0u32..1 << of.len() {
                    let number = set.count_ones();
                    if number >= min.unwrap_or(0) && number <= max.unwrap_or(u32::MAX) {
                        let chosen = (0..of.len()).filter(|k| set >> k & 1 == 1).map(|k| of[k].clone());
                        all.extend(self.choice(&Choice::List(chosen.collect()), place)?);
                    }
                }
                all
            }
            Choice::Fits(fits) => self.fits(fits, fits.depth.unwrap_or(OPEN_DEPTH), place)?,
        };
        if found.len() > self.most { Err(TooMany) } else { Ok(found) }
    }

    fn fits(&self, fits: &FitsChoice, depth: u32, place: &Place) -> Result<Vec<Vec<T>>, TooMany> {
        let (interface, arity) = match (&place.interface, &fits.of) {
            (Some(interface), _) => interface.clone(),
            (None, of) => (of.clone().unwrap(), Arity::Single),
        };
        let fitting = self.catalog.modules().filter(|m| m.category == interface);
        let fitting: Vec<&Module> = fitting
            .map(AsRef::as_ref)
            .filter(|m: &&Module| !fits.without.contains(&m.name) && !place.above.contains(&full(m)))
            .collect();
        let mut each = Vec::new();
        for module in &fitting {
            each.push(self.module(module, place, &|_| None, Some((fits, depth)))?);
        }
        let (min, max) = match arity {
            Arity::Single => (1, 1),
            Arity::Optional => (fits.min.unwrap_or(0), 1),
            Arity::List => (fits.min.unwrap_or(0), fits.max.unwrap_or(u32::MAX)),
        };
        let mut all = Vec::new();
        for set in 0u32..1 << fitting.len() {
            if !(min..=max).contains(&set.count_ones()) {
                continue;
            }
            let mut rows = vec![Vec::new()];
            for (_, trees) in each.iter().enumerate().filter(|(k, _)| set >> k & 1 == 1) {
                rows = self.product(rows, trees, |row: &mut Vec<T>, tree: &T| row.push(tree.clone()))?;
            }
            all.extend(rows);
        }
        Ok(all)
    }

    fn module(
        &self,
        module: &Module,
        place: &Place,
        written: &dyn Fn(&str) -> Option<Choice>,
        opening: Option<(&FitsChoice, u32)>,
    ) -> Result<Vec<T>, TooMany> {
        let mut trees = vec![T {
            module: module.name.clone(),
            category: module.category.clone(),
            tags: Vec::new(),
            label: None,
            freeze: Vec::new(),
            slots: Vec::new(),
        }];
        for (name, slot) in &module.manifest.slots {
            let inner = Place {
                interface: Some((slot.interface.clone(), slot.arity)),
                above: [place.above.as_slice(), &[full(module)]].concat(),
            };
            let (rows, said) = match (written(name), opening, &slot.default) {
                (Some(choice), ..) => (self.choice(&choice, &inner)?, true),
                (None, Some((fits, depth)), _) if fits.fits == Fits::Open && depth > 0 => {
                    let below = FitsChoice {
                        min: None,
                        max: None,
                        ..fits.clone()
                    };
                    (self.fits(&below, depth - 1, &inner)?, true)
                }
                (None, _, Some(default)) => (self.choice(&Choice::from(default), &inner)?, false),
                (None, Some((fits, _)), None) if slot.arity == Arity::Single => {
                    let below = FitsChoice {
                        fits: Fits::Defaults,
                        ..fits.clone()
                    };
                    (self.fits(&below, 0, &inner)?, true)
                }
                (None, ..) => (vec![Vec::new()], false),
            };
            trees = self.product(trees, &rows, |t, row| t.slots.push((name.clone(), slot.arity, said, row.clone())))?;
        }
        Ok(trees)
    }

    fn product<A: Clone, B>(&self, all: Vec<A>, with: &[B], join: impl Fn(&mut A, &B)) -> Result<Vec<A>, TooMany> {
        if all.len().saturating_mul(with.len()) > self.most {
            return Err(TooMany);
        }
        let mut found = Vec::new();
        for a in &all {
            for b in with {
                let mut a = a.clone();
                join(&mut a, b);
                found.push(a);
            }
        }
        Ok(found)
    }

    fn manifest(&self, t: &T) -> &Module {
        self.catalog
            .module(&format!("{}/{}", t.category, t.module))
            .unwrap_or_else(|report| panic!("{report}"))
    }

    /// Codes of what is wrong with a tree by the modules' own rules, and whether the space's rules keep it.
    pub fn judge(&self, tree: &T, rules: &[SpaceRule]) -> (Vec<&'static str>, bool) {
        let mut flat: Vec<(&T, Option<usize>)> = Vec::new();
        flatten(tree, None, &mut flat);
        let mut wrong = Vec::new();
        let mut kept = true;
        for (index, (t, _)) in flat.iter().enumerate() {
            for rule in &self.manifest(t).manifest.rules {
                let (tag, among, wanted) = match rule {
                    Rule::Requires { tag, among, .. } => (tag, among, true),
                    Rule::Excludes { tag, among, .. } => (tag, among, false),
                };
                if !self.holds(&flat, index, (tag, *among, wanted), false) {
                    wrong.push("SW0206");
                }
            }
            for rule in rules {
                let (when, tag, among, wanted) = match rule {
                    SpaceRule::Requires { when, tag, among, .. } => (when, tag, among, true),
                    SpaceRule::Excludes { when, tag, among, .. } => (when, tag, among, false),
                };
                let binds = when.as_ref().map_or(index == 0, |when| self.has(t, when, true));
                kept &= !binds || self.holds(&flat, index, (tag, *among, wanted), true);
            }
        }
        for (i, (a, _)) in flat.iter().enumerate() {
            for (b, _) in &flat[..i] {
                let same = a.label.is_some() && (&a.label, &a.module, &a.category) == (&b.label, &b.module, &b.category);
                if same && self.text(a) != self.text(b) {
                    wrong.push("SW0209");
                }
            }
        }
        (wrong, kept)
    }

    fn holds(&self, flat: &[(&T, Option<usize>)], index: usize, (tag, among, wanted): (&str, Among, bool), of_space: bool) -> bool {
        let parent = flat[index].1;
        if among == Among::Parent && parent.is_none() {
            return true;
        }
        let below = |mut other: usize| {
            while let Some(above) = flat[other].1 {
                if above == index {
                    return true;
                }
                other = above;
            }
            false
        };
        let found = (0..flat.len()).any(|other| {
            let there = match among {
                Among::Parent => parent == Some(other),
                Among::Children => below(other),
                Among::Tree => other != index,
            };
            there && self.has(flat[other].0, tag, of_space)
        });
        found == wanted
    }

    fn has(&self, t: &T, tag: &str, of_space: bool) -> bool {
        let manifest = &self.manifest(t).manifest;
        let role = manifest.instances.values().any(|field| field.role.as_deref() == Some(tag));
        let by_itself = t.module == tag || t.category == tag || manifest.properties.iter().any(|p| p == tag) || role;
        by_itself || of_space && t.tags.iter().any(|own| own == tag)
    }

    /// A text that is equal for equal trees: defaults written out, as the compiler compares subtrees.
    pub fn text(&self, t: &T) -> String {
        let mut text = format!("{}/{}#{:?}(", t.category, t.module, t.label);
        for (name, param) in &self.manifest(t).manifest.params {
            let frozen = t.freeze.iter().find(|(frozen, _)| frozen == name).map(|(_, value)| value);
            let value = frozen.or_else(|| (param.mode == ParamMode::Constant).then_some(&param.default));
            if let Some(value) = value {
                text += &format!("{name}={:?} ", typed(param, value).unwrap());
            }
        }
        for (name, _, _, inner) in &t.slots {
            text += &format!("{name}[{}] ", inner.iter().map(|t| self.text(t)).collect::<Vec<_>>().join(" "));
        }
        text + ")"
    }

    /// The same for a recipe.
    pub fn text_of(&self, node: &Node) -> String {
        let mut file = SpaceFile::parse("recipe", "x").unwrap();
        file.root = Choice::from(node);
        let trees = self.trees(&file).unwrap();
        assert_eq!(trees.len(), 1);
        self.text(&trees[0])
    }

    /// The recipe of a tree.
    pub fn recipe(&self, t: &T) -> Node {
        let mut node = Node::new(&t.module);
        node.label.clone_from(&t.label);
        node.freeze.extend(t.freeze.iter().cloned());
        for (name, arity, said, inner) in &t.slots {
            let mut nodes: Vec<Node> = inner.iter().map(|t| self.recipe(t)).collect();
            let filling = if *arity != Arity::List && nodes.len() == 1 {
                Filling::One(nodes.remove(0))
            } else {
                Filling::Many(nodes)
            };
            if *said {
                node.fill.insert(name.clone(), filling);
            }
        }
        node
    }
}

fn flatten<'t>(tree: &'t T, parent: Option<usize>, flat: &mut Vec<(&'t T, Option<usize>)>) {
    flat.push((tree, parent));
    let index = flat.len() - 1;
    for t in tree.slots.iter().flat_map(|(.., inner)| inner) {
        flatten(t, Some(index), flat);
    }
}
