//! Permutations of the forward pass, as many as are wanted.

use std::collections::HashSet;

use shadewright_compiler::Catalog;
use shadewright_compiler::catalog::Module;
use shadewright_compiler::manifest::{Among, Arity, Filling, Node, Param, ParamMode, ParamType, Rule, Value};

/// Kinds of lights in a recipe, at most.
const MOST_IN_A_LIST: u64 = 3;

/// A frozen parameter parses its module once more, so a module has only this many of them at most.
const MOST_FROZEN: usize = 2;

/// Different recipes with the pass `root` at their root: every slot filled with anything that fits, some parameters frozen.
/// The same every time; a longer list begins with the shorter one.
///
/// # Errors
/// There is no such module.
pub fn permutations(catalog: &Catalog, root: &str, count: usize) -> Result<Vec<Node>, String> {
    let module = catalog.module(root).map_err(|report| report.render())?;
    let mut draw = Draw { catalog, state: 1 };
    let mut seen = HashSet::new();
    let mut found = Vec::new();
    for _ in 0..100 * count {
        if found.len() == count {
            break;
        }
        let node = draw.node(module, 0);
        // A tree of strings and numbers always has a JSON form.
        if seen.insert(serde_json::to_string(&node).unwrap_or_default()) {
            found.push(node);
        }
    }
    Ok(found)
}

struct Draw<'a> {
    catalog: &'a Catalog,
    state: u64,
}

impl Draw<'_> {
    /// A number below `end`: Steele, Lea and Flood 2014, SplitMix64. The shortest generator that passes the usual tests.
    fn below(&mut self, end: u64) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % end.max(1)
    }

    fn node(&mut self, module: &Module, depth: usize) -> Node {
        let mut node = Node::new(module.name.clone());
        for (name, slot) in &module.manifest.slots {
            let fits: Vec<_> = self
                .catalog
                .modules()
                .filter(|m| m.category == slot.interface && stands_below(m, module))
                .collect();
            // No tree of the library is this deep; a module that fits its own slot would make it endless.
            if fits.is_empty() || depth > 8 {
                continue;
            }
            let one = |draw: &mut Self| {
                let chosen = fits[draw.below(fits.len() as u64) as usize];
                draw.node(chosen, depth + 1)
            };
            let filling = match slot.arity {
                Arity::Single => Filling::One(one(self)),
                Arity::Optional if self.below(2) == 0 => continue,
                Arity::Optional => Filling::One(one(self)),
                Arity::List if fits.len() == 1 => Filling::Many(vec![one(self)]),
                Arity::List => Filling::Many((0..1 + self.below(MOST_IN_A_LIST)).map(|_| one(self)).collect()),
            };
            node.fill.insert(name.clone(), filling);
        }
        for (name, param) in &module.manifest.params {
            if node.freeze.len() < MOST_FROZEN && self.below(4) == 0 {
                let value = self.value(param);
                node.freeze.insert(name.clone(), value);
            }
        }
        node
    }

    /// The default, or for constants, on which code depends, also another value.
    fn value(&mut self, param: &Param) -> Value {
        match (param.mode, param.ty, &param.default) {
            (ParamMode::Constant, ParamType::Bool, _) => Value::Bool(self.below(2) == 0),
            (ParamMode::Constant, ParamType::U32, Value::Number(default)) => {
                let most = param.range.map_or(f64::MAX, |(_, most)| most);
                Value::Number((default * 2f64.powi(self.below(3) as i32)).min(most))
            }
            _ => param.default.clone(),
        }
    }
}

/// Whether the module's rules about its parent let it stand there.
fn stands_below(module: &Module, parent: &Module) -> bool {
    let has = |tag: &str| {
        let manifest = &parent.manifest;
        parent.name == tag
            || parent.category == tag
            || manifest.properties.iter().any(|p| p == tag)
            || manifest.instances.values().any(|field| field.role.as_deref() == Some(tag))
    };
    module.manifest.rules.iter().all(|rule| match rule {
        Rule::Requires {
            tag, among: Among::Parent, ..
        } => has(tag),
        Rule::Excludes {
            tag, among: Among::Parent, ..
        } => !has(tag),
        _ => true,
    })
}
