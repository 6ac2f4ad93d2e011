//! RON text to declarations: categories, modules, recipes.

mod category;
mod check;
mod load;
mod module;
mod observer;
mod recipe;
mod spans;
mod temperature;
mod value;

pub use category::{CategoryManifest, Combine};
pub use check::{GENERATED, LAST_GROUP, check_category, check_module, default_of, is_identifier};
pub use load::{Parsed, parse, parse_category, parse_module, parse_recipe, ron_options};
pub use module::{
    Among, Arity, Dispatch, Filling, ModuleManifest, Param, ParamMode, ParamType, PassDecl, Resource, ResourceKind, Rule, Slot, ViewKind,
};
pub use recipe::{Node, Value};
pub use spans::{Locator, Step};
pub use temperature::{DAYLIGHT, KELVIN, black_body, daylight};
pub use value::{MAX_EFFICACY, Typed, ValueError, shortest, typed};
