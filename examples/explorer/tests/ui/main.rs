//! The explorer, driven by the names of what is on its screen.

mod choices;
mod harness;
mod tabs;
