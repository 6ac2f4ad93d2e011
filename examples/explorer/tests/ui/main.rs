//! The explorer, driven by the names of what is on its screen.

mod camera;
mod choices;
mod files;
mod harness;
mod keyboard;
mod lists;
mod looks;
mod modules;
mod parameters;
mod tabs;
mod walk;
