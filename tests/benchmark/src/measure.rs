//! Candidates measured in turns, so that a slow moment of the machine hits all of them.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Something whose time is taken.
pub struct Candidate<'a> {
    /// What it does.
    pub name: String,
    run: Box<dyn FnMut() -> Result<Duration, String> + 'a>,
}

impl<'a> Candidate<'a> {
    /// Times `make`; dropping what it made is not counted.
    pub fn new<T>(name: &str, mut make: impl FnMut() -> Result<T, String> + 'a) -> Self {
        Self::with_input(name, || (), move |()| make())
    }

    /// Times `make` alone: neither getting its input ready is counted, nor dropping what it made.
    pub fn with_input<I, T>(name: &str, mut input: impl FnMut() -> I + 'a, mut make: impl FnMut(I) -> Result<T, String> + 'a) -> Self {
        Self {
            name: name.to_owned(),
            run: Box::new(move || {
                let input = input();
                let start = Instant::now();
                let made = black_box(make(black_box(input)));
                let time = start.elapsed();
                made.map(|_| time)
            }),
        }
    }
}

/// Times of one candidate, one for each round, in seconds.
#[derive(Clone, Debug)]
pub struct Times {
    /// The candidate's name.
    pub name: String,
    /// In the order of the rounds.
    pub seconds: Vec<f64>,
}

impl Times {
    /// The share `p` of all times is at most this long.
    pub fn percentile(&self, p: f64) -> f64 {
        percentile(&self.seconds, p)
    }

    /// Median of the ratios to another candidate's time in the same round.
    pub fn ratio_to(&self, other: &Self) -> f64 {
        let ratios: Vec<f64> = self.seconds.iter().zip(&other.seconds).map(|(a, b)| a / b).collect();
        percentile(&ratios, 0.5)
    }
}

fn percentile(values: &[f64], p: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let index = (p * (sorted.len().saturating_sub(1)) as f64).round() as usize;
    sorted.get(index).copied().unwrap_or(f64::NAN)
}

/// How often a candidate runs in its turn: the middle time counts. Once would measure how much of it the others left in the processor's
/// caches, which who makes many shaders does not pay.
const TURN: usize = 5;

/// Gives every candidate a turn each round. Each round starts with another one and goes on in another order, so that nobody always comes
/// after the same one. A round before the first is not counted.
///
/// # Errors
/// A candidate fails; says which.
pub fn rounds(mut candidates: Vec<Candidate>, rounds: usize) -> Result<Vec<Times>, String> {
    let count = candidates.len();
    let mut times: Vec<Times> = candidates
        .iter()
        .map(|candidate| Times {
            name: candidate.name.clone(),
            seconds: Vec::with_capacity(rounds),
        })
        .collect();
    let strides: Vec<usize> = (1..=count).filter(|&stride| divisor(stride, count) == 1).collect();
    for round in 0..=rounds {
        for turn in 0..count {
            let index = (round + turn * strides[round % strides.len()]) % count;
            let candidate = &mut candidates[index];
            let mut turns = Vec::with_capacity(TURN);
            for _ in 0..TURN {
                let time = (candidate.run)().map_err(|error| format!("{}: {error}", candidate.name))?;
                turns.push(time.as_secs_f64());
            }
            if round > 0 {
                times[index].seconds.push(percentile(&turns, 0.5));
            }
        }
    }
    Ok(times)
}

/// Greatest common divisor: steps of a stride that shares none with the count reach everyone.
fn divisor(a: usize, b: usize) -> usize {
    if b == 0 { a } else { divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(seconds: &[f64]) -> Times {
        Times {
            name: String::new(),
            seconds: seconds.to_vec(),
        }
    }

    /// Catches a median of unsorted times, and ratios of the wrong rounds.
    #[test]
    fn percentiles_and_ratios() {
        let a = times(&[9.0, 1.0, 4.0, 2.0, 3.0]);
        assert_eq!([0.0, 0.5, 1.0].map(|p| a.percentile(p)), [1.0, 3.0, 9.0]);
        assert_eq!(a.ratio_to(&times(&[3.0, 1.0, 1.0, 1.0, 1.0])), 3.0, "of 3, 1, 4, 2, 3");
    }

    /// Catches rounds that leave a candidate out, count the first round, or always have the same order.
    #[test]
    fn every_candidate_has_its_turn() {
        let order = std::cell::RefCell::new(Vec::new());
        let candidate = |name: &'static str| {
            let order = &order;
            Candidate::new(name, move || {
                order.borrow_mut().push(name);
                Ok(())
            })
        };
        let names = ["a", "b", "c"];
        let times = rounds(names.map(candidate).into(), 3).unwrap();
        assert_eq!(
            times.iter().map(|t| (t.name.as_str(), t.seconds.len())).collect::<Vec<_>>(),
            names.map(|n| (n, 3))
        );
        let mut order = order.into_inner();
        order.dedup();
        // A round before, then three; where a round ends with whom the next begins, one name stands for both.
        assert_eq!(order.concat(), "abcbacabacb");
        let failing = Candidate::new("c", || Err::<(), _>("no".to_owned()));
        assert_eq!(rounds(vec![failing], 1).unwrap_err(), "c: no");
    }
}
