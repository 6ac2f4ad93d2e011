//! Statements.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{Arena, Block, Expression, Function, Handle, Statement, SwitchValue, TypeInner};

use super::{Compiler, Place};
use crate::code::{At, Op, Table};
use crate::error::{EvaluateError, unsupported};
use crate::kind::{Counts, Kind, operations};
use crate::tree::Leaf;

/// Nesting of blocks that is followed.
const DEEPEST: u32 = 256;

/// A compiled function.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub entry: u32,
    pub arguments: Vec<At>,
    pub result: At,
    /// Why it can't be called.
    pub trap: Option<u32>,
}

/// Who knows the types of expressions.
#[derive(Clone, Copy)]
pub(crate) enum Types<'a> {
    Function(&'a FunctionInfo),
    Module(&'a ModuleInfo),
}

/// A loop or a switch, with the jumps that leave it.
struct Scope {
    is_loop: bool,
    breaks: Vec<usize>,
    continues: Vec<usize>,
}

/// A function under way.
pub(crate) struct Body<'a, 'b> {
    pub compiler: &'b mut Compiler<'a>,
    pub expressions: &'a Arena<Expression>,
    pub types: Types<'a>,
    pub places: Vec<Place>,
    pub locals: Vec<Place>,
    pub arguments: Vec<Place>,
    result: At,
    scopes: Vec<Scope>,
    /// The tally of the straight piece of code that is being written.
    tally: Option<usize>,
    depth: u32,
}

impl<'a> Compiler<'a> {
    /// Compiles a function behind the code so far.
    pub fn function(&mut self, function: &'a Function, info: &'a FunctionInfo) -> Result<Frame, EvaluateError> {
        let mut trap = None;
        let mut arguments = Vec::new();
        for argument in &function.arguments {
            arguments.push(match self.variable(argument.ty) {
                Ok((at, _)) => at,
                Err(error) => {
                    trap = Some(self.trap(error));
                    self.alloc(1)?
                }
            });
        }
        let result = match &function.result {
            None => 0,
            Some(result) => match self.variable(result.ty) {
                Ok((at, _)) => at,
                Err(error) => {
                    trap = Some(self.trap(error));
                    0
                }
            },
        };
        let frame = Frame {
            entry: self.here(),
            arguments,
            result,
            trap,
        };
        if let Some(trap) = trap {
            self.code.push(Op::Trap(trap));
            return Ok(frame);
        }
        let argument = |(argument, at): (&naga::FunctionArgument, &At)| match self.module.types[argument.ty].inner {
            TypeInner::Pointer { .. } | TypeInner::ValuePointer { .. } => Place::Behind(*at, 0),
            _ => Place::Value(*at),
        };
        let places = function.arguments.iter().zip(&frame.arguments).map(argument).collect();
        let mut body = Body {
            compiler: self,
            expressions: &function.expressions,
            types: Types::Function(info),
            places: vec![Place::Nothing; function.expressions.len()],
            locals: Vec::new(),
            arguments: places,
            result,
            scopes: Vec::new(),
            tally: None,
            depth: 0,
        };
        body.before(function)?;
        body.block(&function.body)?;
        body.compiler.code.push(Op::Return);
        Ok(frame)
    }

    /// Compiles the expressions of constants. What cannot be evaluated fails where it is used.
    pub fn constant_expressions(&mut self) -> Result<Vec<Place>, EvaluateError> {
        let (module, info) = (self.module, self.info);
        let mut body = Body {
            compiler: self,
            expressions: &module.global_expressions,
            types: Types::Module(info),
            places: vec![Place::Nothing; module.global_expressions.len()],
            locals: Vec::new(),
            arguments: Vec::new(),
            result: 0,
            scopes: Vec::new(),
            tally: None,
            depth: 0,
        };
        for (handle, _) in module.global_expressions.iter() {
            body.places[handle.index()] = match body.compile(handle) {
                Ok(place) => place,
                Err(error @ EvaluateError::TooLarge { .. }) => return Err(error),
                Err(error) => Place::Trap(body.compiler.trap(error)),
            };
            body.compiler.global_expressions.push(body.places[handle.index()]);
        }
        Ok(body.places)
    }

    /// The next instruction's number.
    pub fn here(&self) -> u32 {
        u32::try_from(self.code.len()).unwrap_or(u32::MAX)
    }
}

impl<'a> Body<'a, '_> {
    /// The type of an expression.
    pub fn type_of(&self, expression: Handle<Expression>) -> &'a TypeInner {
        let module = self.compiler.module;
        match self.types {
            Types::Function(info) => info[expression].ty.inner_with(&module.types),
            Types::Module(info) => info[expression].inner_with(&module.types),
        }
    }

    /// Kind of the numbers of an expression.
    pub fn leaf_of(&self, expression: Handle<Expression>) -> Result<Leaf, EvaluateError> {
        let scalar = self.type_of(expression).scalar();
        scalar.map_or_else(|| Err(unsupported("such an operand")), Leaf::of)
    }

    /// Variables, and the expressions that need no statement.
    fn before(&mut self, function: &'a Function) -> Result<(), EvaluateError> {
        for (_, variable) in function.local_variables.iter() {
            let place = match self.compiler.variable(variable.ty) {
                Ok((at, _)) => Place::Fixed(at),
                Err(error @ EvaluateError::TooLarge { .. }) => return Err(error),
                Err(error) => Place::Trap(self.compiler.trap(error)),
            };
            self.locals.push(place);
        }
        for (handle, expression) in self.expressions.iter() {
            if expression.needs_pre_emit() {
                self.expression(handle)?;
            }
        }
        for (handle, variable) in function.local_variables.iter() {
            let Place::Fixed(to) = self.locals[handle.index()] else { continue };
            let n = self.compiler.len_of(variable.ty)?;
            let Some(init) = variable.init else {
                self.compiler.code.push(Op::Clear { to, n });
                continue;
            };
            // Initialisers are constant expressions of the function, which no statement emits.
            for (handle, _) in self.expressions.iter().take(init.index() + 1) {
                if let Place::Nothing = self.places[handle.index()]
                    && self.is_constant(handle)
                {
                    self.expression(handle)?;
                }
            }
            match self.value(init) {
                Ok(from) => self.compiler.code.push(Op::Copy { to, from, n }),
                Err(error) => {
                    self.fail(error)?;
                }
            }
        }
        Ok(())
    }

    /// Whether an expression is made of constants only.
    fn is_constant(&self, handle: Handle<Expression>) -> bool {
        let has = |h: &Handle<Expression>| !matches!(self.places[h.index()], Place::Nothing);
        match &self.expressions[handle] {
            Expression::Compose { components, .. } => components.iter().all(has),
            Expression::Splat { value, .. } => has(value),
            Expression::Unary { expr, .. } => has(expr),
            Expression::Binary { left, right, .. } => has(left) && has(right),
            Expression::As { expr, .. } => has(expr),
            Expression::Swizzle { vector, .. } => has(vector),
            Expression::AccessIndex { base, .. } => has(base),
            _ => false,
        }
    }

    /// Code that fails with this error when it is reached. What no run survives is an error now.
    fn fail(&mut self, error: EvaluateError) -> Result<u32, EvaluateError> {
        if let EvaluateError::TooLarge { .. } = error {
            return Err(error);
        }
        let trap = self.compiler.trap(error);
        self.compiler.code.push(Op::Trap(trap));
        Ok(trap)
    }

    /// Compiles an expression, or code that fails where it would be.
    fn expression(&mut self, handle: Handle<Expression>) -> Result<(), EvaluateError> {
        let place = match self.compile(handle) {
            Ok(place) => place,
            Err(error) => Place::Trap(self.fail(error)?),
        };
        self.places[handle.index()] = place;
        Ok(())
    }

    /// Where an expression stands.
    pub fn place(&self, handle: Handle<Expression>) -> Result<Place, EvaluateError> {
        match self.places[handle.index()] {
            Place::Trap(trap) => Err(self.compiler.traps[trap as usize].clone()),
            Place::Nothing => Err(unsupported("an expression before its statement")),
            place => Ok(place),
        }
    }

    /// Where a value's numbers stand.
    pub fn value(&self, handle: Handle<Expression>) -> Result<At, EvaluateError> {
        match self.place(handle)? {
            Place::Value(at) => Ok(at),
            _ => Err(unsupported("a pointer as a value")),
        }
    }

    /// Counts operations where the code is now.
    fn count(&mut self, counts: Counts) {
        if counts.is_zero() {
            return;
        }
        let tally = self.tally.unwrap_or_else(|| {
            let tally = self.compiler.tallies.len();
            self.compiler.tallies.push(Counts::default());
            self.compiler.code.push(Op::Tally(u32::try_from(tally).unwrap_or(u32::MAX)));
            tally
        });
        self.tally = Some(tally);
        self.compiler.tallies[tally] += counts;
    }

    fn block(&mut self, block: &'a Block) -> Result<(), EvaluateError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            self.depth -= 1;
            self.fail(unsupported("a block nested so deep"))?;
            return Ok(());
        }
        for statement in block {
            if let Err(error) = self.statement(statement) {
                self.fail(error)?;
            }
        }
        self.depth -= 1;
        Ok(())
    }

    fn jump(&mut self) -> usize {
        self.compiler.code.push(Op::Jump { to: u32::MAX });
        self.compiler.code.len() - 1
    }

    /// Makes jumps go here.
    fn land(&mut self, jumps: impl IntoIterator<Item = usize>) {
        let here = self.compiler.here();
        for jump in jumps {
            match &mut self.compiler.code[jump] {
                Op::Jump { to } | Op::JumpUnless { to, .. } => *to = here,
                _ => {}
            }
        }
        self.tally = None;
    }

    fn statement(&mut self, statement: &'a Statement) -> Result<(), EvaluateError> {
        match statement {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    let counts = operations(&self.expressions[handle], self.type_of(handle), |h| self.type_of(h));
                    self.count(counts);
                    self.expression(handle)?;
                }
            }
            Statement::Block(block) => self.block(block)?,
            Statement::If { condition, accept, reject } => {
                self.count(Counts::of(Kind::Branch, 1));
                let condition = self.value(*condition)?;
                self.compiler.code.push(Op::JumpUnless { condition, to: u32::MAX });
                let otherwise = self.compiler.code.len() - 1;
                self.tally = None;
                self.block(accept)?;
                if reject.is_empty() {
                    self.land([otherwise]);
                } else {
                    let end = self.jump();
                    self.land([otherwise]);
                    self.block(reject)?;
                    self.land([end]);
                }
            }
            Statement::Switch { selector, cases } => self.switch(*selector, cases)?,
            Statement::Loop {
                body,
                continuing,
                break_if,
            } => self.repeat(body, continuing, *break_if)?,
            Statement::Break => {
                let jump = self.jump();
                match self.scopes.last_mut() {
                    Some(scope) => scope.breaks.push(jump),
                    None => return Err(unsupported("a break outside of a loop")),
                }
            }
            Statement::Continue => {
                let jump = self.jump();
                match self.scopes.iter_mut().rev().find(|scope| scope.is_loop) {
                    Some(scope) => scope.continues.push(jump),
                    None => return Err(unsupported("a continue outside of a loop")),
                }
            }
            Statement::Return { value } => {
                if let Some(value) = value {
                    let from = self.value(*value)?;
                    let n = self.compiler.len(self.type_of(*value))?;
                    let to = self.result;
                    self.compiler.code.push(Op::Copy { to, from, n });
                }
                self.compiler.code.push(Op::Return);
            }
            Statement::Kill => self.compiler.code.push(Op::Discard),
            // There is one invocation.
            Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) => {}
            Statement::Store { pointer, value } => self.store(*pointer, *value)?,
            Statement::WorkGroupUniformLoad { pointer, result } => {
                let place = self.load(*pointer)?;
                self.places[result.index()] = place;
            }
            Statement::Call {
                function,
                arguments,
                result,
            } => self.call(*function, arguments, *result)?,
            Statement::Atomic {
                pointer,
                fun,
                value,
                result,
            } => {
                self.count(Counts::of(Kind::Integer, 1));
                self.atomic(*pointer, fun, *value, *result)?;
            }
            Statement::ImageStore { .. } => return Err(unsupported("a store to a texture")),
            Statement::ImageAtomic { .. } => return Err(unsupported("an atomic operation on a texture")),
            Statement::RayQuery { .. } => return Err(unsupported("a ray query")),
            Statement::RayPipelineFunction(_) => return Err(unsupported("a ray pipeline")),
            Statement::SubgroupBallot { .. } | Statement::SubgroupGather { .. } | Statement::SubgroupCollectiveOperation { .. } => {
                return Err(unsupported("a subgroup operation"));
            }
            Statement::CooperativeStore { .. } => return Err(unsupported("a cooperative matrix")),
        }
        Ok(())
    }

    fn switch(&mut self, selector: Handle<Expression>, cases: &'a [naga::SwitchCase]) -> Result<(), EvaluateError> {
        self.count(Counts::of(Kind::Branch, 1));
        let selector = self.value(selector)?;
        let table = self.compiler.tables.len();
        self.compiler.tables.push(Table::default());
        self.compiler.code.push(Op::Switch {
            selector,
            table: u32::try_from(table).unwrap_or(u32::MAX),
        });
        self.scopes.push(Scope {
            is_loop: false,
            breaks: Vec::new(),
            continues: Vec::new(),
        });
        let mut made = Table::default();
        for case in cases {
            self.tally = None;
            let here = self.compiler.here();
            match case.value {
                SwitchValue::I32(value) => made.cases.push((value.cast_unsigned(), here)),
                SwitchValue::U32(value) => made.cases.push((value, here)),
                SwitchValue::Default => made.default = here,
            }
            self.block(&case.body)?;
            if !case.fall_through {
                let jump = self.jump();
                if let Some(scope) = self.scopes.last_mut() {
                    scope.breaks.push(jump);
                }
            }
        }
        self.compiler.tables[table] = made;
        let scope = self.scopes.pop();
        self.land(scope.into_iter().flat_map(|scope| scope.breaks));
        Ok(())
    }

    fn repeat(&mut self, body: &'a Block, continuing: &'a Block, break_if: Option<Handle<Expression>>) -> Result<(), EvaluateError> {
        self.tally = None;
        let start = self.compiler.here();
        self.scopes.push(Scope {
            is_loop: true,
            breaks: Vec::new(),
            continues: Vec::new(),
        });
        self.block(body)?;
        let continues = self.scopes.last_mut().map(|scope| std::mem::take(&mut scope.continues));
        self.land(continues.unwrap_or_default());
        // A trip is one that was not broken off.
        self.count(Counts::of(Kind::Trip, 1));
        self.block(continuing)?;
        let condition = match break_if.map(|condition| self.value(condition)).transpose() {
            Ok(condition) => condition,
            Err(error) => {
                self.fail(error)?;
                None
            }
        };
        self.compiler.code.push(match condition {
            Some(condition) => Op::JumpUnless { condition, to: start },
            None => Op::Jump { to: start },
        });
        let scope = self.scopes.pop();
        self.land(scope.into_iter().flat_map(|scope| scope.breaks));
        Ok(())
    }
}
