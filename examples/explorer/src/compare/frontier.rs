//! What is worth its cost.

/// Numbers of the points that no other one beats in both coordinates, by their first coordinate. Points that are no numbers beat nothing and are beaten.
pub fn frontier(points: &[[f64; 2]]) -> Vec<usize> {
    let is_number = |point: &[f64; 2]| point.iter().all(|x| x.is_finite());
    let beats = |a: &[f64; 2], b: &[f64; 2]| is_number(a) && a[0] <= b[0] && a[1] <= b[1] && a != b;
    let is_best = |point: &[f64; 2]| is_number(point) && !points.iter().any(|other| beats(other, point));
    let mut best: Vec<usize> = (0..points.len()).filter(|index| is_best(&points[*index])).collect();
    best.sort_by(|a, b| points[*a][0].total_cmp(&points[*b][0]));
    best
}
