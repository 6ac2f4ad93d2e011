//! What each flag of an object does, seen at single pixels.

use std::f64::consts::PI;

use crate::view::{Picture, parse, picture, set};

/// Looks straight down on a lit floor: 64 pixels are 4 m, x to the right, z down; the middle of the picture is the origin.
fn scene(objects: &str) -> String {
    format!(
        r#"(
            camera: (eye: (0, 10, 0), target: (0, 0, 0), up: (0, 0, -1), fov: 22.619864948, near: 0.1, far: 30), size: (64, 64), pass: "forward",
            background: (4, 4, 4),
            meshes: {{"floor": Plane(size: (3, 3)), "tile": Plane(size: (1, 1))}},
            materials: {{
                "matte": {{"material": (module: "metalness", params: {{"base_color": (0.5, 0.5, 0.5)}}), "brdf": "lambert"}},
                "glow": {{"material": (module: "metalness", params: {{"base_color": (0.5, 0.5, 0.5), "emission": 7.0}}), "brdf": "lambert"}},
                "front": {{"material": (module: "metalness", params: {{"emission": 10.0, "opacity": 0.25}})}},
                "back": {{"material": (module: "metalness", params: {{"emission": 100.0, "opacity": 0.5}})}},
            }},
            lights: [(
                name: "sun", module: "directional", visibility: "perspective",
                fields: {{"direction": (0, -1, 0), "illuminance": 100}},
            )],
            objects: [{objects}],
        )"#
    )
}

/// Radiance of the matte floor in full light.
const LIT: f64 = 0.5 / PI * 100.0;
const FLOOR: &str = r#"(name: "floor", mesh: "floor", material: "matte"),"#;

fn shown(objects: &str) -> Picture {
    picture(&parse(&scene(objects)))
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-5 * expected.abs(), "{found}, not {expected}");
}

/// The pixels of these tests: the picture's middle, a place of the floor beside it, and one beside the floor.
const MIDDLE: (u32, u32) = (32, 32);
const BESIDE: (u32, u32) = (14, 32);
const OUTSIDE: (u32, u32) = (2, 32);

fn at(picture: &Picture, (column, row): (u32, u32)) -> f64 {
    picture.grey(column, row)
}

/// Catches blending that is premultiplied, front to back, in the order of the file, or over what hides it; all
/// sums are exact, in half floats, too.
#[test]
fn alpha_blend_lies_over_what_is_behind_back_to_front() {
    let blend = |material: &str, height: f64| {
        format!("(mesh: \"tile\", material: \"{material}\", translate: (0, {height:?}, 0), alpha_blend: true, receives_light: false),")
    };
    let (front, back) = (blend("front", 2.0), blend("back", 1.0));
    for objects in [format!("{front}{back}"), format!("{back}{front}")] {
        let picture = shown(&objects);
        assert_eq!(at(&picture, MIDDLE), 0.25 * 10.0 + 0.75 * (0.5 * 100.0 + 0.5 * 4.0), "{objects}");
        assert_eq!(at(&picture, OUTSIDE), 4.0);
    }
    assert_eq!(at(&shown(&front), MIDDLE), 0.25 * 10.0 + 0.75 * 4.0);
    // An opaque object, named last: between the two it hides the one behind, above both it hides both.
    let opaque = |height: f64| format!("(mesh: \"tile\", material: \"glow\", translate: (0, {height:?}, 0), receives_light: false),");
    assert_eq!(
        at(&shown(&format!("{front}{back}{}", opaque(1.5))), MIDDLE),
        0.25 * 10.0 + 0.75 * 7.0
    );
    assert_eq!(at(&shown(&format!("{front}{back}{}", opaque(3.0))), MIDDLE), 7.0);
    // Not asked for, opacity is none.
    assert_eq!(at(&shown(&front.replace("alpha_blend: true, ", "")), MIDDLE), 10.0);
}

/// Catches back faces that are drawn without being asked for, or not drawn; and a back that is lit through from the front.
#[test]
fn double_sided_objects_have_a_lit_back() {
    // Turned over: the camera sees the floor's back.
    let turned = r#"(name: "floor", mesh: "floor", material: "matte", rotate: (180, 0, 0), casts_shadow: false, double_sided: BOTH),"#;
    let one = parse(&scene(&turned.replace("BOTH", "false")));
    assert_eq!(at(&picture(&one), MIDDLE), 4.0);
    let both = parse(&scene(&turned.replace("BOTH", "true")));
    near(at(&picture(&both), MIDDLE), LIT);
    let from_below = set(&both, &[("lights[sun].fields.direction", "(0, 1, 0)")]);
    assert_eq!(at(&picture(&from_below), MIDDLE), 0.0);
}

/// Catches light on what receives none, and emission that is lost with it.
#[test]
fn objects_that_receive_no_light_only_glow() {
    let glow = r#"(mesh: "floor", material: "glow", receives_light: RECEIVES),"#;
    near(at(&shown(&glow.replace("RECEIVES", "true")), MIDDLE), LIT + 7.0);
    assert_eq!(at(&shown(&glow.replace("RECEIVES", "false")), MIDDLE), 7.0);
    // It still casts: the floor below it is dark.
    let tile = r#"(mesh: "tile", material: "glow", translate: (0, 1, 0), receives_light: false, visible: false),"#;
    assert_eq!(at(&shown(&format!("{FLOOR}{tile}")), MIDDLE), 0.0);
}

/// Catches shadows of what casts none, and none of what casts; `visible: false`, which still casts, and which must not be drawn.
#[test]
fn casting_and_being_seen_are_apart() {
    let tile = |casts: bool, visible: bool| {
        let tile = format!("(mesh: \"tile\", material: \"glow\", translate: (0, 1, 0), casts_shadow: {casts}, visible: {visible}),");
        shown(&format!("{FLOOR}{tile}"))
    };
    for (casts, visible, middle) in [
        (true, true, LIT + 7.0),
        (false, true, LIT + 7.0),
        (true, false, 0.0),
        (false, false, LIT),
    ] {
        let picture = tile(casts, visible);
        near(at(&picture, MIDDLE), middle);
        near(at(&picture, BESIDE), LIT);
        assert_eq!(at(&picture, OUTSIDE), 4.0);
    }
    // The shadow of a seen caster, in slanting light: it falls 1 m to the left.
    let slanting = |casts: bool| {
        let tile = format!("(mesh: \"tile\", material: \"glow\", translate: (0, 1, 0), casts_shadow: {casts}),");
        let file = parse(&scene(&format!("{FLOOR}{tile}")));
        at(&picture(&set(&file, &[("lights[sun].fields.direction", "(-1, -1, 0)")])), BESIDE)
    };
    assert_eq!(slanting(true), 0.0);
    near(slanting(false), LIT * 0.5f64.sqrt());
}
