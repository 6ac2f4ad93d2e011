//! RON text to declarations: categories, modules, recipes.

mod category;
mod module;
mod recipe;
mod spans;

pub use category::{CategoryManifest, Combine};
pub use module::{
    Among, Arity, Dispatch, Filling, ModuleManifest, Param, ParamMode, ParamType, PassDecl, Resource, ResourceKind, Rule, Slot, ViewKind,
};
pub use recipe::{Node, Value};
pub use spans::{Locator, Step};
