//! The table of this module: transformed cosines for the lobes of ward.

use crate::oracles::cosines::{SIDE, table};
use crate::oracles::drawn::ward;
use crate::oracles::Table;

pub(super) const TABLES: &[(&str, Table)] = &[("table", || table(ward, SIDE))];
