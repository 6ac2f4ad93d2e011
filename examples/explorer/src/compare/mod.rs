//! Comparing: permutations that are kept, a second picture beside the first, what is true, and how far from it each choice is.
//!
//! ```text
//! present scene ------------> picture A --+
//! pin, or the truth's scene -> picture B --+-> errors -> heat map, numbers
//! (pins)      (truth)         (work)          (values)
//! ```

mod frontier;
mod pins;
mod reference;
mod state;
mod stored;
#[cfg(test)]
mod tests;
mod truth;
mod values;

pub use frontier::frontier;
pub use pins::{Pin, Pins, Thumbnail, features, name_of};
pub use reference::{Left, Reference, Replaced, reference, with_camera_of};
pub use state::{Beside, Compare, Drawn, Mode, Other, Refined, Screen, SweepView, Told};
pub use stored::Stored;
pub use truth::{Truth, Truths};
pub use values::{Errors, Values, describe, short};
