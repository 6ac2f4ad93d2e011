//! Pictures that must not change: other units, other scales, other orders.

use crate::view::{parse, picture, read, set};

/// A glossy ball and a box on a floor between two lamps that cast shadows and the sun, all lengths times `k` and the lamp's intensity times its square.
fn scene(k: f64, lamps: &[&str], objects: &[&str]) -> String {
    let m = |metres: f64| format!("{:?}", metres * k);
    let object = |name: &&str| match *name {
        "ball" => format!(
            r#"(mesh: "ball", material: "gloss", translate: ({}, {}, {})),"#,
            m(0.5),
            m(0.5),
            m(0.25)
        ),
        "box" => format!(r#"(mesh: "box", material: "matte", translate: ({}, {}, 0)),"#, m(-1.0), m(0.25)),
        _ => r#"(mesh: "floor", material: "matte"),"#.to_owned(),
    };
    let lamp = |name: &&str| match *name {
        "lamp" => format!(
            r#"(module: "point", fields: {{"position": ({}, {}, {}), "intensity": {:?}, "size": {}}}, visibility: (module: "cube-map", params: {{"bias": {}}})),"#,
            m(1.0),
            m(2.0),
            m(1.5),
            400.0 * k * k,
            // A thousand times it is still within the limits of the parameter.
            m(0.05),
            m(0.002),
        ),
        "cool" => format!(
            r#"(module: "point", fields: {{"position": ({}, {}, {}), "intensity": {:?}, "size": {}}}, visibility: (module: "cube-map", params: {{"bias": {}}})),"#,
            m(-2.0),
            m(1.5),
            m(0.5),
            150.0 * k * k,
            m(0.05),
            m(0.002),
        ),
        _ => r#"(module: "directional", fields: {"direction": (1, -2, 0.5), "illuminance": 30}),"#.to_owned(),
    };
    format!(
        r#"(
            camera: (eye: ({}, {}, {}), target: (0, {}, 0), fov: 45, near: {}, far: {}), size: (128, 96), pass: "forward",
            background: (3, 4, 5),
            meshes: {{
                "ball": Sphere(radius: {}), "box": Box(size: ({}, {}, {})), "floor": Plane(size: ({}, {})),
            }},
            materials: {{
                "gloss": {{"material": (module: "metalness", params: {{"base_color": (0.9, 0.3, 0.1), "roughness": 0.4}})}},
                "matte": {{"brdf": "lambert"}},
            }},
            lights: [{}], objects: [{}],
        )"#,
        m(0.5),
        m(2.0),
        m(4.0),
        m(0.4),
        m(0.1),
        m(20.0),
        m(0.5),
        m(0.5),
        m(0.5),
        m(0.5),
        m(5.0),
        m(4.0),
        lamps.iter().map(lamp).collect::<String>(),
        objects.iter().map(object).collect::<String>(),
    )
}

const LAMPS: [&str; 3] = ["lamp", "cool", "sun"];
const OBJECTS: [&str; 3] = ["ball", "box", "floor"];

/// Catches a lumen that is spread over another solid angle than 4 pi.
#[test]
fn lumen_are_candela_over_the_sphere() {
    let file = read("lambert-plane.scene.ron");
    let lumen = picture(&set(&file, &[("lights[lamp].fields.intensity", "800 lm")]));
    let candela = format!("{:?}", 800.0 / (4.0 * std::f64::consts::PI));
    let candela = picture(&set(&file, &[("lights[lamp].fields.intensity", &candela)]));
    let difference = lumen.difference(&candela);
    println!("800 lm and 63.66 cd: relative difference {difference:.2e}");
    assert!(difference < 1e-6, "{difference}");
}

/// Catches an epsilon in metres that matters, a falloff that adds 1 to the squared distance, a bias in depth instead of metres: what is a
/// thousand times larger, in light a million times as intense, looks the same. Edges of shadows may move by the rounding of the maps.
#[test]
fn a_scene_in_millimetres_looks_the_same() {
    let small = picture(&parse(&scene(1.0, &LAMPS, &OBJECTS)));
    let large = picture(&parse(&scene(1000.0, &LAMPS, &OBJECTS)));
    let different = small.texels.iter().zip(&large.texels).filter(|(a, b)| {
        let pairs = a.iter().zip(b.iter());
        pairs.clone().any(|(a, b)| (a - b).abs() > 1e-4 * a.max(*b))
    });
    let different = different.count();
    println!(
        "a thousand times larger: {different} of {} texels differ by more than 1e-4",
        small.texels.len()
    );
    assert!(different <= 12, "{different}");
}

/// Catches a light that counts for another's map or fields, and one that is lost when it is not the first of its kind.
#[test]
fn the_order_of_lights_does_not_matter() {
    let picture_of = |lamps: &[&str]| picture(&parse(&scene(1.0, lamps, &OBJECTS)));
    let given = picture_of(&LAMPS);
    for lamps in [["sun", "cool", "lamp"], ["cool", "lamp", "sun"]] {
        let difference = given.difference(&picture_of(&lamps));
        println!("lights in the order {lamps:?}: relative difference {difference:.2e}");
        // Sums of floats in another order.
        assert!(difference < 2e-6, "{lamps:?}: {difference}");
    }
    // So that it can fail: each light is seen.
    for missing in 0..3 {
        let lamps: Vec<&str> = LAMPS.iter().enumerate().filter(|(i, _)| *i != missing).map(|(_, l)| *l).collect();
        assert!(given.difference(&picture_of(&lamps)) > 0.1);
    }
}

/// Catches objects with another's transform or material, and a depth test that is left to the order of drawing.
#[test]
fn the_order_of_objects_does_not_matter() {
    let picture_of = |objects: &[&str]| picture(&parse(&scene(1.0, &LAMPS, objects)));
    let given = picture_of(&OBJECTS);
    for objects in [["floor", "box", "ball"], ["box", "floor", "ball"]] {
        assert_eq!(given.difference(&picture_of(&objects)), 0.0, "{objects:?}");
    }
    assert!(given.difference(&picture_of(&["floor", "box"])) > 0.1);
}
