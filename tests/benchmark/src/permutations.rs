//! Permutations of the forward pass, as many as are wanted.

use shadewright_compiler::space::Space;
use shadewright_compiler::{Catalog, Recipe, Report};

/// Every slot open, some parameters frozen.
const SPACE: &str = include_str!("../growth.space.ron");

/// Another one would give other permutations.
const SEED: u64 = 1;

/// So many different recipes with the forward pass at their root, drawn at random from `growth.space.ron`: the same every time.
///
/// # Errors
/// The space does not fit the library, or has fewer legal permutations.
pub fn permutations(catalog: &Catalog, count: usize) -> Result<Vec<Recipe>, String> {
    let said = |report: Report| report.render();
    let space = Space::parse(catalog, "growth.space.ron", SPACE).map_err(said)?;
    let legal = space.count().map_err(said)?;
    if legal < count as u128 {
        return Err(format!("growth.space.ron has {legal} legal permutations, not {count}"));
    }
    let drawn = space.random(count, SEED).map_err(said)?;
    let permutations = drawn.into_iter().filter_map(|index| space.get(index));
    Ok(permutations.map(|permutation| permutation.recipe).collect())
}
