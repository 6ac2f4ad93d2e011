//! What calls executed, one of each row.

use shadewright_evaluate::{Counts, Kind};

use crate::data::Executed;

/// Means and the largest over the rows.
pub(crate) fn executed(counts: &[Counts]) -> Executed {
    let rows = counts.len().max(1) as f64;
    let mean = |of: &dyn Fn(&Counts) -> f64| counts.iter().map(of).sum::<f64>() / rows;
    Executed {
        mean: mean(&Counts::weighted),
        max: counts.iter().map(Counts::weighted).fold(0.0, f64::max),
        trips: mean(&|counts| counts[Kind::Trip] as f64),
        texture: mean(&|counts| counts[Kind::Texture] as f64),
    }
}
