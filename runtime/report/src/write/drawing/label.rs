//! Names of points that cover neither points nor each other.

/// A rectangle: left, top, right, bottom.
pub type Box2 = [f64; 4];

/// A point and the size of its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Named {
    pub at: [f64; 2],
    pub size: [f64; 2],
}

/// Half the side of what a point's mark covers.
const MARK: f64 = 10.0;
/// Free space around a name.
const GAP: f64 = 2.0;
/// Distances to try, between a mark and its name.
const DISTANCES: [f64; 10] = [0.0, 8.0, 18.0, 30.0, 45.0, 65.0, 90.0, 120.0, 160.0, 210.0];
/// Directions to try, the first is the best: right, left, then what lies between.
const DIRECTIONS: usize = 24;

/// A place for each name, within `bounds`; none where all are taken. Lines should not run through names, nor the line from a point to its name
/// through another, but may. Earlier points choose first.
pub fn place(named: &[Named], lines: &[[[f64; 2]; 2]], bounds: Box2) -> Vec<Option<Box2>> {
    let marks: Vec<Box2> = named.iter().map(|one| around(one.at, [2.0 * MARK, 2.0 * MARK])).collect();
    let mut taken: Vec<Box2> = Vec::new();
    let mut places = Vec::new();
    for one in named {
        let mut best: Option<(usize, Box2)> = None;
        for candidate in candidates(one) {
            let wide = [candidate[0] - GAP, candidate[1] - GAP, candidate[2] + GAP, candidate[3] + GAP];
            let is_free = inside(candidate, bounds) && !taken.iter().chain(&marks).any(|other| overlap(wide, *other));
            if !is_free {
                continue;
            }
            let leader = [one.at, nearest(candidate, one.at)];
            let crossed = lines.iter().filter(|line| crosses(**line, wide)).count()
                + taken.iter().filter(|other| runs_through(leader, **other)).count();
            if best.is_none_or(|(least, _)| crossed < least) {
                best = Some((crossed, candidate));
            }
            if crossed == 0 {
                break;
            }
        }
        taken.extend(best.map(|(_, place)| place));
        places.push(best.map(|(_, place)| place));
    }
    places
}

/// From near to far.
fn candidates(one: &Named) -> impl Iterator<Item = Box2> + '_ {
    DISTANCES.iter().flat_map(move |distance| {
        (0..DIRECTIONS).map(move |step| {
            // 0, +1, -1, +2, -2 ... of a full turn: right first.
            let turn = (step.div_ceil(2)) as f64 * if step % 2 == 0 { -1.0 } else { 1.0 } / DIRECTIONS as f64;
            let (sin, cos) = (turn * std::f64::consts::TAU).sin_cos();
            // The middle of a name whose edge is that far from the mark's.
            let across = MARK + GAP + distance + one.size[0] / 2.0;
            let down = MARK + GAP + distance + one.size[1] / 2.0;
            // On the rectangle of all middles, where the ray meets it.
            let scale = (across / cos.abs().max(1e-9)).min(down / sin.abs().max(1e-9));
            around([one.at[0] + cos * scale, one.at[1] + sin * scale], one.size)
        })
    })
}

fn around([x, y]: [f64; 2], [width, height]: [f64; 2]) -> Box2 {
    [x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0]
}

fn inside(inner: Box2, outer: Box2) -> bool {
    inner[0] >= outer[0] && inner[1] >= outer[1] && inner[2] <= outer[2] && inner[3] <= outer[3]
}

/// Whether two rectangles have an area in common.
pub fn overlap(a: Box2, b: Box2) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// Whether a horizontal or vertical line has a point in a rectangle.
fn crosses([[x0, y0], [x1, y1]]: [[f64; 2]; 2], place: Box2) -> bool {
    overlap([x0.min(x1), y0.min(y1), x0.max(x1) + 1e-3, y0.max(y1) + 1e-3], place)
}

/// Whether a short line of any direction runs through a rectangle, at one of a few places on it.
fn runs_through([[x0, y0], [x1, y1]]: [[f64; 2]; 2], place: Box2) -> bool {
    (0..=16).map(|step| f64::from(step) / 16.0).any(|part| {
        let [x, y] = [x0 + (x1 - x0) * part, y0 + (y1 - y0) * part];
        overlap([x - 0.1, y - 0.1, x + 0.1, y + 0.1], place)
    })
}

/// The point of a rectangle that is nearest to a place.
pub fn nearest([left, top, right, bottom]: Box2, [x, y]: [f64; 2]) -> [f64; 2] {
    [x.clamp(left, right), y.clamp(top, bottom)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches names over each other or over marks, also of points in one place, and names that leave the sheet.
    #[test]
    fn names_cover_nothing() {
        let size = [90.0, 14.0];
        let mut named = vec![Named { at: [300.0, 200.0], size }; 6];
        named.extend((0..6).map(|index| Named {
            at: [60.0 + 80.0 * f64::from(index), 372.0],
            size,
        }));
        let bounds = [50.0, 50.0, 500.0, 380.0];
        let places: Vec<Box2> = place(&named, &[], bounds)
            .into_iter()
            .map(|place| place.expect("a place"))
            .collect();
        for (index, one) in places.iter().enumerate() {
            assert!(inside(*one, bounds), "{one:?}");
            assert!(places.iter().skip(index + 1).all(|other| !overlap(*one, *other)), "{places:?}");
            let covered = named.iter().filter(|other| overlap(*one, around(other.at, [10.0, 10.0])));
            assert_eq!(covered.count(), 0, "{one:?}");
        }
        // Alone, a name stands at the right.
        let alone = place(&[Named { at: [100.0, 100.0], size }], &[], bounds);
        assert!(alone[0].is_some_and(|place| place[0] > 100.0 && place[0] < 115.0), "{alone:?}");
    }

    /// Catches a name without a place that is put somewhere all the same, and one on the frontier's line where there is room beside it.
    #[test]
    fn names_that_fit_nowhere_are_left_out() {
        let one = Named {
            at: [10.0, 10.0],
            size: [90.0, 14.0],
        };
        assert_eq!(place(&[one], &[], [0.0, 0.0, 40.0, 40.0]), [None]);
        let free = place(
            &[Named { at: [100.0, 100.0], ..one }],
            &[[[100.0, 100.0], [300.0, 100.0]]],
            [0.0, 0.0, 400.0, 200.0],
        );
        assert!(
            free[0].is_some_and(|place| !crosses([[100.0, 100.0], [300.0, 100.0]], place)),
            "{free:?}"
        );
    }
}
