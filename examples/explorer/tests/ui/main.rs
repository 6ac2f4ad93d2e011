//! The explorer, driven by the names of what is on its screen.

#![allow(clippy::unwrap_used)]

mod alternatives;
mod camera;
mod choices;
mod compare;
mod files;
mod harness;
mod keyboard;
mod modules;
mod parameters;
mod walk;
