//! The table of this module: transformed cosines for the lobes of ggx.

use crate::oracles::cosines::{SIDE, table};
use crate::oracles::drawn::ggx;
use crate::oracles::Table;

pub(super) const TABLES: &[(&str, Table)] = &[("table", || table(ggx, SIDE))];
