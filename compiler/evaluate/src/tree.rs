//! Types as evaluations see them: every value is a flat list of numbers, in the order of its members.

use naga::{ArraySize, Handle, Module, Scalar, ScalarKind, Type, TypeInner};

use crate::error::{EvaluateError, unsupported};

/// Nesting of types that is followed. WGSL allows 15 levels.
const DEEPEST: u32 = 64;
/// Most parts of a tree; members that are structs count with all of theirs.
const MOST_NODES: u64 = 1 << 16;

/// What one number is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Leaf {
    Float,
    Int,
    Uint,
    Bool,
}

impl Leaf {
    /// Of a scalar type that can be evaluated.
    pub fn of(scalar: Scalar) -> Result<Self, EvaluateError> {
        Ok(match (scalar.kind, scalar.width) {
            (ScalarKind::Float, 4) => Self::Float,
            (ScalarKind::Sint, 4) => Self::Int,
            (ScalarKind::Uint, 4) => Self::Uint,
            (ScalarKind::Bool, _) => Self::Bool,
            (kind, width) => {
                let letter = match kind {
                    ScalarKind::Float | ScalarKind::AbstractFloat => 'f',
                    ScalarKind::Sint | ScalarKind::AbstractInt => 'i',
                    _ => 'u',
                };
                return Err(unsupported(format!("the type {letter}{}", u32::from(width) * 8)));
            }
        })
    }
}

/// A type with the places of its parts, in numbers and in bytes.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    /// A number.
    Scalar(Leaf),
    /// Members of a struct, components of a vector, columns of a matrix: name, byte, part.
    Parts(Vec<(String, u32, Tree)>),
    /// Elements; without a count, as many as the buffer holds.
    Array {
        element: Box<Tree>,
        stride: u32,
        count: Option<u32>,
    },
}

impl Tree {
    /// The tree of a type. `pending` gives the lengths of arrays that pipeline constants decide; no more than `limit` numbers are taken.
    pub fn new(
        module: &Module,
        ty: Handle<Type>,
        limit: usize,
        pending: &dyn Fn(Handle<naga::Override>) -> Option<u32>,
    ) -> Result<Self, EvaluateError> {
        let too_large = || EvaluateError::TooLarge {
            what: module.types[ty].name.clone().unwrap_or_else(|| "a type".to_owned()),
            limit,
        };
        // Types come after those they are made of: the sizes of all up to this one, without recursion. Members that repeat double
        // a tree at each level, so the size is known before the tree is made.
        let mut sizes: Vec<u64> = Vec::with_capacity(ty.index() + 1);
        let mut nodes: Vec<u64> = Vec::with_capacity(ty.index() + 1);
        for (handle, ty) in module.types.iter().take(ty.index() + 1) {
            let of = |list: &[u64], part: Handle<Type>| if part < handle { list[part.index()] } else { u64::MAX };
            let (size, node) = match ty.inner {
                TypeInner::Struct { ref members, .. } => {
                    let sum = |list: &[u64]| members.iter().fold(1, |sum: u64, m| sum.saturating_add(of(list, m.ty)));
                    (sum(&sizes), sum(&nodes))
                }
                // An array's element stands once in a tree, and all its numbers in memory.
                TypeInner::Array { base, size, .. } => {
                    let count = match size {
                        ArraySize::Constant(count) => u64::from(count.get()),
                        ArraySize::Pending(handle) => u64::from(pending(handle).unwrap_or(1)),
                        ArraySize::Dynamic => 1,
                    };
                    (of(&sizes, base).saturating_mul(count), of(&nodes, base).saturating_add(1))
                }
                TypeInner::Matrix { .. } => (16, 21),
                _ => (4, 5),
            };
            sizes.push(size);
            nodes.push(node);
        }
        if sizes[ty.index()] > limit as u64 || nodes[ty.index()] > MOST_NODES {
            return Err(too_large());
        }
        Self::build(module, &module.types[ty].inner, DEEPEST, pending)
    }

    fn build(
        module: &Module,
        inner: &TypeInner,
        depth: u32,
        pending: &dyn Fn(Handle<naga::Override>) -> Option<u32>,
    ) -> Result<Self, EvaluateError> {
        let Some(deeper) = depth.checked_sub(1) else {
            return Err(unsupported("a type nested so deep"));
        };
        Ok(match *inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Self::Scalar(Leaf::of(scalar)?),
            TypeInner::Vector { size, scalar } => Self::vector(size as u32, Leaf::of(scalar)?),
            TypeInner::Matrix { columns, rows, scalar } => {
                let leaf = Leaf::of(scalar)?;
                let stride = if rows as u32 == 2 { 8 } else { 16 };
                Self::Parts(
                    (0..columns as u32)
                        .map(|c| (format!("[{c}]"), c * stride, Self::vector(rows as u32, leaf)))
                        .collect(),
                )
            }
            TypeInner::Array { base, size, stride } => Self::Array {
                element: Box::new(Self::build(module, &module.types[base].inner, deeper, pending)?),
                stride: stride.max(1),
                count: match size {
                    ArraySize::Constant(count) => Some(count.get()),
                    ArraySize::Pending(handle) => Some(pending(handle).ok_or_else(|| unsupported("an array without a length"))?),
                    ArraySize::Dynamic => None,
                },
            },
            TypeInner::Struct { ref members, .. } => {
                let part = |(i, m): (usize, &naga::StructMember)| {
                    let name = m.name.clone().unwrap_or_else(|| format!("member{i}"));
                    Ok((name, m.offset, Self::build(module, &module.types[m.ty].inner, deeper, pending)?))
                };
                Self::Parts(members.iter().enumerate().map(part).collect::<Result<_, _>>()?)
            }
            TypeInner::CooperativeMatrix { .. } => return Err(unsupported("a cooperative matrix")),
            TypeInner::AccelerationStructure { .. } | TypeInner::RayQuery { .. } => return Err(unsupported("a ray query")),
            TypeInner::BindingArray { .. } => return Err(unsupported("an array of bindings")),
            TypeInner::Image { .. } | TypeInner::Sampler { .. } | TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => {
                Self::Scalar(Leaf::Uint)
            }
        })
    }

    fn vector(size: u32, leaf: Leaf) -> Self {
        let part = |(i, name): (u32, &str)| (name.to_owned(), 4 * i, Self::Scalar(leaf));
        Self::Parts((0..size).zip(["x", "y", "z", "w"]).map(part).collect())
    }

    /// Numbers, those of a runtime-sized array not counted.
    pub fn len(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Parts(parts) => parts.iter().map(|(_, _, part)| part.len()).sum(),
            Self::Array { element, count, .. } => element.len() * count.unwrap_or(0),
        }
    }

    /// Numbers with this many elements in the runtime-sized array.
    pub fn len_with(&self, elements: u32) -> u64 {
        u64::from(self.len())
            + self
                .open()
                .map_or(0, |(element, ..)| u64::from(element.len()) * u64::from(elements))
    }

    /// The runtime-sized array at the end: its element, stride, and byte.
    pub fn open(&self) -> Option<(&Self, u32, u32)> {
        match self {
            Self::Array {
                element,
                stride,
                count: None,
            } => Some((element, *stride, 0)),
            Self::Parts(parts) => {
                let (_, offset, last) = parts.last()?;
                last.open().map(|(element, stride, at)| (element, stride, at + offset))
            }
            _ => None,
        }
    }

    /// Fewest bytes: to the last number's end, with one whole element in a runtime-sized array.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Scalar(_) => 4,
            Self::Parts(parts) => parts.iter().map(|(_, at, part)| u64::from(*at) + part.bytes()).max().unwrap_or(0),
            Self::Array { stride, count: None, .. } => u64::from(*stride),
            Self::Array {
                element,
                stride,
                count: Some(count),
            } => u64::from(count.saturating_sub(1)) * u64::from(*stride) + element.bytes(),
        }
    }

    /// Kinds of its numbers in order.
    pub fn leaves(&self, elements: u32, to: &mut Vec<Leaf>) {
        match self {
            Self::Scalar(leaf) => to.push(*leaf),
            Self::Parts(parts) => parts.iter().for_each(|(_, _, part)| part.leaves(elements, to)),
            Self::Array { element, count, .. } => {
                let start = to.len();
                element.leaves(elements, to);
                let end = to.len();
                match count.unwrap_or(elements) {
                    0 => to.truncate(start),
                    count => (1..count).for_each(|_| to.extend_from_within(start..end)),
                }
            }
        }
    }

    /// Names of its numbers in order: `x`, `diffuse.y`, `[3].z`; empty for a scalar.
    pub fn names(&self, elements: u32) -> Vec<String> {
        let mut names = Vec::new();
        self.name(elements, &mut String::new(), &mut names);
        names
    }

    fn name(&self, elements: u32, path: &mut String, to: &mut Vec<String>) {
        let own = path.len();
        match self {
            Self::Scalar(_) => to.push(path.clone()),
            Self::Parts(parts) => {
                for (name, _, part) in parts {
                    if own > 0 && !name.starts_with('[') {
                        path.push('.');
                    }
                    path.push_str(name);
                    part.name(elements, path, to);
                    path.truncate(own);
                }
            }
            Self::Array { element, count, .. } => {
                for i in 0..count.unwrap_or(elements) {
                    path.push_str(&format!("[{i}]"));
                    element.name(elements, path, to);
                    path.truncate(own);
                }
            }
        }
    }

    /// Gives every number with its bytes, in order; a number that the bytes end before is zero.
    pub fn decode(&self, bytes: &[u8], elements: u32, to: &mut impl FnMut(Leaf, [u8; 4])) {
        match self {
            Self::Scalar(leaf) => to(*leaf, bytes.first_chunk::<4>().copied().unwrap_or_default()),
            Self::Parts(parts) => {
                for (_, at, part) in parts {
                    part.decode(bytes.get(*at as usize..).unwrap_or_default(), elements, to);
                }
            }
            Self::Array { element, stride, count } => {
                for i in 0..count.unwrap_or(elements) as usize {
                    element.decode(bytes.get(i * *stride as usize..).unwrap_or_default(), elements, to);
                }
            }
        }
    }
}
