//! Writing a plan as IR, by cloning the units' functions and patching what they refer to.

use naga::diagnostic_filter::DiagnosticFilterNode;
use naga::proc::Layouter;
use naga::{Constant, EntryPoint, Expression, GlobalVariable, Handle, Module, Override, ResourceBinding, Span, Type};

use crate::parse::Origin;
use crate::plan::{Body, GROUPS, Home, Plan, declaring};

/// Links a plan to a module that nobody has validated yet.
pub fn link(plan: &Plan) -> Module {
    let mut linker = Linker::new(plan);
    for index in 0..plan.functions.len() {
        linker.function(index);
    }
    // Stages in a fixed order, whatever the order of the text.
    linker.out.entry_points.sort_by_key(|e| (stage_order(e.stage), e.name.clone()));
    linker.out
}

fn stage_order(stage: naga::ShaderStage) -> u8 {
    match stage {
        naga::ShaderStage::Vertex => 0,
        naga::ShaderStage::Fragment => 1,
        naga::ShaderStage::Compute => 2,
        _ => 3,
    }
}

/// What of the homes' units is already in the output.
pub(super) struct Copied {
    pub types: Map<Type>,
    pub constants: Map<Constant>,
    pub overrides: Map<Override>,
    pub expressions: Map<Expression>,
    pub globals: Map<GlobalVariable>,
    pub filters: Map<DiagnosticFilterNode>,
}

/// From handles of the homes' units to those of the output.
pub(super) struct Map<T> {
    /// Where a home's handles begin.
    starts: Vec<usize>,
    done: Vec<Option<Handle<T>>>,
}

impl<T> Map<T> {
    /// `len` is the number of a unit's handles.
    fn new(homes: &[Home], len: impl Fn(&Module) -> usize) -> Self {
        let mut end = 0;
        let ends = homes.iter().map(|home| {
            end += len(&home.unit.ir);
            end
        });
        let starts = std::iter::once(0).chain(ends).collect();
        Self {
            starts,
            done: vec![None; end],
        }
    }

    pub fn get(&self, home: usize, handle: Handle<T>) -> Option<Handle<T>> {
        self.done[self.starts[home] + handle.index()]
    }

    pub fn insert(&mut self, home: usize, handle: Handle<T>, done: Handle<T>) {
        self.done[self.starts[home] + handle.index()] = Some(done);
    }
}

pub(super) struct Linker<'p> {
    pub plan: &'p Plan,
    pub out: Module,
    pub copied: Copied,
    /// Linked functions by index in the plan.
    pub functions: Vec<Option<Handle<naga::Function>>>,
    /// Linked structs by index in the plan.
    pub structs: Vec<Option<Handle<Type>>>,
    /// Uniform blocks by index in the plan.
    pub blocks: Vec<Option<Handle<GlobalVariable>>>,
    pub layouter: Layouter,
    /// What the form of the function at hand depends on.
    pub alive: Vec<bool>,
}

impl<'p> Linker<'p> {
    fn new(plan: &'p Plan) -> Self {
        Self {
            plan,
            out: Module::default(),
            copied: Copied {
                types: Map::new(&plan.homes, |ir| ir.types.len()),
                constants: Map::new(&plan.homes, |ir| ir.constants.len()),
                overrides: Map::new(&plan.homes, |ir| ir.overrides.len()),
                expressions: Map::new(&plan.homes, |ir| ir.global_expressions.len()),
                globals: Map::new(&plan.homes, |ir| ir.global_variables.len()),
                filters: Map::new(&plan.homes, |ir| ir.diagnostic_filters.len()),
            },
            functions: vec![None; plan.functions.len()],
            structs: vec![None; plan.structs.list.len()],
            blocks: vec![None; plan.blocks.len()],
            layouter: Layouter::default(),
            alive: Vec::new(),
        }
    }

    fn function(&mut self, index: usize) {
        let planned = &self.plan.functions[index];
        match &planned.body {
            Body::Combined { stub, rule, .. } => {
                let function = self.combined(planned, *stub, *rule);
                self.functions[index] = Some(self.out.functions.append(function, Span::default()));
            }
            Body::Function(handle) => {
                let unit = &self.plan.homes[planned.home].unit;
                let span = self.span(planned.home, unit.ir.functions.get_span(*handle));
                let function = self.body(planned, &unit.ir.functions[*handle], &unit.templates[handle.index()]);
                self.functions[index] = Some(self.out.functions.append(function, span));
            }
            Body::Entry(entry) => {
                let unit = &self.plan.homes[planned.home].unit;
                let templates = &unit.templates[unit.ir.functions.len() + entry];
                let entry = &unit.ir.entry_points[*entry];
                let mut function = self.body(planned, &entry.function, templates);
                function.name.clone_from(&entry.function.name);
                let workgroup_size_overrides = entry
                    .workgroup_size_overrides
                    .map(|sizes| sizes.map(|size| size.map(|e| self.global_expression(planned.home, e))));
                self.out.entry_points.push(EntryPoint {
                    name: planned.name.clone(),
                    stage: entry.stage,
                    early_depth_test: entry.early_depth_test,
                    workgroup_size: entry.workgroup_size,
                    workgroup_size_overrides,
                    function,
                    mesh_info: None,
                    task_payload: None,
                    incoming_ray_payload: None,
                });
            }
        }
    }

    /// An item's span that also tells the home.
    pub fn span(&self, home: usize, span: Span) -> Span {
        let base = self.plan.homes[home].base;
        match span.to_range() {
            Some(range) => Span::new(range.start as u32 + base, range.end as u32 + base),
            None => span,
        }
    }

    pub fn name(&self, home: usize, name: &Option<String>) -> Option<String> {
        let name = name.as_ref()?;
        Some(self.plan.name(home, name).unwrap_or(name).to_owned())
    }

    pub fn global_expression(&mut self, home: usize, handle: Handle<Expression>) -> Handle<Expression> {
        if let Some(done) = self.copied.expressions.get(home, handle) {
            return done;
        }
        let ir = &self.plan.homes[home].unit.ir;
        let mut expression = ir.global_expressions[handle].clone();
        self.patch_global_expression(home, &mut expression);
        let span = self.span(home, ir.global_expressions.get_span(handle));
        let done = self.out.global_expressions.append(expression, span);
        self.copied.expressions.insert(home, handle, done);
        done
    }

    /// Expressions at module scope are constant: these are all kinds that naga's validator lets pass there.
    fn patch_global_expression(&mut self, home: usize, expression: &mut Expression) {
        match expression {
            Expression::Constant(constant) => *constant = self.constant(home, *constant),
            Expression::Override(o) => *o = self.override_(home, *o),
            Expression::ZeroValue(ty) => *ty = self.ty(home, *ty),
            Expression::Compose { ty, components } => {
                *ty = self.ty(home, *ty);
                for component in components {
                    *component = self.global_expression(home, *component);
                }
            }
            Expression::Splat { value: h, .. }
            | Expression::Swizzle { vector: h, .. }
            | Expression::Unary { expr: h, .. }
            | Expression::As { expr: h, .. }
            | Expression::Relational { argument: h, .. }
            | Expression::AccessIndex { base: h, .. } => *h = self.global_expression(home, *h),
            Expression::Access { base, index } => {
                *base = self.global_expression(home, *base);
                *index = self.global_expression(home, *index);
            }
            Expression::Binary { left, right, .. } => {
                *left = self.global_expression(home, *left);
                *right = self.global_expression(home, *right);
            }
            Expression::Select { condition, accept, reject } => {
                *condition = self.global_expression(home, *condition);
                *accept = self.global_expression(home, *accept);
                *reject = self.global_expression(home, *reject);
            }
            Expression::Math { arg, arg1, arg2, arg3, .. } => {
                *arg = self.global_expression(home, *arg);
                for optional in [arg1, arg2, arg3].into_iter().flatten() {
                    *optional = self.global_expression(home, *optional);
                }
            }
            _ => {}
        }
    }

    pub fn constant(&mut self, home: usize, handle: Handle<Constant>) -> Handle<Constant> {
        let (home, handle) = self.declaring_constant(self.plan.shared_home(home), handle);
        if let Some(done) = self.copied.constants.get(home, handle) {
            return done;
        }
        let ir = &self.plan.homes[home].unit.ir;
        let constant = &ir.constants[handle];
        let ty = self.ty(home, constant.ty);
        let init = self.global_expression(home, constant.init);
        let span = self.span(home, ir.constants.get_span(handle));
        let done = self.out.constants.append(
            Constant {
                name: self.name(home, &constant.name),
                ty,
                init,
            },
            span,
        );
        self.copied.constants.insert(home, handle, done);
        done
    }

    /// The home and handle that a constant really is: a unit also holds copies of its interfaces' constants.
    fn declaring_constant(&self, home: usize, handle: Handle<Constant>) -> (usize, Handle<Constant>) {
        let plan = self.plan;
        let unit = &plan.homes[home].unit;
        let Some(name) = &unit.ir.constants[handle].name else {
            return (home, handle);
        };
        let Some(Origin::Interface(category)) = unit.origin(name) else {
            return (home, handle);
        };
        let Some(declared) = plan.interface_home(category) else {
            return (home, handle);
        };
        let found = plan.homes[declared]
            .unit
            .ir
            .constants
            .iter()
            .find(|(_, c)| c.name.as_ref() == Some(name));
        found.map_or((home, handle), |(h, _)| (declared, h))
    }

    pub fn override_(&mut self, home: usize, handle: Handle<Override>) -> Handle<Override> {
        if let Some(done) = self.copied.overrides.get(home, handle) {
            return done;
        }
        let ir = &self.plan.homes[home].unit.ir;
        let declared = &ir.overrides[handle];
        let ty = self.ty(home, declared.ty);
        let init = declared.init.map(|init| self.global_expression(home, init));
        let span = self.span(home, ir.overrides.get_span(handle));
        let done = self.out.overrides.append(
            Override {
                name: self.name(home, &declared.name),
                id: declared.id,
                ty,
                init,
            },
            span,
        );
        self.copied.overrides.insert(home, handle, done);
        done
    }

    /// A module-scope variable other than `params`.
    pub fn global(&mut self, home: usize, handle: Handle<GlobalVariable>) -> Handle<GlobalVariable> {
        if let Some(done) = self.copied.globals.get(home, handle) {
            return done;
        }
        let named = (home, handle);
        let (home, handle) = declaring(self.plan, home, handle);
        if let Some(done) = self.copied.globals.get(home, handle) {
            self.copied.globals.insert(named.0, named.1, done);
            return done;
        }
        let ir = &self.plan.homes[home].unit.ir;
        let declared = &ir.global_variables[handle];
        let ty = self.ty(home, declared.ty);
        let init = declared.init.map(|init| self.global_expression(home, init));
        let planned = self.plan.globals.iter().find(|g| g.home == home && g.handle == handle);
        let variable = GlobalVariable {
            name: self.name(home, &declared.name),
            space: declared.space,
            binding: planned
                .and_then(|g| g.binding)
                .map(|(group, binding)| ResourceBinding { group, binding }),
            ty,
            init,
            memory_decorations: declared.memory_decorations,
        };
        let span = self.span(home, ir.global_variables.get_span(handle));
        let done = self.out.global_variables.append(variable, span);
        self.copied.globals.insert(home, handle, done);
        self.copied.globals.insert(named.0, named.1, done);
        done
    }

    /// The uniform block that holds a home's parameter, and the parameter's index in it.
    pub fn block_member(&mut self, home: usize, index: u32) -> Option<(Handle<GlobalVariable>, u32)> {
        let plan = self.plan;
        for (number, block) in plan.blocks.iter().enumerate() {
            if let Some(member) = block.members.iter().position(|m| m.home == home && m.index == index) {
                let handle = match self.blocks[number] {
                    Some(handle) => handle,
                    None => self.uniform_block(number),
                };
                return Some((handle, member as u32));
            }
        }
        None
    }

    fn uniform_block(&mut self, number: usize) -> Handle<GlobalVariable> {
        let plan = self.plan;
        let block = &plan.blocks[number];
        let mut members = Vec::with_capacity(block.members.len());
        for member in &block.members {
            let unit = &plan.homes[member.home].unit;
            let ty = unit.ir.types.iter().find_map(|(_, t)| match &t.inner {
                naga::TypeInner::Struct { members, .. } if t.name.as_deref() == Some("Params") => members.get(member.index as usize),
                _ => None,
            });
            if let Some(declared) = ty {
                members.push(naga::StructMember {
                    name: Some(member.name.clone()),
                    ty: self.ty(member.home, declared.ty),
                    binding: None,
                    offset: 0,
                });
            }
        }
        let group = GROUPS[block.group as usize];
        let ty = self.insert_struct(Some(crate::parse::joined(group, "Params")), members, Span::default());
        let variable = GlobalVariable {
            name: Some(format!("{group}_params")),
            space: naga::AddressSpace::Uniform,
            binding: Some(ResourceBinding {
                group: block.group,
                binding: block.binding,
            }),
            ty,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        let handle = self.out.global_variables.append(variable, Span::default());
        self.blocks[number] = Some(handle);
        handle
    }

    pub fn filter(&mut self, home: usize, leaf: Option<Handle<DiagnosticFilterNode>>) -> Option<Handle<DiagnosticFilterNode>> {
        let leaf = leaf?;
        if let Some(done) = self.copied.filters.get(home, leaf) {
            return Some(done);
        }
        let ir = &self.plan.homes[home].unit.ir;
        let mut node = ir.diagnostic_filters[leaf].clone();
        node.parent = self.filter(home, node.parent);
        let span = self.span(home, ir.diagnostic_filters.get_span(leaf));
        let done = self.out.diagnostic_filters.append(node, span);
        self.copied.filters.insert(home, leaf, done);
        Some(done)
    }
}
