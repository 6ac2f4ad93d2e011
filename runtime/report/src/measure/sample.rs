//! Points of the unit cube.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;

/// A stream of numbers that a seed and a purpose decide, and nothing else.
pub(crate) struct Random(Pcg64);

impl Random {
    /// A stream of its own for each purpose.
    pub fn new(seed: u64, purpose: u64) -> Self {
        Self(Pcg64::new(u128::from(seed), u128::from(purpose)))
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        // 53 bits are what a double holds.
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In [0, 1), as an f32: rounded, a double may become 1.
    pub fn single(&mut self) -> f32 {
        (self.0.next_u64() >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In 0..count; 0 of none.
    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }
}

/// Latin hypercube (McKay, Beckman and Conover 1979): along each coordinate, every one of `count` equal parts holds one point.
pub(crate) fn latin(dimensions: usize, count: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut points = vec![vec![0.0; dimensions]; count];
    for dimension in 0..dimensions {
        let mut parts: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            parts.swap(last, random.below(last + 1));
        }
        for (point, part) in points.iter_mut().zip(parts) {
            point[dimension] = (part as f64 + random.unit()) / count as f64;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches points that leave a part of a coordinate empty, and a seed that decides nothing.
    #[test]
    fn every_part_holds_a_point() {
        let points = latin(3, 50, &mut Random::new(7, 0));
        for dimension in 0..3 {
            let mut parts: Vec<usize> = points.iter().map(|p| (p[dimension] * 50.0) as usize).collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..50).collect::<Vec<_>>());
        }
        assert_eq!(points, latin(3, 50, &mut Random::new(7, 0)));
        assert_ne!(points, latin(3, 50, &mut Random::new(8, 0)));
        assert_ne!(points, latin(3, 50, &mut Random::new(7, 1)));
        // The coordinates are shuffled each for itself.
        assert!(points.iter().any(|p| (p[0] * 50.0) as usize != (p[1] * 50.0) as usize));
    }
}
