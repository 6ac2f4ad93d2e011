//! The times of the last pictures, part by part.

use std::collections::VecDeque;
use std::time::Duration;

use indexmap::IndexMap;

use crate::work::{Painted, Times};

/// Pictures that are remembered.
const MOST: usize = 200;

/// The parts by their names, in the order in which they come.
pub type History = IndexMap<String, Series>;

/// What is remembered of the pictures.
#[derive(Debug, Default)]
pub struct TimingState {
    /// The version that was measured last.
    pub measured: Option<u64>,
    history: History,
    /// How many there were.
    count: usize,
    has_passes: bool,
}

/// One part over the last pictures.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Number of the picture, and milliseconds.
    values: VecDeque<(usize, f64)>,
    /// It is a pass on the GPU, or all of it.
    pub is_plotted: bool,
}

/// What the values of a part are like, ms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The newest.
    pub last: f64,
    /// Half of them are smaller.
    pub median: f64,
    /// A quarter of them is smaller.
    pub quarter: f64,
    /// Three quarters of them are smaller.
    pub three_quarters: f64,
}

impl TimingState {
    /// Remembers a picture.
    pub fn take(&mut self, painted: &Painted) {
        self.add(&painted.times);
    }

    fn add(&mut self, times: &Times) {
        let ms = |duration: Duration| duration.as_secs_f64() * 1e3;
        let cpu = &times.cpu;
        let parts = [
            ("derive", times.derive),
            ("link", cpu.link),
            ("pipelines", cpu.pipelines),
            ("record", cpu.record),
            ("GPU", times.gpu),
            ("choice to picture", times.all),
        ];
        for (name, duration) in parts {
            self.push(name, ms(duration), name == "GPU");
        }
        let mut passes: IndexMap<&str, f64> = IndexMap::new();
        for pass in &times.passes {
            *passes.entry(together(&pass.name)).or_default() += pass.nanoseconds / 1e6;
        }
        self.has_passes |= !passes.is_empty();
        for (name, ms) in passes {
            self.push(name, ms, true);
        }
        self.count += 1;
        // What no picture of the last ones had is of another scene.
        let first = self.count.saturating_sub(MOST);
        for series in self.history.values_mut() {
            while series.values.front().is_some_and(|(picture, _)| *picture < first) {
                series.values.pop_front();
            }
        }
        self.history.retain(|_, series| !series.values.is_empty());
    }

    fn push(&mut self, name: &str, ms: f64, is_plotted: bool) {
        let series = self.history.entry(name.to_owned()).or_default();
        series.is_plotted = is_plotted;
        series.values.push_back((self.count, ms));
    }

    /// All that is remembered.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether the device tells what passes take.
    pub fn has_passes(&self) -> bool {
        self.has_passes
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// The views of a shadow map count as one pass.
fn together(name: &str) -> &str {
    name.split_once(", view ").map_or(name, |(map, _)| map)
}

impl Series {
    /// Number of the picture, and milliseconds.
    pub fn values(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.values.iter().copied()
    }

    /// What they are like; `None` where there are none.
    pub fn spread(&self) -> Option<Spread> {
        let mut sorted: Vec<f64> = self.values.iter().map(|(_, ms)| *ms).collect();
        sorted.sort_by(f64::total_cmp);
        let last = self.values.back()?.1;
        // Between the two nearest.
        let at = |share: f64| {
            let place = share * (sorted.len() - 1) as f64;
            let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
            low + (high - low) * place.fract()
        };
        Some(Spread {
            last,
            median: at(0.5),
            quarter: at(0.25),
            three_quarters: at(0.75),
        })
    }
}

#[cfg(test)]
mod tests {
    use shadewright_runtime::frame::PassTime;

    use super::*;

    /// Catches times that pile up for ever, a median of the unsorted, views of a shadow map told apart, and passes of a scene that is gone.
    #[test]
    fn the_last_pictures_are_remembered() {
        let mut state = TimingState::default();
        let pass = |name: &str, nanoseconds| PassTime {
            name: name.into(),
            nanoseconds,
        };
        let times = |ms: u64, passes| Times {
            gpu: Duration::from_millis(ms),
            passes,
            ..Times::default()
        };
        state.add(&times(
            5,
            vec![
                pass("shadow map of lamp 1, view 1 of 2", 1e6),
                pass("shadow map of lamp 1, view 2 of 2", 2e6),
            ],
        ));
        assert_eq!(state.history()["shadow map of lamp 1"].spread().unwrap().last, 3.0);
        for ms in [9, 1, 7, 3] {
            state.add(&times(ms, Vec::new()));
        }
        let spread = state.history()["GPU"].spread().unwrap();
        assert_eq!(
            (spread.last, spread.median, spread.quarter, spread.three_quarters),
            (3.0, 5.0, 3.0, 7.0)
        );
        for _ in 0..MOST {
            state.add(&times(2, Vec::new()));
        }
        assert_eq!(state.history()["GPU"].values().count(), MOST);
        assert!(!state.history().contains_key("shadow map of lamp 1"));
        assert_eq!(state.history()["GPU"].spread().unwrap().median, 2.0);
        assert!(state.has_passes());
        state.clear();
        assert!(state.history().is_empty());
    }
}
