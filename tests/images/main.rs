//! Pictures against closed forms: what a scene's pixels must be is computed in double precision from the scene's own numbers.

#![allow(clippy::expect_used, clippy::unwrap_used)]

mod display;
mod flags;
mod hostile;
mod maps;
mod plane;
mod shadows;
mod sphere;
#[path = "../support/mod.rs"]
mod support;
mod units;
mod view;
