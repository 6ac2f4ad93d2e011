//! Structs across units, and which of their members anybody reads.

use naga::{Handle, Type};

use super::Home;
use crate::parse::StructKey;
use crate::parse::scan::Scan;

/// A struct of the plan.
#[derive(Debug)]
pub struct Struct {
    /// Home that declares it.
    pub home: usize,
    /// Name there.
    pub name: String,
    /// Whether a host or the language fixes its layout.
    pub fixed: bool,
    /// Which members are alive.
    pub live: Vec<bool>,
}

impl Struct {
    /// The member that stays of a struct whose members nobody reads: a built-in value, or else the first.
    pub fn kept_when_empty(&self, homes: &[Home]) -> u32 {
        let mut types = homes[self.home].unit.ir.types.iter();
        let declared = types.find_map(|(_, t)| match &t.inner {
            naga::TypeInner::Struct { members, .. } if t.name.as_deref() == Some(&self.name) => Some(members),
            _ => None,
        });
        let is_builtin = |m: &naga::StructMember| matches!(m.binding, Some(naga::Binding::BuiltIn(_)));
        declared.and_then(|members| members.iter().position(is_builtin)).unwrap_or(0) as u32
    }
}

/// All structs of the units in a plan.
#[derive(Debug, Default)]
pub struct Structs {
    /// The structs.
    pub list: Vec<Struct>,
    /// By home, then by index of the type.
    ids: Vec<Vec<Option<usize>>>,
    /// By the home that declares it, then by [`place`].
    declared: Vec<Vec<Option<usize>>>,
}

impl Structs {
    /// Adds the structs of a home. `interface_home` finds the home of a category's interface, if it is in the plan.
    pub fn add(&mut self, homes: &[Home], home: usize, interface_home: impl Fn(&str) -> Option<usize>) {
        let unit = &homes[home].unit;
        self.ids.resize_with(homes.len(), Vec::new);
        self.declared.resize_with(homes.len(), Vec::new);
        self.ids[home] = vec![None; unit.ir.types.len()];
        for (&handle, key) in &unit.structs {
            let StructKey { interface, name } = key;
            let declared = interface
                .as_deref()
                .map_or(Some(homes[home].first), &interface_home)
                .unwrap_or(homes[home].first);
            let members = match &unit.ir.types[handle].inner {
                naga::TypeInner::Struct { members, .. } => members.len(),
                _ => 0,
            };
            let items = &homes[declared].unit.scan;
            self.declared[declared].resize(items.items.len() + 2, None);
            let id = *self.declared[declared][place(items, name)].get_or_insert_with(|| {
                self.list.push(Struct {
                    home: declared,
                    name: name.clone(),
                    fixed: false,
                    live: vec![false; members],
                });
                self.list.len() - 1
            });
            self.list[id].fixed |= unit.fixed_structs.contains(key);
            self.ids[home][handle.index()] = Some(id);
        }
    }

    /// The struct behind a type of a home's unit.
    pub fn id(&self, home: usize, ty: Handle<Type>) -> Option<usize> {
        *self.ids.get(home)?.get(ty.index())?
    }

    /// The struct of this name that a home declares.
    pub fn named(&self, homes: &[Home], home: usize, name: &str) -> Option<usize> {
        *self.declared.get(home)?.get(place(&homes[home].unit.scan, name))?
    }

    /// Whether a member is alive.
    pub fn is_live(&self, id: usize, member: u32) -> bool {
        let s = &self.list[id];
        s.fixed || s.live.get(member as usize).copied().unwrap_or(true)
    }

    /// Makes a member alive; says whether that is news.
    pub fn enliven(&mut self, id: usize, member: u32) -> bool {
        match self.list[id].live.get_mut(member as usize) {
            Some(live) => !std::mem::replace(live, true),
            None => false,
        }
    }

    /// A member's index among the live ones.
    pub fn new_index(&self, id: usize, member: u32) -> u32 {
        (0..member).filter(|&m| self.is_live(id, m)).count() as u32
    }
}

/// Where a struct of a text stands: by its item; behind them `Params` and `Instance`, which the linker adds.
fn place(scan: &Scan, name: &str) -> usize {
    let added = || scan.items.len() + usize::from(name != "Params");
    scan.item_index(name).unwrap_or_else(added)
}
