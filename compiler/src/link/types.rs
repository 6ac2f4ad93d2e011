//! Types, copied on demand: equal ones become one, structs lose the members that nobody reads.

use naga::{ArraySize, Handle, PredeclaredType, Span, StructMember, Type, TypeInner};

use super::ir::Linker;

impl Linker<'_> {
    /// The linked type of a unit's type.
    pub fn ty(&mut self, home: usize, handle: Handle<Type>) -> Handle<Type> {
        let home = self.plan.shared_home(home);
        if let Some(done) = self.copied.types.get(home, handle) {
            return done;
        }
        let plan = self.plan;
        let ir = &plan.homes[home].unit.ir;
        let declared = &ir.types[handle];
        let span = self.span(home, ir.types.get_span(handle));
        let done = match &declared.inner {
            TypeInner::Struct { members, .. } => self.structure(home, handle, members, span),
            // Other types are what they are, by whatever alias: a name would make equal ones differ.
            TypeInner::Pointer { base, space } => {
                let base = self.ty(home, *base);
                self.insert(TypeInner::Pointer { base, space: *space }, span)
            }
            TypeInner::Array { base, size, stride } => {
                let base = self.ty(home, *base);
                let size = self.size(home, *size);
                let stride = self.stride(base).unwrap_or(*stride);
                self.insert(TypeInner::Array { base, size, stride }, span)
            }
            TypeInner::BindingArray { base, size } => {
                let base = self.ty(home, *base);
                let size = self.size(home, *size);
                self.insert(TypeInner::BindingArray { base, size }, span)
            }
            inner => self.insert(inner.clone(), span),
        };
        self.copied.types.insert(home, handle, done);
        done
    }

    fn insert(&mut self, inner: TypeInner, span: Span) -> Handle<Type> {
        self.out.types.insert(Type { name: None, inner }, span)
    }

    fn size(&mut self, home: usize, size: ArraySize) -> ArraySize {
        match size {
            ArraySize::Pending(length) => ArraySize::Pending(self.override_(home, length)),
            ArraySize::Constant(_) | ArraySize::Dynamic => size,
        }
    }

    fn structure(&mut self, home: usize, handle: Handle<Type>, members: &[StructMember], span: Span) -> Handle<Type> {
        let plan = self.plan;
        let ir = &plan.homes[home].unit.ir;
        let declared = &ir.types[handle];
        let Some(id) = plan.structs.id(home, handle) else {
            // Of the language, or the unit's own `Params`: kept as it is.
            let members = members
                .iter()
                .map(|m| StructMember {
                    ty: self.ty(home, m.ty),
                    ..m.clone()
                })
                .collect();
            let inner = TypeInner::Struct {
                members,
                span: span_bytes(&declared.inner),
            };
            let done = self.out.types.insert(
                Type {
                    name: declared.name.clone(),
                    inner,
                },
                span,
            );
            self.predeclare(home, handle, done);
            return done;
        };
        if let Some(done) = self.structs[id] {
            return done;
        }
        let s = &plan.structs.list[id];
        let own = s.name(&plan.homes);
        let name = plan.name(s.home, own).unwrap_or(own).to_owned();
        let living = members
            .iter()
            .enumerate()
            .filter(|&(index, _)| plan.structs.is_live(id, index as u32));
        let mut kept = Vec::with_capacity(members.len());
        for (_, member) in living {
            kept.push(StructMember {
                ty: self.ty(home, member.ty),
                ..member.clone()
            });
        }
        let done = if s.fixed {
            self.out.types.insert(
                Type {
                    name: Some(name),
                    inner: TypeInner::Struct {
                        members: kept,
                        span: span_bytes(&declared.inner),
                    },
                },
                span,
            )
        } else {
            self.insert_struct(Some(name), kept, span)
        };
        // Of all units that know it: they have it from one text.
        self.structs[id] = Some(done);
        done
    }

    /// A struct laid out by WGSL's rules, whatever offsets its members came with.
    pub fn insert_struct(&mut self, name: Option<String>, mut members: Vec<StructMember>, span: Span) -> Handle<Type> {
        let mut end = 0;
        let mut align = naga::proc::Alignment::ONE;
        // Fails for invalid types only, which the validator then reports.
        let _ = self.layouter.update(self.out.to_ctx());
        for member in &mut members {
            let layout = self.layouter[member.ty];
            member.offset = layout.alignment.round_up(end);
            end = member.offset + layout.size;
            align = align.max(layout.alignment);
        }
        let inner = TypeInner::Struct {
            members,
            span: align.round_up(end),
        };
        self.out.types.insert(Type { name, inner }, span)
    }

    fn stride(&mut self, base: Handle<Type>) -> Option<u32> {
        let sized = !matches!(self.out.types[base].inner, TypeInner::Image { .. } | TypeInner::Sampler { .. });
        self.layouter.update(self.out.to_ctx()).ok().filter(|()| sized)?;
        Some(self.layouter[base].to_stride())
    }

    /// The types of results of `modf`, `frexp` and `atomicCompareExchangeWeak` are known to the backends by kind.
    fn predeclare(&mut self, home: usize, handle: Handle<Type>, done: Handle<Type>) {
        let special = &self.plan.homes[home].unit.ir.special_types;
        let found: Option<PredeclaredType> = special
            .predeclared_types
            .iter()
            .find(|&(_, &ty)| ty == handle)
            .map(|(key, _)| copy(key));
        if let Some(key) = found {
            self.out.special_types.predeclared_types.insert(key, done);
        }
    }
}

fn span_bytes(inner: &TypeInner) -> u32 {
    match *inner {
        TypeInner::Struct { span, .. } => span,
        _ => 0,
    }
}

/// naga derives no `Clone` for this key.
fn copy(key: &PredeclaredType) -> PredeclaredType {
    match *key {
        PredeclaredType::AtomicCompareExchangeWeakResult(scalar) => PredeclaredType::AtomicCompareExchangeWeakResult(scalar),
        PredeclaredType::ModfResult { size, scalar } => PredeclaredType::ModfResult { size, scalar },
        PredeclaredType::FrexpResult { size, scalar } => PredeclaredType::FrexpResult { size, scalar },
    }
}
