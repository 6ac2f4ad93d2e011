//! Runs a program with one number type.

mod integer;
mod math;
mod memory;
mod run;
mod sample;

use std::sync::Arc;

use crate::code::{Bound, Program, Resource, Source};
use crate::error::EvaluateError;
use crate::kind::Counts;
use crate::number::{Number, Truth};
use crate::texture::{Sampler, Texture};
use crate::tree::Leaf;
use memory::{Slot, slot_of};

/// A number that was read back, in its type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value<N> {
    /// f32 of the shader.
    Float(N),
    /// i32
    Int(i32),
    /// u32
    Uint(u32),
    /// bool
    Bool(bool),
}

impl<N: Number> Value<N> {
    /// As a number of the machine's; `true` is 1.
    pub fn number(self) -> N {
        match self {
            Self::Float(x) => x,
            Self::Int(x) => N::from_i32(x),
            Self::Uint(x) => N::from_u32(x),
            Self::Bool(x) => N::from_u32(u32::from(x)),
        }
    }
}

/// What one invocation of an entry point gets from its stage. What is left out is 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Invocation {
    /// Of a compute shader; the local and the workgroup's come from it.
    pub global_invocation_id: [u32; 3],
    /// Of a compute shader.
    pub num_workgroups: [u32; 3],
    /// Of a vertex shader.
    pub vertex_index: u32,
    /// Of a vertex shader.
    pub instance_index: u32,
    /// Of a fragment shader: place in the target in pixels, depth, and 1 / w.
    pub position: [f64; 4],
    /// Of a fragment shader.
    pub front_facing: bool,
    /// Inputs by location, with their components.
    pub locations: Vec<(u32, Vec<f64>)>,
}

impl Default for Invocation {
    fn default() -> Self {
        Self {
            global_invocation_id: [0; 3],
            num_workgroups: [1; 3],
            vertex_index: 0,
            instance_index: 0,
            position: [0.0; 4],
            front_facing: true,
            locations: Vec::new(),
        }
    }
}

/// A program with its memory. Storage buffers keep what a run writes; other variables start anew with each.
#[derive(Clone, Debug)]
pub struct Machine<'p, N> {
    program: &'p Program,
    memory: Vec<Slot<N>>,
    /// Numbers that a buffer has room for, by its place among the bound.
    room: Vec<usize>,
    textures: Vec<Option<Arc<Texture>>>,
    samplers: Vec<Sampler>,
    calls: Vec<u32>,
    visits: Vec<u64>,
    steps: u64,
    undecided: bool,
    discarded: bool,
}

impl<'p, N: Number> Machine<'p, N> {
    /// A machine with zeros in all buffers, white textures of one texel (depth 1), and samplers that take the nearest texel.
    ///
    /// # Errors
    /// The constants need too many steps, or buffers too much room.
    pub fn new(program: &'p Program) -> Result<Self, EvaluateError> {
        let mut machine = Self {
            program,
            memory: program.memory.iter().map(|cell| slot_of(*cell)).collect(),
            room: vec![0; program.bound.len()],
            textures: Vec::with_capacity(program.bound.len()),
            samplers: vec![Sampler::default(); program.bound.len()],
            calls: Vec::new(),
            visits: vec![0; program.tallies.len()],
            steps: 0,
            undecided: false,
            discarded: false,
        };
        for (index, bound) in program.bound.iter().enumerate() {
            let mut texture = None;
            match &bound.resource {
                Resource::Buffer(tree) => N::fill(&mut machine, index, &vec![0; usize::try_from(tree.bytes()).unwrap_or(0)])?,
                Resource::Texture { is_depth, white, layers } => texture = Some(Arc::new(Texture::stand_in(*is_depth, *white, *layers))),
                Resource::Sampler => {}
            }
            machine.textures.push(texture);
        }
        N::execute(&mut machine, program.constants)?;
        Ok(machine)
    }

    fn bound(&self, group: u32, binding: u32) -> Result<(usize, &'p Bound), EvaluateError> {
        let mut all = self.program.bound.iter().enumerate();
        all.find(|(_, b)| b.group == group && b.binding == binding)
            .ok_or(EvaluateError::NoBinding { group, binding })
    }

    /// Fills a buffer with bytes as a GPU gets them; a runtime-sized array has as many elements as they hold.
    ///
    /// # Errors
    /// There is no such binding, it is no buffer, or the bytes are fewer than its type takes.
    pub fn bind_buffer(&mut self, group: u32, binding: u32, bytes: &[u8]) -> Result<(), EvaluateError> {
        let (index, _) = self.bound(group, binding)?;
        N::fill(self, index, bytes)
    }

    /// Binds a texture.
    ///
    /// # Errors
    /// There is no such binding, or it is no texture.
    pub fn bind_texture(&mut self, group: u32, binding: u32, texture: Arc<Texture>) -> Result<(), EvaluateError> {
        let (index, bound) = self.bound(group, binding)?;
        let Resource::Texture { .. } = bound.resource else {
            return Err(other(bound, "texture"));
        };
        self.textures[index] = Some(texture);
        Ok(())
    }

    /// Binds a sampler.
    ///
    /// # Errors
    /// There is no such binding, or it is no sampler.
    pub fn bind_sampler(&mut self, group: u32, binding: u32, sampler: Sampler) -> Result<(), EvaluateError> {
        let (index, bound) = self.bound(group, binding)?;
        let Resource::Sampler = bound.resource else {
            return Err(other(bound, "sampler"));
        };
        self.samplers[index] = sampler;
        Ok(())
    }

    /// Runs the entry point once.
    ///
    /// # Errors
    /// It comes to something that cannot be evaluated, or does not end within the limits.
    pub fn run(&mut self, invocation: &Invocation) -> Result<(), EvaluateError> {
        self.undecided = false;
        self.discarded = false;
        self.visits.fill(0);
        let program = self.program;
        for input in &program.inputs {
            let size = program.workgroup_size.map(|size| size.max(1));
            let each = |f: fn(u32, u32) -> u32| std::array::from_fn::<u32, 3, _>(|i| f(invocation.global_invocation_id[i], size[i]));
            let whole = |list: &[u32]| list.iter().map(|x| f64::from(*x)).collect::<Vec<_>>();
            let numbers = match input.source {
                Source::Location(location) => invocation
                    .locations
                    .iter()
                    .find(|(l, _)| *l == location)
                    .map(|(_, list)| list.clone()),
                Source::BuiltIn(builtin) => match builtin {
                    naga::BuiltIn::GlobalInvocationId => Some(whole(&invocation.global_invocation_id)),
                    naga::BuiltIn::LocalInvocationId => Some(whole(&each(|id, size| id % size))),
                    naga::BuiltIn::LocalInvocationIndex => {
                        let [x, y, z] = each(|id, size| id % size);
                        Some(whole(&[
                            x.wrapping_add(size[0].wrapping_mul(y.wrapping_add(size[1].wrapping_mul(z))))
                        ]))
                    }
                    naga::BuiltIn::WorkGroupId => Some(whole(&each(|id, size| id / size))),
                    naga::BuiltIn::WorkGroupSize => Some(whole(&size)),
                    naga::BuiltIn::NumWorkGroups => Some(whole(&invocation.num_workgroups)),
                    naga::BuiltIn::VertexIndex => Some(whole(&[invocation.vertex_index])),
                    naga::BuiltIn::InstanceIndex => Some(whole(&[invocation.instance_index])),
                    naga::BuiltIn::Position { .. } => Some(invocation.position.to_vec()),
                    naga::BuiltIn::FrontFacing => Some(vec![f64::from(u8::from(invocation.front_facing))]),
                    _ => None,
                },
            };
            let numbers = numbers.unwrap_or_default();
            for (i, leaf) in input.leaves.iter().enumerate() {
                let number = numbers.get(i).copied().unwrap_or(0.0);
                self.memory[input.at as usize + i] = input_slot(*leaf, number);
            }
        }
        N::execute(self, program.entry)
    }

    /// Whether the last run hung on a comparison that another conforming driver may answer otherwise: then its results say nothing
    /// about theirs. Only [`crate::Allowed`] knows.
    pub fn is_undecided(&self) -> bool {
        self.undecided
    }

    /// Whether the last run ended in `discard`.
    pub fn is_discarded(&self) -> bool {
        self.discarded
    }

    /// Operations that the last run executed.
    pub fn executed(&self) -> Counts {
        self.counted(self.program.tallies.len())
    }

    /// Operations that the last run executed in functions, those in the entry point itself not counted.
    pub fn executed_in_functions(&self) -> Counts {
        self.counted(self.program.entry_tallies)
    }

    fn counted(&self, tallies: usize) -> Counts {
        let mut counts = Counts::default();
        for (tally, visits) in self.program.tallies.iter().zip(&self.visits).take(tallies) {
            counts += tally.times(*visits);
        }
        counts
    }

    /// What the entry point returned, number by number, with names.
    pub fn result(&self) -> Vec<(String, Value<N>)> {
        let Some((at, tree)) = &self.program.result else {
            return Vec::new();
        };
        let at = *at as usize;
        let values = self.memory[at..at + tree.len() as usize].iter().map(value);
        tree.names(0).into_iter().zip(values).collect()
    }

    /// A buffer's numbers with their names, as `[3].diffuse.y`.
    ///
    /// # Errors
    /// There is no such binding, or it is no buffer.
    pub fn read(&self, group: u32, binding: u32) -> Result<Vec<(String, Value<N>)>, EvaluateError> {
        let (_, bound) = self.bound(group, binding)?;
        let Resource::Buffer(tree) = &bound.resource else {
            return Err(other(bound, "buffer"));
        };
        let elements = self.pointer(bound.at).elements;
        Ok(tree.names(elements).into_iter().zip(self.values(group, binding)?).collect())
    }

    /// A buffer's numbers.
    ///
    /// # Errors
    /// There is no such binding, or it is no buffer.
    pub fn values(&self, group: u32, binding: u32) -> Result<Vec<Value<N>>, EvaluateError> {
        let (_, bound) = self.bound(group, binding)?;
        let Resource::Buffer(tree) = &bound.resource else {
            return Err(other(bound, "buffer"));
        };
        let pointer = self.pointer(bound.at);
        let len = usize::try_from(tree.len_with(pointer.elements)).unwrap_or(usize::MAX);
        Ok(self.memory.iter().skip(pointer.at as usize).take(len).map(value).collect())
    }
}

fn other(bound: &Bound, given: &'static str) -> EvaluateError {
    EvaluateError::OtherResource {
        name: bound.name.clone(),
        given,
    }
}

fn value<N: Number>(slot: &Slot<N>) -> Value<N> {
    match *slot {
        Slot::Float(x) => Value::Float(x),
        Slot::Int(x) => Value::Int(x),
        Slot::Uint(x) => Value::Uint(x),
        Slot::Bool(x) => Value::Bool(x.value),
        Slot::Pointer(_) => Value::Uint(0),
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates
fn input_slot<N: Number>(leaf: Leaf, number: f64) -> Slot<N> {
    match leaf {
        Leaf::Float => Slot::Float(N::from_f32(number as f32)),
        Leaf::Int => Slot::Int(number as i32),
        Leaf::Uint => Slot::Uint(number as u32),
        Leaf::Bool => Slot::Bool(Truth::sure(number != 0.0)),
    }
}
