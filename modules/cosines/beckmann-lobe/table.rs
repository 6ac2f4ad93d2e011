//! The table of this module: transformed cosines for the lobes of beckmann.

use crate::oracles::cosines::{SIDE, table};
use crate::oracles::drawn::beckmann;
use crate::oracles::Table;

pub(super) const TABLES: &[(&str, Table)] = &[("table", || table(beckmann, SIDE))];
