//! Files: scenes opened and saved, pictures exported, modules watched, and the state that is kept from one start to the next.

mod dialog;
mod drop;
mod export;
mod keep;
mod modules;
mod reread;
mod save;
mod watch;
#[cfg(target_arch = "wasm32")]
pub(crate) mod web;

pub use dialog::{Answer, Dialog, Purpose};
pub use drop::{Found, Look};
pub use export::Export;
pub use keep::{Keep, Kept, Work, state_file};
pub use modules::{Reload, library_with};
pub use reread::Reread;
pub use save::save;
pub use watch::Watch;
