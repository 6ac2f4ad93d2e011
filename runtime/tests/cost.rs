//! What functions of the standard library cost, counted by hand.

#![allow(clippy::unwrap_used)]

use shadewright_compiler::{Catalog, Recipe};
use shadewright_evaluate::Kind;
use shadewright_evaluate::cost::{Analysis, Cost};
use shadewright_runtime::probe::Probe;

fn cost(recipe: &str, function: &str) -> Analysis {
    let catalog = Catalog::load(shadewright_modules::library()).unwrap();
    Probe::new(&catalog, &Recipe::parse("test", recipe).unwrap(), function)
        .unwrap()
        .cost()
}

/// Catches operations of the standard library's central function that are lost or counted twice, and the probe's own.
///
/// By hand, as add, multiply, divide, root, select:
///
/// | | + | x | / | root | select |
/// |---|---|---|---|---|---|
/// | `brdf`: two cosines (2 + 3 each), each against 0; `not` | 4 | 6 | | | 2 + 1 |
/// | v + l, twice; length, halved; D x V; F x that (3); + diffuse (3) | 6 + 2 + 3 | 3 + 1 + 1 + 3 | | 1 | |
/// | `unit_or`: v.v; floor; root; times it; against 1e-30; 3 chosen by one condition | 2 | 3 + 3 | | 1 | 1 + 1 + 3 |
/// | `distribution`: n.h; h - n; n x that; alpha cos; squares of both and their sum; floor; quotient; k k / pi; against 0; choice | 2 + 3 + 3 + 2 + 1 | 3 + 6 + 1 + 1 + 3 + 2 | 1 | | 3 |
/// | `masking`: n.v, n.l, each against 0; `not`; alpha^2; twice: 1 - a2, two products, + a2, root, product; sum; floor; quotient | 4 + 4 + 1 | 6 + 1 + 6 | 1 | 2 | 2 + 1 + 1 |
/// | `fresnel`: 1 - cos; clamped; x2; x^5; 1 - f0; times; + f0 | 1 + 3 + 3 | 1 + 2 + 3 | | | 2 |
/// | `diffuse` / pi; two cosines, each against 0; 3 chosen by one condition | 4 | 3 + 6 | | | 2 + 3 |
/// | sum | 48 | 64 | 2 | 4 | 22 |
///
/// `a && b` looks at b only if a, `a || b` only if not a: a branch each, and a `not`, before that of the `if`, in `brdf` and in `masking`; in `diffuse` a
/// branch alone.
#[test]
fn microfacet_by_hand() {
    let expected = Cost {
        add: 48,
        multiply: 64,
        divide: 2,
        root: 4,
        select: 22,
        branches: 5,
        ..Cost::default()
    };
    let found = cost("\"microfacet\"", "brdf");
    assert_eq!(found.cost, expected);
    // 48 + 64 + 22 + 5, and 4 (2 + 4).
    assert_eq!(found.cost.weighted(), 163.0);
    assert_eq!(found.loops, []);
}

/// Catches a choice that does not change what is counted, and bindings that are the table's.
#[test]
fn choices_change_the_cost() {
    let lambert = cost("\"lambert\"", "brdf").cost;
    assert_eq!(
        lambert,
        Cost {
            add: 4,
            multiply: 9,
            select: 5,
            branches: 1,
            ..Cost::default()
        }
    );
    // A parameter that is not frozen is in a uniform buffer.
    let exposure = |recipe: &str| cost(recipe, "exposure").cost;
    let (free, frozen) = (exposure("\"manual\""), exposure("(module: \"manual\", freeze: {\"ev100\": 3.0})"));
    assert_eq!((free.uniform_bytes, free.bindings), (4, 1));
    assert_eq!((frozen.uniform_bytes, frozen.bindings), (0, 0));
    assert_eq!((free.transcendental, free.divide), (1, 1));
}

/// Catches loops whose trips are lost when a constant of the recipe is linked in: a radius of r makes (2 r + 1)^2 comparisons.
#[test]
fn frozen_loops_have_trips() {
    for (radius, side) in [(1, 3), (2, 5), (8, 17)] {
        let found = cost(&format!("(module: \"pcf\", freeze: {{\"radius\": {radius}}})"), "filter_shadow");
        let trips: Vec<_> = found.loops.iter().map(|l| (l.function.as_str(), l.trips, l.leaves)).collect();
        assert_eq!(trips, [("pcf_filter_shadow", Some(side), false); 2], "radius {radius}");
        // The comparison with the edge is one and a choice, beside which each trip has that of its loop's end, and the outer ones have theirs.
        let comparisons = u64::from(side * side);
        assert_eq!(found.unrolled[Kind::Select], 3 * comparisons + u64::from(side));
        assert_eq!((found.cost.select, found.cost.loops), (4, 2));
    }
}
