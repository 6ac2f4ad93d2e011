//! Shadows whose umbra is known exactly: rays from the surface to the light against boxes, in double precision.

use glam::DVec3;

use crate::view::{Picture, Pinhole, frame, hdr, parse, set};

/// A box that casts and is not seen.
struct Caster {
    center: DVec3,
    half: DVec3,
}

impl Caster {
    /// As an object of the scene.
    fn object(&self, index: usize) -> String {
        let [x, y, z] = self.center.to_array();
        format!("(mesh: \"caster {index}\", material: \"matte\", translate: ({x:?}, {y:?}, {z:?}), visible: false),")
    }

    fn mesh(&self, index: usize) -> String {
        let [x, y, z] = (self.half * 2.0).to_array();
        format!("\"caster {index}\": Box(size: ({x:?}, {y:?}, {z:?})),")
    }

    /// Whether a segment of the ray from `at` passes the box, made larger by `margin` on all sides.
    fn blocks(&self, at: DVec3, ray: DVec3, margin: f64) -> bool {
        let half = self.half + margin;
        let (mut near, mut far) = (0f64, 1f64);
        for axis in 0..3 {
            let (offset, step) = ((self.center - at)[axis], ray[axis]);
            if step == 0.0 {
                if offset.abs() > half[axis] {
                    return false;
                }
                continue;
            }
            let (a, b) = ((offset - half[axis]) / step, (offset + half[axis]) / step);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        near < far
    }
}

/// What a point sees of a light: `Some(true)` all of it, `Some(false)` nothing; `None` where it is within the margin of the edge.
fn lit(casters: &[Caster], at: DVec3, ray: DVec3, margin: f64) -> Option<bool> {
    if casters.iter().any(|c| c.blocks(at, ray, -margin)) {
        return Some(false);
    }
    (!casters.iter().any(|c| c.blocks(at, ray, margin))).then_some(true)
}

/// Counts lit and dark pixels of a picture after holding it against the same without shadows.
fn compare(shadowed: &Picture, open: &Picture, lit: impl Fn(u32, u32) -> Option<(usize, bool)>) -> Vec<[usize; 2]> {
    let mut counts = Vec::new();
    for (column, row) in shadowed.pixels() {
        let Some((part, lit)) = lit(column, row) else { continue };
        let (found, all) = (shadowed.grey(column, row), open.grey(column, row));
        assert!(all > 0.0, "{column} {row} is dark without shadows");
        if lit {
            assert!(
                (found / all - 1.0).abs() < 1e-6,
                "{column} {row} of part {part}: {found}, not {all}"
            );
        } else {
            assert!(found == 0.0, "{column} {row} of part {part}: {found} in the umbra");
        }
        counts.resize(counts.len().max(part + 1), [0; 2]);
        counts[part][usize::from(lit)] += 1;
    }
    counts
}

/// Half of the room's side, m.
const ROOM: f64 = 2.0;

/// Catches a face of the cube map that is missing, turned, mirrored, in another's place or not drawn; depth that is measured along the ray; a
/// bias that lets light through or darkens walls; seams between faces. A lamp in a room, a box before each of the six walls, each of another
/// size and off the axis in another way.
///
/// The margin, at the box: the receiver is lifted by at most the 3 texels of `normal_offset`, the comparison reaches a texel beside it and the map's
/// own edges lie within half a texel; 5 texels of 2 (2.2 m) / 1024 at the wall are .022 m, and the boxes stand at half the way.
#[test]
fn a_lamp_in_a_room_casts_on_all_walls() {
    let lamp = DVec3::new(0.1, -0.05, 0.15);
    let casters: Vec<Caster> = (0..6)
        .map(|i| {
            let mut center = DVec3::splat(0.0);
            let (axis, k) = (i / 2, i as f64);
            center[axis] = if i % 2 == 0 { 1.1 } else { -1.1 };
            center[(axis + 1) % 3] = 0.1 + 0.05 * k;
            center[(axis + 2) % 3] = -0.2 - 0.03 * k;
            let mut half = DVec3::splat(0.02);
            half[(axis + 1) % 3] = 0.12 + 0.02 * k;
            half[(axis + 2) % 3] = 0.24 - 0.02 * k;
            Caster { center, half }
        })
        .collect();
    let walls = [
        "translate: (2, 0, 0), rotate: (0, 0, 90)",
        "translate: (-2, 0, 0), rotate: (0, 0, -90)",
        "translate: (0, 2, 0), rotate: (180, 0, 0)",
        "translate: (0, -2, 0)",
        "translate: (0, 0, 2), rotate: (-90, 0, 0)",
        "translate: (0, 0, -2), rotate: (90, 0, 0)",
    ];
    let objects: String = casters.iter().enumerate().map(|(i, c)| c.object(i)).collect();
    let meshes: String = casters.iter().enumerate().map(|(i, c)| c.mesh(i)).collect();
    let walls: String = walls.map(|wall| format!("(mesh: \"wall\", material: \"matte\", {wall}),")).concat();
    let file = parse(&format!(
        r#"(
            camera: (eye: (0.3, -0.2, 0.1), target: (2, 0, 0), fov: 100, near: 0.01, far: 20), size: (160, 128), pass: "forward",
            meshes: {{"wall": Plane(size: (4, 4)), {meshes}}},
            materials: {{"matte": {{"material": (module: "metalness", params: {{"base_color": (0.5, 0.5, 0.5)}}), "brdf": "lambert"}}}},
            lights: [(
                name: "lamp", module: "point", visibility: "cube-map",
                fields: {{"position": ({}, {}, {}), "intensity": "100 cd"}},
            )],
            objects: [{objects} {walls}],
        )"#,
        lamp.x, lamp.y, lamp.z
    ));
    let mut counts = vec![[0; 2]; 6];
    for (target, up) in [
        ("(2, 0, 0)", "(0, 1, 0)"),
        ("(-2, 0, 0)", "(0, 1, 0)"),
        ("(0, 2, 0)", "(0, 0, 1)"),
        ("(0, -2, 0)", "(0, 0, 1)"),
        ("(0, 0, 2)", "(0, 1, 0)"),
        ("(0, 0, -2)", "(0, 1, 0)"),
    ] {
        let file = set(&file, &[("camera.target", target), ("camera.up", up)]);
        let open = set(&file, &[("lights[lamp].casts_shadow", "false")]);
        let camera = Pinhole::of(&file);
        let seen = compare(&hdr(&frame(&file)), &hdr(&frame(&open)), |column, row| {
            let ray = camera.ray(column, row);
            let beyond = |axis: usize| (ROOM * ray[axis].signum() - camera.eye[axis]) / ray[axis];
            let axis = (0..3).min_by(|a, b| beyond(*a).total_cmp(&beyond(*b)))?;
            let at = camera.eye + ray * beyond(axis);
            let wall = 2 * axis + usize::from(ray[axis] < 0.0);
            // In a corner the other wall's texels begin within the same margin.
            let beside = at[(axis + 1) % 3].abs().max(at[(axis + 2) % 3].abs());
            (beside < ROOM - 0.022).then_some(())?;
            Some((wall, lit(&casters, at, lamp - at, 0.015)?))
        });
        for (sum, seen) in counts.iter_mut().zip(seen) {
            *sum = [sum[0] + seen[0], sum[1] + seen[1]];
        }
    }
    println!("cube map: [dark, lit] pixels by wall {counts:?}");
    assert!(counts.iter().all(|[dark, lit]| *dark > 100 && *lit > 10_000), "{counts:?}");
}

/// Two boxes above the ground.
const ABOVE_GROUND: [Caster; 2] = [
    Caster {
        center: DVec3::new(1.0, 1.5, 0.5),
        half: DVec3::new(0.5, 0.25, 0.75),
    },
    Caster {
        center: DVec3::new(-1.5, 0.7, -1.0),
        half: DVec3::new(0.3, 0.7, 0.4),
    },
];

/// Counts dark and lit pixels of the ground under the boxes in this light, where the camera sees points that count.
fn shadows_on_the_ground(light: &str, ray: impl Fn(DVec3) -> DVec3, counts: impl Fn(DVec3) -> bool) -> [usize; 2] {
    let objects: String = ABOVE_GROUND.iter().enumerate().map(|(i, c)| c.object(i)).collect();
    let meshes: String = ABOVE_GROUND.iter().enumerate().map(|(i, c)| c.mesh(i)).collect();
    let file = parse(&format!(
        r#"(
            camera: (eye: (0, 9, 3), target: (0, 0, 0), fov: 50), size: (160, 128), pass: "forward",
            meshes: {{"ground": Plane(size: (10, 10)), {meshes}}},
            materials: {{"matte": {{"material": (module: "metalness", params: {{"base_color": (0.5, 0.5, 0.5)}}), "brdf": "lambert"}}}},
            lights: [(name: "light", visibility: "perspective", {light})],
            objects: [{objects} (mesh: "ground", material: "matte")],
        )"#
    ));
    let open = set(&file, &[("lights[light].casts_shadow", "false")]);
    let camera = Pinhole::of(&file);
    let found = compare(&hdr(&frame(&file)), &hdr(&frame(&open)), |column, row| {
        let view = camera.ray(column, row);
        let at = camera.eye - view * (camera.eye.y / view.y);
        (at.x.abs().max(at.z.abs()) < 4.98 && counts(at)).then_some(())?;
        Some((0, lit(&ABOVE_GROUND, at, ray(at), 0.08)?))
    });
    found[0]
}

/// Catches a map that is mirrored, turned, too small for the scene or empty, and light that leaks or ground that shadows itself: two boxes
/// above the ground, in slanting light.
///
/// The margin: 5 texels as for the cube map, of 2 (7.3 m) / 1022, are .071 m across the rays; the boxes' sides lie askew to the rays, but their outline
/// moves by no less than the margin across them.
#[test]
fn the_sun_casts_on_the_ground() {
    let direction = DVec3::new(-1.0, -2.0, -0.5);
    for module in ["directional", "sun"] {
        let light = format!(r#"module: "{module}", fields: {{"direction": (-1, -2, -0.5), "illuminance": 1000}}"#);
        let [dark, lit] = shadows_on_the_ground(&light, |_| direction * -10.0, |_| true);
        println!("{module} map: [dark, lit] pixels {:?}", [dark, lit]);
        assert!(dark > 400 && lit > 10_000, "{module}: {dark} dark, {lit} lit");
    }
}

/// Catches a map that is narrower than the cone, or as wide as its whole angle to each side is not, and one that looks elsewhere: the boxes under a spot.
///
/// The margin: 5 texels of 2 tan(38 deg) (6.9 m) / 1024 are .053 m.
#[test]
fn a_spot_casts_on_the_ground() {
    let (place, axis) = (DVec3::new(0.6, 6.0, 1.2), DVec3::new(-0.1, -1.0, -0.2));
    let light = r#"module: "spot", fields: {
        "position": (0.6, 6, 1.2), "direction": (-0.1, -1, -0.2), "inner": "20 deg", "outer": "38 deg", "intensity": 1000,
    }"#;
    let within = |at: DVec3| (at - place).angle_between(axis) < 37f64.to_radians();
    let [dark, lit] = shadows_on_the_ground(light, |at| place - at, within);
    println!("spot map: [dark, lit] pixels {:?}", [dark, lit]);
    assert!(dark > 400 && lit > 4000, "{dark} dark, {lit} lit");
}
