//! No NaN and no infinite number, in the example scenes as they are and where nothing is as it should be.

use std::sync::Arc;

use glam::{Mat4, Vec3};
use shadewright::runtime::frame::{Bounds, Draw, Mesh};

use crate::view::{Picture, example, frame, hdr, parse, read, set};

/// Share of texels that show some light.
fn lit(picture: &Picture) -> f64 {
    let lit = picture.texels.iter().filter(|t| t[..3].iter().any(|c| *c > 0.0)).count();
    lit as f64 / picture.texels.len() as f64
}

/// Catches a NaN or an infinite number in any example scene, at its own size; the small ones are all in the runtime's tests.
#[test]
fn example_scenes_are_finite() {
    let folder = example("");
    let mut drawn = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let name = entry.expect("an entry").file_name().into_string().expect("UTF-8");
        if name.ends_with(".scene.ron") {
            let picture = hdr(&frame(&read(&name)));
            assert_eq!(picture.bad(), 0, "{name}");
            assert!(lit(&picture) > 0.2, "{name}");
            drawn += 1;
        }
    }
    assert!(drawn >= 3, "{drawn}");
}

/// A room with lights and camera wherever one must not put them: a shadowed lamp inside a ball, one at a vertex of the floor, one in the floor's plane, one
/// at the eye, one at the middle of a tile; mirror-smooth and fully rough surfaces; a ball of a micrometre, a plane of 100 km, a plate squeezed to
/// 1e-8 of its height; a sun from straight below and one along the floor; intensities up to the limit.
const HOSTILE: &str = r#"(
    camera: (eye: (0.1, 0.6, 0.3), target: (0, 0, -2), fov: 120, near: 0.0001, far: 1000), size: (160, 120), pass: "forward",
    meshes: {
        "ball": Sphere(radius: 0.5), "box": Box(size: (1.5, 1.5, 1.5)), "floor": Plane(size: (4, 4), segments: (4, 4)),
        "tile": Plane(size: (1, 1)), "far": Plane(size: (100000, 100000)), "cone": Cone(radius: 0.3, height: 0.6),
    },
    materials: {
        "mirror": {"material": (module: "metalness", params: {"base_color": (1, 1, 1), "metalness": 1, "roughness": 0})},
        "rough": {"material": (module: "metalness", params: {"roughness": 1, "reflectance": 1})},
        "black": {"material": (module: "metalness", params: {"base_color": (0, 0, 0), "roughness": 0, "reflectance": 0})},
        "glow": {"material": (module: "metalness", params: {"emission": 1e10, "opacity": 0})},
    },
    lights: [
        (name: "inside", module: "point", visibility: (module: "cube-map", fill: {"filtering": "pcf"}),
            fields: {"position": (-1, 0.5, -1), "intensity": 1e9, "size": 0.0001}),
        (name: "vertex", module: "point", visibility: (module: "cube-map", fill: {"filtering": "pcf"}),
            fields: {"position": (1, 0, -1), "intensity": 1e9, "size": 0.0001}),
        (name: "in the floor", module: "point", fields: {"position": (0.5, 0, -0.5), "intensity": 1e9, "size": 0.0001, "range": 1e-9}),
        (name: "eye", module: "point", fields: {"position": (0.1, 0.6, 0.3), "intensity": 1e9, "size": 0.0001, "color": (100, 0, 1)}),
        (name: "far", module: "point", fields: {"position": (1e12, 1e12, 0), "intensity": 1e9, "range": 1e9}),
        (name: "below", module: "directional", visibility: "perspective", fields: {"direction": (0, 1e-12, 0), "illuminance": 1e9}),
        (name: "along", module: "directional", visibility: "perspective", fields: {"direction": (1e18, 0, 0), "illuminance": 1e9}),
    ],
    objects: [
        (mesh: "ball", material: "mirror", translate: (-1, 0.5, -1), double_sided: true),
        (mesh: "box", material: "rough", translate: (0.1, 0.6, 0.3), double_sided: true, alpha_blend: BLEND),
        (mesh: "floor", material: "mirror"),
        (mesh: "floor", material: "rough", translate: (0, 0, 0), rotate: (180, 0, 0)),
        (mesh: "far", material: "rough", translate: (0, -1, 0)),
        (mesh: "tile", material: "black", translate: (0.5, 0, -0.5), rotate: (90, 0, 0), double_sided: true),
        (mesh: "ball", material: "mirror", translate: (0.1, 0.6, 0.2995), scale: (1e-6, 1e-6, 1e-6)),
        (mesh: "ball", material: "rough", translate: (1.2, 0.7, -1.5), scale: (1, 1e-8, 1)),
        (mesh: "cone", material: "mirror", translate: (0.3, 0.5, -1), scale: (-1, 1e3, 1e-3), double_sided: true),
        (mesh: "tile", material: "glow", translate: (0, 0.2, -0.5), alpha_blend: true),
    ],
)"#;

/// Triangles without area: three corners in one place, and three on a line; with a normal of no length.
fn slivers() -> Draw {
    let mesh = Mesh {
        positions: vec![[0.0; 3], [0.0; 3], [0.0; 3], [-1.0, 0.5, 0.0], [0.0, 0.5, 0.0], [1.0, 0.5, 0.0]],
        normals: vec![[0.0; 3]; 6],
        tangents: vec![[0.0; 4]; 6],
        uvs: vec![[0.0; 2]; 6],
        indices: vec![0, 1, 2, 3, 4, 5, 3, 3, 5],
    };
    Draw {
        bounds: Bounds::of(mesh.positions.iter().map(|p| Vec3::from(*p))).expect("finite"),
        mesh: Arc::new(mesh),
        material: 0,
        model: Mat4::from_translation(Vec3::new(0.0, 0.3, -1.0)),
        visible: true,
        alpha_blend: false,
        double_sided: true,
        casts_shadow: true,
    }
}

/// Catches 0 / 0 of a direction of no length, of a window of no width, of a facet at alpha 0, of masking at the horizon; an overflow of 1 / d^2;
/// depths of a map whose light stands in its own scene; a normal that interpolates to nothing.
#[test]
fn a_hostile_scene_is_finite() {
    for blend in ["false", "true"] {
        let file = parse(&HOSTILE.replace("BLEND", blend));
        for (eye, target, fov) in [
            ("(0.1, 0.6, 0.3)", "(0, 0, -2)", "120"),
            // Inside the ball, and in the floor's plane, and from below.
            ("(-1.1, 0.5, -1)", "(-1, 0.5, -1)", "120"),
            ("(-1.9, 0, 1.9)", "(0, 0, 0)", "120"),
            ("(0.3, -0.5, 0.2)", "(0, 0, -0.5)", "120"),
            // Into the mirror below, so near that normal and half vector are one in 32 bits: a light stands at the eye.
            ("(0.2, 0.5, 0.4)", "(0.2, 0, 0.401)", "1"),
        ] {
            let mut frame = frame(&set(
                &file,
                &[
                    ("camera.eye", eye),
                    ("camera.target", target),
                    ("camera.fov", fov),
                    ("lights[eye].fields.position", eye),
                ],
            ));
            frame.draws.push(slivers());
            let picture = hdr(&frame);
            assert_eq!(picture.bad(), 0, "from {eye}, blended {blend}");
            let most = picture.texels.iter().flatten().fold(0f32, |a, b| a.max(*b));
            println!(
                "hostile scene from {eye}: {:.0} % lit, {most:.3e} cd/m2 at most",
                100.0 * lit(&picture)
            );
            assert!(lit(&picture) > 0.05, "from {eye}");
        }
    }
}
