//! The explorer, driven by the names of what is on its screen.

mod alternatives;
mod choices;
mod compare;
mod harness;
