//! The explorer, driven by the names of what is on its screen.

#![allow(clippy::unwrap_used)]

mod alternatives;
mod camera;
mod choices;
mod compare;
mod files;
mod harness;
mod keyboard;
mod lists;
mod looks;
mod modules;
mod parameters;
mod tabs;
mod walk;
