//! An interactive explorer of shading permutations: one scene, every choice that it leaves, and what each costs and gets wrong.
//!
//! ```text
//! scene text -> rows of choices -> an edit -> scene text -> frame -> picture, code, costs, errors
//! (document)    (tree)             (panels)   (document)    (work)   (panels)
//! ```
//!
//! - [`document`]: the scene's text, changed by edits that can be undone. The text is all there is: what is saved, sent and kept over a crash.
//! - [`tree`]: the modules that stand in the scene, and what else could stand in their places.
//! - [`work`]: whatever takes longer than a frame of the window, done beside it.
//! - [`compare`]: what is true, and how far from it a picture is.
//! - [`files`]: scenes, pictures, modules and what is kept between two starts.
//! - [`link`]: a scene as the address of a page.
//! - [`panels`]: what is on the screen.
//! - [`App`]: all of it together.

#![forbid(unsafe_code)]

mod app;
pub mod compare;
pub mod document;
pub mod files;
pub mod link;
pub mod panels;
pub mod scenes;
#[cfg(not(target_arch = "wasm32"))]
pub mod serve;
mod setup;
pub mod tree;
pub mod work;

pub use app::{App, Lanes, Problem, Start, subject};
pub use setup::setup;
