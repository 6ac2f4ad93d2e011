//! What a view draws: culled, sorted, and equal neighbours joined into instanced draws.

use std::ops::Range;
use std::sync::Arc;

use super::view::Eye;
use super::{Bounds, Draw};

/// A run of draws that differ only in their transforms.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// One of them, an index into the frame's draws.
    pub draw: usize,
    /// Their places in [`List::order`], and so in the `objects` buffer.
    pub objects: Range<u32>,
}

/// Which draws are in the lists at all.
#[derive(Clone, Copy, Default)]
pub(crate) struct Cut<'a> {
    /// Also those outside of the view: what may be drawn once the camera or an object moves.
    pub whole: bool,
    /// By material: `true` where there is nothing yet to draw it with. What lies beyond the end is there.
    pub absent: &'a [bool],
    /// Only programs that are compiled already.
    pub at_once: bool,
}

impl Cut<'_> {
    fn keeps(&self, draw: &Draw, bounds: &Bounds, eye: &Eye) -> bool {
        (self.whole || eye.sees(bounds)) && !self.lacks(draw.material)
    }

    /// Whether a material is left out.
    pub fn lacks(&self, material: usize) -> bool {
        self.absent.get(material).copied().unwrap_or(false)
    }
}

/// Draws of one view in the order in which they are drawn.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct List {
    /// Indices into the frame's draws.
    pub order: Vec<usize>,
    pub runs: Vec<Run>,
}

/// World-space boxes of all draws.
pub(crate) fn world_bounds(draws: &[Draw]) -> Vec<Bounds> {
    draws.iter().map(|d| d.bounds.transformed(&d.model)).collect()
}

/// Whether the transform turns the front to the back.
pub(crate) fn is_mirrored(draw: &Draw) -> bool {
    draw.model.determinant() < 0.0
}

/// What must be equal for two draws to be one.
fn key(draw: &Draw) -> (usize, usize, bool, bool, bool) {
    (
        draw.material,
        Arc::as_ptr(&draw.mesh).addr(),
        draw.double_sided,
        draw.alpha_blend,
        is_mirrored(draw),
    )
}

impl List {
    /// What the camera sees: opaque draws grouped, the groups and their members front to back, then blended draws back to front.
    pub fn of_camera(draws: &[Draw], bounds: &[Bounds], eye: &Eye, cut: &Cut) -> Self {
        let seen = |i: &usize| draws[*i].visible && cut.keeps(&draws[*i], &bounds[*i], eye);
        let depth = |i: usize| eye.depth_of(bounds[i].center());
        let (mut blended, opaque): (Vec<_>, Vec<_>) = (0..draws.len()).filter(seen).partition(|i| draws[*i].alpha_blend);
        blended.sort_by(|a, b| depth(*b).total_cmp(&depth(*a)));
        let mut order = grouped(draws, opaque, depth);
        order.extend(blended);
        Self::of(draws, order)
    }

    /// What a shadow map sees: casters, grouped.
    pub fn of_casters(draws: &[Draw], bounds: &[Bounds], eye: &Eye, cut: &Cut) -> Self {
        let seen = (0..draws.len())
            .filter(|i| draws[*i].casts_shadow && cut.keeps(&draws[*i], &bounds[*i], eye))
            .collect();
        Self::of(draws, grouped(draws, seen, |i| eye.depth_of(bounds[i].center())))
    }

    fn of(draws: &[Draw], order: Vec<usize>) -> Self {
        let mut runs: Vec<Run> = Vec::new();
        for (place, draw) in (0u32..).zip(&order) {
            match runs.last_mut() {
                Some(run) if key(&draws[run.draw]) == key(&draws[*draw]) => run.objects.end += 1,
                _ => runs.push(Run {
                    draw: *draw,
                    objects: place..place + 1,
                }),
            }
        }
        Self { order, runs }
    }
}

/// Front to back, members of a group together where its nearest one stands.
fn grouped(draws: &[Draw], mut seen: Vec<usize>, depth: impl Fn(usize) -> f32) -> Vec<usize> {
    seen.sort_by(|a, b| depth(*a).total_cmp(&depth(*b)));
    let mut groups = indexmap::IndexMap::<_, Vec<usize>>::new();
    for draw in seen {
        groups.entry(key(&draws[draw])).or_default().push(draw);
    }
    groups.into_values().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Camera, Mesh};
    use glam::{Mat4, Vec3};

    fn draw(mesh: &Arc<Mesh>, z: f32) -> Draw {
        Draw {
            mesh: Arc::clone(mesh),
            material: 0,
            model: Mat4::from_translation(Vec3::new(0.0, 0.0, z)),
            bounds: Bounds {
                min: Vec3::splat(-0.1),
                max: Vec3::splat(0.1),
            },
            visible: true,
            alpha_blend: false,
            double_sided: false,
            casts_shadow: true,
        }
    }

    fn eye() -> Eye {
        let camera = Camera {
            view: Mat4::IDENTITY,
            projection: glam::camera::rh::proj::directx::perspective(1.0, 1.0, 0.1, 100.0),
        };
        Eye::of_camera(&camera, [8, 8], 0.0)
    }

    /// Catches wrong order of either kind, a culled object that is seen or the reverse, and draws that are not joined.
    #[test]
    fn camera_list_is_culled_sorted_and_batched() {
        let (a, b) = (Arc::new(Mesh::default()), Arc::new(Mesh::default()));
        let blend = |z| Draw {
            alpha_blend: true,
            ..draw(&a, z)
        };
        let mirrored = Draw {
            model: Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * draw(&a, -7.0).model,
            ..draw(&a, 0.0)
        };
        let hidden = Draw {
            visible: false,
            ..draw(&a, -1.0)
        };
        let draws = [
            blend(-2.0),
            draw(&a, -6.0),
            draw(&b, -4.0),
            draw(&a, -3.0),
            draw(&a, 5.0),
            hidden,
            blend(-9.0),
            mirrored,
        ];
        let list = List::of_camera(&draws, &world_bounds(&draws), &eye(), &Cut::default());
        assert_eq!(
            list.order,
            [3, 1, 2, 7, 6, 0],
            "opaque near to far by group, then blended far to near"
        );
        let runs: Vec<_> = list.runs.iter().map(|r| (r.draw, r.objects.clone())).collect();
        assert_eq!(runs, [(3, 0..2), (2, 2..3), (7, 3..4), (6, 4..6)]);
        let casters = List::of_casters(&draws, &world_bounds(&draws), &eye(), &Cut::default());
        assert!(
            casters.order.contains(&5) && !casters.order.contains(&4),
            "the invisible one casts, the one behind does not"
        );
        let whole = Cut {
            whole: true,
            ..Cut::default()
        };
        let list = List::of_camera(&draws, &world_bounds(&draws), &eye(), &whole);
        assert!(
            list.order.contains(&4) && !list.order.contains(&5),
            "the one behind may be seen later"
        );
        let absent = Cut { absent: &[true], ..whole };
        assert_eq!(List::of_casters(&draws, &world_bounds(&draws), &eye(), &absent), List::default());
    }
}
