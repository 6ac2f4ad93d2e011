//! Uniform samples without repetition, the same for the same seed on every machine.

use std::collections::BTreeSet;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::Rng;

/// So many different numbers below `count`, ascending (Floyd's algorithm: Bentley and Floyd 1987, A Sample of Brilliance). All of them
/// where there are no more.
pub fn distinct(count: u128, number: usize, seed: u64) -> Vec<u128> {
    if number as u128 >= count {
        return (0..count).collect();
    }
    let mut random = Pcg64::new(u128::from(seed), 0);
    let mut found = BTreeSet::new();
    for last in count - number as u128..count {
        let drawn = up_to(&mut random, last);
        if !found.insert(drawn) {
            found.insert(last);
        }
    }
    found.into_iter().collect()
}

/// A number from 0 to `last`, all equally probable: what falls beyond is drawn again.
fn up_to(random: &mut Pcg64, last: u128) -> u128 {
    let mask = u128::MAX.checked_shr(last.leading_zeros()).unwrap_or(0);
    loop {
        let drawn = (u128::from(random.next_u64()) << 64 | u128::from(random.next_u64())) & mask;
        if drawn <= last {
            return drawn;
        }
    }
}
