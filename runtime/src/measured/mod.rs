//! Measured reflectance: tables of a BRDF in the two file formats that the published collections have.
//!
//! ```text
//! bytes -> Merl: half and difference angles, a grid        (merl)
//! bytes -> fields of a tensor file                         (tensor)
//!       -> Rgl: a grid that follows the material's lobe    (rgl, its warp in warp)
//! either -> samples: directions with what was measured there
//!        -> floats: what a shader's table holds
//! ```
//!
//! Directions are unit vectors over the surface's z axis; `v` is where one looks from, `l` where light comes from. Values are 1/sr for each
//! channel of linear Rec.709, without the cosine.

mod merl;
mod rgl;
mod tabulate;
mod tensor;
mod warp;

use glam::{DQuat, DVec3};

pub use merl::Merl;
pub use rgl::Rgl;
pub use tabulate::{Facets, tabulate};
pub use tensor::{Field, Numbers, write as write_tensors};

/// Turns by this angle never repeat, and fill the circle evenly from the first ones on: pi (3 - sqrt 5).
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// A file is not what it should be. Said is the first place where that shows.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("byte {at}: expected {expected}, found {found}")]
pub struct Damaged {
    /// Bytes from the beginning of the file.
    pub at: usize,
    /// What should be there.
    pub expected: String,
    /// What is there.
    pub found: String,
}

impl Damaged {
    fn new(at: usize, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self {
            at,
            expected: expected.into(),
            found: found.into(),
        }
    }
}

/// A pair of directions and what was measured there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// To the viewer.
    pub v: DVec3,
    /// To the light.
    pub l: DVec3,
    /// The BRDF by channel, 1/sr.
    pub value: [f64; 3],
}

/// A table of either format.
#[allow(clippy::large_enum_variant, reason = "one exists for a file, and its numbers are elsewhere")]
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// Matusik et al. 2003.
    Merl(Merl),
    /// Dupuy and Jakob 2018.
    Rgl(Rgl),
}

impl Measured {
    /// Reads a file of either format; it is told by its first bytes.
    ///
    /// # Errors
    /// The file is neither, or is damaged.
    pub fn read(bytes: &[u8]) -> Result<Self, Damaged> {
        if bytes.starts_with(tensor::MAGIC) {
            Rgl::read(bytes).map(Self::Rgl)
        } else {
            Merl::read(bytes).map(Self::Merl)
        }
    }

    /// The table for a shader, as the module of its format reads it.
    pub fn floats(&self) -> Vec<f32> {
        match self {
            Self::Merl(table) => table.floats(),
            Self::Rgl(table) => table.floats(),
        }
    }

    /// Name of the format, for people.
    pub fn format(&self) -> &'static str {
        match self {
            Self::Merl(_) => "half and difference angles (Matusik et al. 2003)",
            Self::Rgl(_) => "adaptive parameterisation (Dupuy and Jakob 2018)",
        }
    }

    /// At most so many of the measured values, where no direction is farther than `most` radians from the normal: spread evenly over the table's
    /// own grid, always the same ones. What the file marks as invalid is not among them.
    ///
    /// Those of an isotropic table are turned about the normal, each otherwise: a model with a direction of its own finds none in it.
    pub fn samples(&self, count: usize, most: f64) -> Vec<Sample> {
        let (mut samples, is_isotropic) = match self {
            Self::Merl(table) => (table.samples(count, most), true),
            Self::Rgl(table) => (table.samples(count, most), table.is_isotropic()),
        };
        if is_isotropic {
            for (index, sample) in samples.iter_mut().enumerate() {
                let turn = DQuat::from_rotation_z(index as f64 * GOLDEN_ANGLE);
                (sample.v, sample.l) = (turn * sample.v, turn * sample.l);
            }
        }
        samples
    }
}

/// Different indices below `sizes`, in an order that fills the grid evenly from its first ones on: Roberts's additive recurrence, which
/// generalises the golden ratio (Roberts 2018, The Unreasonable Effectiveness of Quasirandom Sequences). All of them where they are at most `count`.
fn spread<const N: usize>(sizes: [usize; N], count: usize, mut use_it: impl FnMut([usize; N]) -> bool) {
    let all: usize = sizes.iter().product();
    let unravel = |mut index: usize| {
        let mut at = [0; N];
        for axis in (0..N).rev() {
            at[axis] = index % sizes[axis];
            index /= sizes[axis];
        }
        at
    };
    if all <= count {
        (0..all).for_each(|index| {
            use_it(unravel(index));
        });
        return;
    }
    // The positive root of x^(N + 1) = x + 1, by its fixed point.
    let root = (0..64).fold(1.5f64, |x, _| (1.0 + x).powf(1.0 / (N as f64 + 1.0)));
    let mut taken = std::collections::HashSet::new();
    let mut used = 0;
    // Of a table whose cells are mostly refused not all are asked.
    for step in 1..=count.saturating_mul(32) {
        if used == count {
            return;
        }
        let at: [usize; N] = std::array::from_fn(|axis| {
            let turned = 0.5 + step as f64 * root.powi(-(axis as i32 + 1));
            ((turned.fract() * sizes[axis] as f64) as usize).min(sizes[axis] - 1)
        });
        if taken.insert(at) && use_it(at) {
            used += 1;
        }
    }
}

/// Whether both directions are at most `most` radians from the normal.
fn is_within(v: DVec3, l: DVec3, most: f64) -> bool {
    v.z.min(l.z) >= most.cos()
}

#[cfg(test)]
mod tests;
