//! Functions with their dead parts taken out, kept for the next permutation that needs the same of them.

use std::sync::{Arc, Mutex};

use naga::{Expression, Function, Handle};

use crate::catalog::lock;
use crate::limits;

/// A function of a unit as it is linked, but for what differs from permutation to permutation: the handles of everything outside
/// of it are still the unit's.
#[derive(Debug)]
pub struct Template {
    /// What of it is alive, and what of the structs and functions that it names: all that its form depends on.
    pub alive: Vec<bool>,
    /// The function, without a name.
    pub function: Function,
    /// Expressions that depend on something outside, in their order; of those that stand for a variable the first.
    pub outward: Vec<Handle<Expression>>,
}

/// The forms of one function.
#[derive(Debug, Default)]
pub struct Templates(Mutex<Vec<Arc<Template>>>);

impl Templates {
    /// The form in which this is alive.
    pub fn get(&self, alive: &[bool]) -> Option<Arc<Template>> {
        lock(&self.0).iter().find(|t| t.alive == alive).cloned()
    }

    /// Keeps a form. The oldest goes when there are too many.
    pub fn keep(&self, template: Template) -> Arc<Template> {
        let template = Arc::new(template);
        let mut kept = lock(&self.0);
        if kept.len() >= limits::TEMPLATES {
            kept.remove(0);
        }
        kept.push(Arc::clone(&template));
        template
    }
}
