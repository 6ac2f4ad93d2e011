//! The table of this module: transformed cosines for the lobes of anisotropic GGX.

use crate::oracles::Table;
use crate::oracles::anisotropic::{SIDES, table};

pub(super) const TABLES: &[(&str, Table)] = &[("table", || table(SIDES))];
