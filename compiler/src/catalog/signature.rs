//! What an interface's function takes, as its author wrote it: before anything that a program does not read is left out.

use indexmap::IndexMap;

use super::Catalog;
use crate::diagnostics::Report;
use crate::parse::Interface;
use crate::parse::scan::{Item, ItemKind};

/// Arguments of a function and the structs of the interfaces that it may be made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signature {
    /// Types by name of the argument, in order.
    pub arguments: IndexMap<String, String>,
    /// Types by name of the member, by name of the struct.
    pub structs: IndexMap<String, IndexMap<String, String>>,
}

impl Catalog {
    /// The signature of a category's function; none where its interface has no such function.
    ///
    /// # Errors
    /// There is no such category, or an interface cannot be read.
    pub fn signature(&self, category: &str, function: &str) -> Result<Option<Signature>, Report> {
        let mut signature = Signature::default();
        let own = self.interface(category)?;
        let Some(item) = find(&own, function) else { return Ok(None) };
        signature.arguments = types(&own, item);
        let mut queue = vec![category.to_owned()];
        let mut at = 0;
        while let Some(name) = queue.get(at).cloned() {
            at += 1;
            let interface = self.interface(&name)?;
            for item in interface.scan.items.iter().filter(|item| item.kind == ItemKind::Struct) {
                let members = types(&interface, item);
                signature.structs.entry(item.name.clone()).or_insert(members);
            }
            for used in &interface.category.manifest.uses {
                if !queue.contains(used) {
                    queue.push(used.clone());
                }
            }
        }
        Ok(Some(signature))
    }
}

fn find<'i>(interface: &'i Interface, function: &str) -> Option<&'i Item> {
    let is_it = |item: &&Item| item.kind == ItemKind::Function && item.name == function;
    interface.scan.items.iter().find(is_it)
}

/// Name and type of an item's fields, the type as written.
fn types(interface: &Interface, item: &Item) -> IndexMap<String, String> {
    let text = |field: &crate::parse::scan::Field| interface.file.text[interface.scan.bytes(&field.ty)].to_owned();
    item.fields.iter().map(|field| (field.name.clone(), text(field))).collect()
}
