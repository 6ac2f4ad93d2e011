//! Looks for the largest value of a function over the unit cube, from the best of given points.
//!
//! Samples find where an error is large, a search how large. It is an evolution strategy (Rechenberg 1973) whose step shrinks by a fixed
//! schedule: the errors of floating-point arithmetic are too rough for anything that trusts a slope.

use super::MeasureError;
use super::sample::Random;

/// How hard to look.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Best points to start from.
    pub parents: usize,
    /// Steps tried from each in a generation.
    pub children: usize,
    /// Generations; the step falls from a tenth of the cube to a millionth of it.
    pub generations: u32,
}

/// The best point and its value; none where there is no point to start from. `value` gives a value for each point; an infinite one ends the search.
pub(crate) fn search(
    start: &[(Vec<f64>, f64)],
    effort: Effort,
    random: &mut Random,
    mut value: impl FnMut(&[Vec<f64>]) -> Result<Vec<f64>, MeasureError>,
) -> Result<Option<(Vec<f64>, f64)>, MeasureError> {
    let mut parents: Vec<(Vec<f64>, f64)> = start.to_vec();
    parents.sort_by(|a, b| b.1.total_cmp(&a.1));
    parents.truncate(effort.parents);
    let is_flat = parents.first().is_none_or(|(point, _)| point.is_empty());
    let generations = if is_flat { 0 } else { effort.generations };
    for generation in 0..generations {
        if parents.first().is_some_and(|best| best.1.is_infinite()) {
            break;
        }
        let progress = f64::from(generation) / f64::from(effort.generations.max(2) - 1);
        let step = 0.1 * 1e-5_f64.powf(progress);
        let mut children = Vec::with_capacity(parents.len() * effort.children);
        for (point, _) in &parents {
            for child in 0..effort.children {
                children.push(stepped(point, step, child % 2 == 0, random));
            }
        }
        let values = value(&children)?;
        // Each parent competes with its own children: the search stays at several places.
        for (place, (children, values)) in children.chunks(effort.children).zip(values.chunks(effort.children)).enumerate() {
            for (child, value) in children.iter().zip(values) {
                if *value > parents[place].1 {
                    parents[place] = (child.clone(), *value);
                }
            }
        }
    }
    Ok(parents.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)))
}

/// A point near another: one coordinate moved, or all. What leaves the cube stops at its side, where the hard cases are.
fn stepped(point: &[f64], step: f64, one: bool, random: &mut Random) -> Vec<f64> {
    let chosen = random.below(point.len());
    let moved = |(index, x): (usize, &f64)| {
        if one && index != chosen {
            return *x;
        }
        (x + step * (2.0 * random.unit() - 1.0)).clamp(0.0, 1.0)
    };
    point.iter().enumerate().map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const EFFORT: Effort = Effort {
        parents: 4,
        children: 16,
        generations: 24,
    };

    fn peak(at: [f64; 2], point: &[f64]) -> f64 {
        1.0 / (1e-3 + (point[0] - at[0]).abs() + (point[1] - at[1]).abs())
    }

    /// Catches a search that does not climb, or one that cannot reach the cube's side.
    #[test]
    fn finds_a_narrow_peak() {
        for at in [[0.37, 0.81], [0.0, 1.0]] {
            let mut random = Random::new(1, 1);
            let start: Vec<_> = super::super::sample::latin(2, 64, &mut random)
                .into_iter()
                .map(|p| (p.clone(), peak(at, &p)))
                .collect();
            let sampled = start.iter().map(|s| s.1).fold(0.0, f64::max);
            let best = search(&start, EFFORT, &mut random, |points| {
                Ok(points.iter().map(|p| peak(at, p)).collect())
            });
            let (_, found) = best.unwrap().unwrap();
            assert!(found > 500.0 && sampled < 100.0, "{sampled} {found}");
        }
    }

    /// Catches a search that fails without coordinates or points.
    #[test]
    fn nothing_to_search() {
        let mut random = Random::new(1, 1);
        let none = search(&[], EFFORT, &mut random, |_| panic!("nothing to evaluate"));
        assert_eq!(none.unwrap(), None);
        let flat = search(&[(Vec::new(), 2.0)], EFFORT, &mut random, |_| panic!("nothing to evaluate"));
        assert_eq!(flat.unwrap(), Some((Vec::new(), 2.0)));
    }
}
