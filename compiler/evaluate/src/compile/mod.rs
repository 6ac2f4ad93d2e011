//! From a validated module to a program: global variables get their places, functions their code, callees first.

mod call;
mod expression;
mod function;
mod image;
mod pointer;

use std::cell::OnceCell;
use std::rc::Rc;

use naga::valid::ModuleInfo;
use naga::{AddressSpace, Expression, Handle, ImageClass, Literal, Module, Override, Scalar, ScalarKind, Type, TypeInner};

use crate::code::{At, Bound, Cell, ImageUse, Input, Limits, Op, Pointer, Program, Resource, Source, Table};
use crate::error::{EvaluateError, unsupported};
use crate::kind::Counts;
use crate::tree::{Leaf, Tree};
use function::Frame;

/// Where a value or a variable stands.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place {
    /// Nowhere yet.
    Nothing,
    /// What cannot be evaluated, by number of its error.
    Trap(u32),
    /// A value's numbers.
    Value(At),
    /// A variable or a part of it, at a place that is known.
    Fixed(At),
    /// A variable or a part of it: a pointer's cell, and numbers to go on from there.
    Behind(At, u32),
}

/// A compilation under way.
pub(crate) struct Compiler<'a> {
    pub module: &'a Module,
    pub info: &'a ModuleInfo,
    pub limits: Limits,
    pub code: Vec<Op>,
    pub memory: Vec<Cell>,
    pub tables: Vec<Table>,
    pub images: Vec<ImageUse>,
    pub traps: Vec<EvaluateError>,
    pub tallies: Vec<Counts>,
    pub bound: Vec<Bound>,
    /// Places of global variables, constants, pipeline constants and their expressions.
    pub globals: Vec<Place>,
    pub constants: Vec<Place>,
    pub overrides: Vec<Place>,
    /// Values of pipeline constants, where they are known numbers: the lengths of arrays.
    pub numbers: Vec<Option<f64>>,
    pub functions: Vec<Frame>,
    /// Places of the expressions of constants.
    pub global_expressions: Vec<Place>,
    /// Trees of types, made when they are asked for.
    trees: Vec<OnceCell<Result<Rc<Tree>, EvaluateError>>>,
}

impl Program {
    /// Compiles an entry point of a module that naga's validator accepted, with what it found out. `constants` are values of
    /// pipeline constants by `@id`, or by name where they have none. `numbers` of the limits is kept here, `steps` by each run.
    ///
    /// What cannot be evaluated (derivatives, subgroups, 64-bit types ...) is an error of the run that comes to it.
    ///
    /// # Errors
    /// There is no such entry point, a pipeline constant is unknown, lacks a value, or cannot hold it, or variables are too large.
    pub fn new(
        module: &Module,
        info: &ModuleInfo,
        entry: &str,
        constants: &[(String, f64)],
        limits: Limits,
    ) -> Result<Self, EvaluateError> {
        let index = module.entry_points.iter().position(|e| e.name == entry);
        let index = index.ok_or_else(|| EvaluateError::NoEntryPoint(entry.to_owned()))?;
        let mut compiler = Compiler {
            module,
            info,
            limits,
            code: Vec::new(),
            memory: Vec::new(),
            tables: Vec::new(),
            images: Vec::new(),
            traps: Vec::new(),
            tallies: Vec::new(),
            bound: Vec::new(),
            globals: Vec::new(),
            constants: vec![Place::Nothing; module.constants.len()],
            overrides: vec![Place::Nothing; module.overrides.len()],
            numbers: vec![None; module.overrides.len()],
            functions: Vec::new(),
            global_expressions: Vec::new(),
            trees: vec![OnceCell::new(); module.types.len()],
        };
        compiler.constants(constants)?;
        compiler.globals()?;
        for (handle, function) in module.functions.iter() {
            let frame = compiler.function(function, &info[handle])?;
            compiler.functions.push(frame);
        }
        let point = &module.entry_points[index];
        let init = compiler.code.len();
        let entry_tallies = compiler.tallies.len();
        compiler.initialise_globals();
        let frame = compiler.function(&point.function, info.get_entry_point(index))?;
        let inputs = compiler.inputs(&point.function, &frame)?;
        let result = match &point.function.result {
            Some(result) => compiler.tree(result.ty).ok().map(|tree| (frame.result, (*tree).clone())),
            None => None,
        };
        Ok(Self {
            limits,
            code: compiler.code,
            entry: u32::try_from(init).unwrap_or(u32::MAX),
            constants: 0,
            memory: compiler.memory,
            tables: compiler.tables,
            images: compiler.images,
            traps: compiler.traps,
            tallies: compiler.tallies,
            entry_tallies,
            bound: compiler.bound,
            inputs,
            result,
            workgroup_size: point.workgroup_size,
        })
    }
}

impl Compiler<'_> {
    /// The tree of a type.
    pub fn tree(&self, ty: Handle<Type>) -> Result<Rc<Tree>, EvaluateError> {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
        let pending = |handle: Handle<Override>| self.numbers[handle.index()].map(|x| x as u32).filter(|x| *x > 0);
        let make = || Tree::new(self.module, ty, self.limits.numbers, &pending).map(Rc::new);
        self.trees[ty.index()].get_or_init(make).clone()
    }

    /// Numbers of a value of a type.
    pub fn len(&self, inner: &TypeInner) -> Result<u32, EvaluateError> {
        Ok(match *inner {
            TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => Leaf::of(scalar).map(|_| 1)?,
            TypeInner::Vector { size, scalar } => Leaf::of(scalar).map(|_| size as u32)?,
            TypeInner::Matrix { columns, rows, scalar } => Leaf::of(scalar).map(|_| columns as u32 * rows as u32)?,
            TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } | TypeInner::Image { .. } | TypeInner::Sampler { .. } => 1,
            _ => {
                let known = self.module.types.iter().find(|(_, ty)| ty.inner == *inner);
                let (handle, _) = known.ok_or_else(|| unsupported("a value of an unknown type"))?;
                self.tree(handle)?.len()
            }
        })
    }

    /// Numbers of a value of a declared type.
    pub fn len_of(&self, ty: Handle<Type>) -> Result<u32, EvaluateError> {
        match self.module.types[ty].inner {
            TypeInner::Struct { .. } | TypeInner::Array { .. } => Ok(self.tree(ty)?.len()),
            ref inner => self.len(inner),
        }
    }

    /// Room for so many numbers.
    pub fn alloc(&mut self, n: u32) -> Result<At, EvaluateError> {
        self.put(std::iter::repeat_n(Cell::Uint(0), n as usize), n as usize)
    }

    /// Room for a variable, zero.
    pub fn variable(&mut self, ty: Handle<Type>) -> Result<(At, u32), EvaluateError> {
        let mut leaves = Vec::new();
        self.tree(ty)?.leaves(0, &mut leaves);
        let n = leaves.len();
        let at = self.put(leaves.into_iter().map(Cell::zero), n)?;
        Ok((at, u32::try_from(n).unwrap_or(u32::MAX)))
    }

    /// Room with these numbers.
    pub fn put(&mut self, cells: impl Iterator<Item = Cell>, n: usize) -> Result<At, EvaluateError> {
        let at = self.memory.len();
        if at + n > self.limits.numbers {
            return Err(EvaluateError::TooLarge {
                what: "the program".to_owned(),
                limit: self.limits.numbers,
            });
        }
        self.memory.extend(cells.take(n));
        u32::try_from(at).map_err(|_| EvaluateError::TooLarge {
            what: "the program".to_owned(),
            limit: self.limits.numbers,
        })
    }

    /// The number of an error.
    pub fn trap(&mut self, error: EvaluateError) -> u32 {
        let found = self.traps.iter().position(|known| *known == error);
        let index = found.unwrap_or_else(|| {
            self.traps.push(error);
            self.traps.len() - 1
        });
        u32::try_from(index).unwrap_or(u32::MAX)
    }

    /// A literal's cell.
    pub fn literal(&mut self, literal: Literal) -> Result<At, EvaluateError> {
        #[allow(clippy::cast_possible_truncation)] // abstract literals that reach the IR are values of f32 and i32
        let cell = match literal {
            Literal::F32(x) => Cell::Float(x),
            Literal::AbstractFloat(x) => Cell::Float(x as f32),
            Literal::I32(x) => Cell::Int(x),
            Literal::AbstractInt(x) => Cell::Int(x as i32),
            Literal::U32(x) => Cell::Uint(x),
            Literal::Bool(x) => Cell::Bool(x),
            Literal::F64(_) => return Err(unsupported("the type f64")),
            Literal::F16(_) => return Err(unsupported("the type f16")),
            Literal::U64(_) => return Err(unsupported("the type u64")),
            Literal::I64(_) => return Err(unsupported("the type i64")),
            Literal::U16(_) => return Err(unsupported("the type u16")),
            Literal::I16(_) => return Err(unsupported("the type i16")),
        };
        self.put([cell].into_iter(), 1)
    }

    /// Constants and pipeline constants: code that runs once. An expression comes after those that it is made of.
    fn constants(&mut self, given: &[(String, f64)]) -> Result<(), EvaluateError> {
        let module = self.module;
        let key = |o: &Override| o.id.map_or_else(|| o.name.clone().unwrap_or_default(), |id| id.to_string());
        if let Some((unknown, _)) = given
            .iter()
            .find(|(name, _)| !module.overrides.iter().any(|(_, o)| key(o) == *name))
        {
            return Err(EvaluateError::NoOverride(unknown.clone()));
        }
        for (handle, constant) in module.overrides.iter() {
            let name = key(constant);
            let value = given.iter().find(|(given, _)| *given == name);
            if let Some((_, value)) = value {
                let TypeInner::Scalar(scalar) = module.types[constant.ty].inner else {
                    continue;
                };
                let cell = override_cell(scalar, *value).map_err(|why| EvaluateError::Override { name, why })?;
                let at = self.put([cell].into_iter(), 1)?;
                self.overrides[handle.index()] = Place::Value(at);
                self.numbers[handle.index()] = Some(*value);
            } else if let Some(init) = constant.init {
                self.numbers[handle.index()] = literal_number(&module.global_expressions[init]);
            }
        }
        let places = self.constant_expressions()?;
        self.code.push(Op::Return);
        for (handle, constant) in module.constants.iter() {
            self.constants[handle.index()] = places[constant.init.index()];
        }
        for (handle, constant) in module.overrides.iter() {
            if let (Place::Nothing, Some(init)) = (self.overrides[handle.index()], constant.init) {
                self.overrides[handle.index()] = places[init.index()];
            }
            if let Place::Nothing = self.overrides[handle.index()] {
                let why = "has no value".to_owned();
                return Err(EvaluateError::Override { name: key(constant), why });
            }
        }
        Ok(())
    }

    /// Places of global variables.
    fn globals(&mut self) -> Result<(), EvaluateError> {
        let module = self.module;
        for (_, variable) in module.global_variables.iter() {
            let place = self.global(variable);
            let place = match place {
                Err(error @ EvaluateError::TooLarge { .. }) => return Err(error),
                Err(error) => Place::Trap(self.trap(error)),
                Ok(place) => place,
            };
            self.globals.push(place);
        }
        Ok(())
    }

    fn global(&mut self, variable: &naga::GlobalVariable) -> Result<Place, EvaluateError> {
        let name = variable.name.clone().unwrap_or_default();
        let inner = &self.module.types[variable.ty].inner;
        let resource = match variable.space {
            AddressSpace::Private | AddressSpace::WorkGroup => return Ok(Place::Fixed(self.variable(variable.ty)?.0)),
            AddressSpace::Uniform | AddressSpace::Storage { .. } => Resource::Buffer((*self.tree(variable.ty)?).clone()),
            AddressSpace::Handle => match *inner {
                TypeInner::Image { dim, class, .. } => Resource::Texture {
                    is_depth: matches!(class, ImageClass::Depth { .. }),
                    // Bytes of ones, in the type that they have there; the far plane of depth.
                    white: match class {
                        ImageClass::Sampled {
                            kind: ScalarKind::Uint, ..
                        } => 255.0,
                        ImageClass::Sampled {
                            kind: ScalarKind::Sint, ..
                        } => -1.0,
                        _ => 1.0,
                    },
                    layers: if dim == naga::ImageDimension::Cube { 6 } else { 1 },
                },
                TypeInner::Sampler { .. } => Resource::Sampler,
                TypeInner::BindingArray { .. } => return Err(unsupported("an array of bindings")),
                _ => return Err(unsupported("a ray query")),
            },
            AddressSpace::Function => return Err(unsupported("a variable outside of its function")),
            AddressSpace::Immediate => return Err(unsupported("an immediate")),
            AddressSpace::TaskPayload => return Err(unsupported("a mesh shader's payload")),
            AddressSpace::RayPayload | AddressSpace::IncomingRayPayload => return Err(unsupported("a ray's payload")),
        };
        let Some(binding) = &variable.binding else {
            return Err(unsupported(format!("`{name}`, which has no binding,")));
        };
        let (cell, place): (Cell, fn(At) -> Place) = match resource {
            Resource::Buffer(_) => (Cell::Pointer(Pointer { at: 0, elements: 0 }), |at| Place::Behind(at, 0)),
            _ => (Cell::Uint(u32::try_from(self.bound.len()).unwrap_or(u32::MAX)), Place::Value),
        };
        let at = self.put([cell].into_iter(), 1)?;
        self.bound.push(Bound {
            name,
            group: binding.group,
            binding: binding.binding,
            at,
            resource,
        });
        Ok(place(at))
    }

    /// Code that gives private and workgroup variables what they start with.
    fn initialise_globals(&mut self) {
        let module = self.module;
        for (handle, variable) in module.global_variables.iter() {
            let (Place::Fixed(at), Ok(n)) = (self.globals[handle.index()], self.len_of(variable.ty)) else {
                continue;
            };
            self.code
                .push(match variable.init.map(|init| self.global_expressions[init.index()]) {
                    Some(Place::Value(from)) => Op::Copy { to: at, from, n },
                    Some(Place::Trap(trap)) => Op::Trap(trap),
                    _ => Op::Clear { to: at, n },
                });
        }
    }

    /// Inputs of an entry point.
    fn inputs(&self, function: &naga::Function, frame: &Frame) -> Result<Vec<Input>, EvaluateError> {
        let mut inputs = Vec::new();
        let mut add = |binding: &Option<naga::Binding>, at: At, ty: Handle<Type>| -> Result<u32, EvaluateError> {
            let mut leaves = Vec::new();
            self.tree(ty)?.leaves(0, &mut leaves);
            let n = u32::try_from(leaves.len()).unwrap_or(u32::MAX);
            let source = match binding {
                Some(naga::Binding::BuiltIn(builtin)) => Source::BuiltIn(*builtin),
                Some(naga::Binding::Location { location, .. }) => Source::Location(*location),
                None => return Ok(n),
            };
            inputs.push(Input { at, source, leaves });
            Ok(n)
        };
        for (argument, at) in function.arguments.iter().zip(&frame.arguments) {
            match &self.module.types[argument.ty].inner {
                TypeInner::Struct { members, .. } if argument.binding.is_none() => {
                    let mut at = *at;
                    for member in members {
                        at += add(&member.binding, at, member.ty)?;
                    }
                }
                _ => {
                    add(&argument.binding, *at, argument.ty)?;
                }
            }
        }
        Ok(inputs)
    }
}

/// A pipeline constant's value in its type.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the ranges are checked
fn override_cell(scalar: Scalar, value: f64) -> Result<Cell, String> {
    let whole = value.fract() == 0.0;
    match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) if (value as f32).is_finite() => Ok(Cell::Float(value as f32)),
        (ScalarKind::Sint, 4) if whole && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&value) => Ok(Cell::Int(value as i32)),
        (ScalarKind::Uint, 4) if whole && (0.0..=f64::from(u32::MAX)).contains(&value) => Ok(Cell::Uint(value as u32)),
        (ScalarKind::Bool, _) => Ok(Cell::Bool(value != 0.0 && !value.is_nan())),
        _ => Err(format!("cannot be {value}")),
    }
}

fn literal_number(expression: &Expression) -> Option<f64> {
    match *expression {
        Expression::Literal(Literal::I32(x)) => Some(f64::from(x)),
        Expression::Literal(Literal::U32(x)) => Some(f64::from(x)),
        _ => None,
    }
}
