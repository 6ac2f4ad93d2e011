//! What the rest of a tree must know of a part of it.
//!
//! Two fillings of a slot that the rules, the limits and the labels cannot tell apart have one signature; permutations are counted by
//! signatures, not one by one.

use std::collections::HashMap;

/// A signature by number. Numbers are given in the order in which signatures are first met, which the space's text alone decides.
pub type SigId = u32;

/// The signature of nothing.
pub const NOTHING: SigId = 0;

/// What a rule, limit or label can see of a part of a tree.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Signature {
    /// How many modules have each watched tag, 2 standing for more.
    pub tags: Vec<u8>,
    /// Demands on the whole tree, ascending.
    pub demands: Vec<u16>,
    /// How much of each limited thing is declared.
    pub amounts: Vec<u32>,
    /// Labelled subtrees whose label may stand elsewhere too: label and shape, ascending.
    pub labels: Vec<(u32, u32)>,
    /// Shapes of the modules, in order, where a label makes them matter.
    pub shape: Vec<u32>,
}

/// A demand that a module makes on all other modules of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Demand {
    /// Index of the watched tag.
    pub tag: usize,
    /// Whether something must have it, or nothing may.
    pub wanted: bool,
    /// The number of modules from which on the tag is there: one more where the demanding module has it itself.
    pub from: u8,
}

/// Shape of a module with all below it, where equality matters.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Shape {
    /// A parameter's value.
    Value(String),
    /// What stands in a slot, or a parameter's value, by position.
    Part(usize, Vec<u32>),
    /// A module: its name and label, and its parts.
    Module(String, Vec<u32>),
}

/// What is watched, and all signatures met so far.
#[derive(Clone, Debug)]
pub struct Signatures {
    /// Demands by number.
    pub demands: Vec<Demand>,
    /// Limits of the amounts.
    pub limits: Vec<u32>,
    list: Vec<Signature>,
    known: HashMap<Signature, SigId>,
    shapes: HashMap<Shape, u32>,
    sums: HashMap<(SigId, SigId), Option<SigId>>,
    wrapped: HashMap<(usize, SigId), Option<SigId>>,
    enclosed: HashMap<(usize, SigId), SigId>,
}

impl Signatures {
    /// For so many watched tags and these limits.
    pub fn new(tags: usize, demands: Vec<Demand>, limits: Vec<u32>) -> Self {
        let nothing = Signature {
            tags: vec![0; tags],
            amounts: vec![0; limits.len()],
            ..Signature::default()
        };
        let mut signatures = Self {
            demands,
            limits,
            list: Vec::new(),
            known: HashMap::new(),
            shapes: HashMap::new(),
            sums: HashMap::new(),
            wrapped: HashMap::new(),
            enclosed: HashMap::new(),
        };
        signatures.number(nothing);
        signatures
    }

    /// The signature of a number.
    pub fn get(&self, id: SigId) -> &Signature {
        &self.list[id as usize]
    }

    /// Whether nothing could be told apart from nothing.
    pub fn only_nothing(&self) -> bool {
        self.list.len() == 1
    }

    /// The number of a signature.
    pub fn number(&mut self, signature: Signature) -> SigId {
        if let Some(&id) = self.known.get(&signature) {
            return id;
        }
        let id = self.list.len() as SigId;
        self.known.insert(signature.clone(), id);
        self.list.push(signature);
        id
    }

    /// The number of a shape.
    pub fn shape(&mut self, shape: Shape) -> u32 {
        let next = self.shapes.len() as u32;
        *self.shapes.entry(shape).or_insert(next)
    }

    /// Two parts of one tree; `None` where they cannot stand together.
    pub fn sum(&mut self, a: SigId, b: SigId) -> Option<SigId> {
        if a == NOTHING {
            return Some(b);
        }
        if b == NOTHING {
            return Some(a);
        }
        if let Some(&sum) = self.sums.get(&(a, b)) {
            return sum;
        }
        let sum = self.add(self.get(a), self.get(b)).map(|sum| self.number(sum));
        self.sums.insert((a, b), sum);
        sum
    }

    /// As [`Signatures::sum`], of signatures whose sum was asked for before.
    pub fn known_sum(&self, a: SigId, b: SigId) -> Option<SigId> {
        match (a, b) {
            (NOTHING, other) | (other, NOTHING) => Some(other),
            pair => self.sums.get(&pair).copied().flatten(),
        }
    }

    fn add(&self, a: &Signature, b: &Signature) -> Option<Signature> {
        let tags: Vec<u8> = a.tags.iter().zip(&b.tags).map(|(x, y)| (x + y).min(2)).collect();
        let amounts: Vec<u32> = a.amounts.iter().zip(&b.amounts).map(|(x, y)| x.saturating_add(*y)).collect();
        if amounts.iter().zip(&self.limits).any(|(amount, limit)| amount > limit) {
            return None;
        }
        let mut demands = [a.demands.as_slice(), b.demands.as_slice()].concat();
        demands.sort_unstable();
        demands.dedup();
        // What is there already does not go away: an exclusion fails as soon as it does.
        let excluded = |&demand: &u16| {
            let Demand { tag, wanted, from } = self.demands[demand as usize];
            !wanted && tags[tag] >= from
        };
        if demands.iter().any(excluded) {
            return None;
        }
        let mut labels = [a.labels.as_slice(), b.labels.as_slice()].concat();
        labels.sort_unstable();
        labels.dedup();
        if labels.windows(2).any(|pair| pair[0].0 == pair[1].0) {
            return None;
        }
        Some(Signature {
            tags,
            demands,
            amounts,
            labels,
            shape: [a.shape.as_slice(), b.shape.as_slice()].concat(),
        })
    }

    /// Whether a whole tree of this signature lacks nothing that it demands.
    pub fn complete(&self, id: SigId) -> bool {
        let signature = self.get(id);
        signature.demands.iter().all(|&demand| {
            let Demand { tag, wanted, from } = self.demands[demand as usize];
            !wanted || signature.tags[tag] >= from
        })
    }

    /// A module around what stands in its slots; `None` where one of its rules forbids that.
    pub fn wrap(&mut self, expr: usize, own: &Own, inside: SigId) -> Option<SigId> {
        if let Some(&known) = self.wrapped.get(&(expr, inside)) {
            return known;
        }
        let wrapped = self.wrap_new(own, inside);
        self.wrapped.insert((expr, inside), wrapped);
        wrapped
    }

    /// As [`Signatures::wrap`], where it was asked for before.
    pub fn known_wrap(&self, expr: usize, inside: SigId) -> Option<SigId> {
        self.wrapped.get(&(expr, inside)).copied().flatten()
    }

    fn wrap_new(&mut self, own: &Own, inside: SigId) -> Option<SigId> {
        let below = self.get(inside);
        if own.children.iter().any(|&(tag, wanted)| (below.tags[tag] > 0) != wanted) {
            return None;
        }
        let outer = Signature {
            shape: Vec::new(),
            ..below.clone()
        };
        let mut mine = Signature {
            tags: own.tags.clone(),
            demands: own.demands.clone(),
            amounts: own.amounts.clone(),
            ..Signature::default()
        };
        if let Some(name) = &own.exact {
            let parts = self.get(inside).shape.clone();
            let shape = self.shape(Shape::Module(name.clone(), parts));
            mine.shape.push(shape);
            mine.labels.extend(own.label.map(|label| (label, shape)));
        }
        let sum = self.add(&outer, &mine)?;
        Some(self.number(sum))
    }

    /// What stands in a part of a module whose shape matters.
    pub fn enclose(&mut self, part: usize, inside: SigId) -> SigId {
        if let Some(&known) = self.enclosed.get(&(part, inside)) {
            return known;
        }
        let mut signature = self.get(inside).clone();
        let shape = self.shape(Shape::Part(part, std::mem::take(&mut signature.shape)));
        signature.shape.push(shape);
        let id = self.number(signature);
        self.enclosed.insert((part, inside), id);
        id
    }

    /// As [`Signatures::enclose`], where it was asked for before.
    pub fn known_enclosed(&self, part: usize, inside: SigId) -> SigId {
        self.enclosed.get(&(part, inside)).copied().unwrap_or(inside)
    }

    /// As [`Signatures::value`], where it was asked for before.
    pub fn known_value(&self, text: &str) -> SigId {
        let shape = self.shapes.get(&Shape::Value(text.to_owned()));
        let signature = shape.map(|&shape| Signature {
            shape: vec![shape],
            ..self.get(NOTHING).clone()
        });
        signature.and_then(|s| self.known.get(&s).copied()).unwrap_or(NOTHING)
    }

    /// A parameter's value, where it matters.
    pub fn value(&mut self, text: &str) -> SigId {
        let shape = self.shape(Shape::Value(text.to_owned()));
        let mut signature = self.get(NOTHING).clone();
        signature.shape.push(shape);
        self.number(signature)
    }
}

/// What a module adds to the signature of what stands in its slots.
#[derive(Clone, Debug, Default)]
pub struct Own {
    /// Watched tags that it has.
    pub tags: Vec<u8>,
    /// Its demands on the whole tree, ascending.
    pub demands: Vec<u16>,
    /// What it declares of limited things.
    pub amounts: Vec<u32>,
    /// Watched tags that must, or must not, be found below it.
    pub children: Vec<(usize, bool)>,
    /// Its name and label, where its shape matters.
    pub exact: Option<String>,
    /// Its label, where that may stand elsewhere too.
    pub label: Option<u32>,
}
