//! From the HDR frame to the display image, against the same chain in double precision.

use std::path::Path;
use std::sync::Arc;

use glam::DVec3;
use shadewright::compiler::Catalog;
use shadewright::modules::{Folder, Overlay, library};
use shadewright::runtime::frame::Renderer;
use shadewright::runtime::scene::SceneFile;

use crate::view::{GPU, example, parse, read, set};
use shadewright::modules::oracles::display::{log_average, luminance, reinhard_color, saturation_luminance, srgb_encode};

/// A pass that shows the bits of the exposure's 32-bit float in the four channels of its image, and a material that emits a number given by
/// its bits: what the standard library does not need, and what shows that a display pass is a module like any other.
const MODULES: [(&str, &str); 4] = [
    (
        "pass/meter/module.ron",
        r#"(summary: "Shows the exposure's bits", slots: {"exposure": (interface: "exposure", default: "manual", doc: "What is shown")})"#,
    ),
    (
        "pass/meter/meter.wgsl",
        r"
        struct VertexIn { @builtin(vertex_index) vertex: u32 }
        struct VertexOut { @builtin(position) clip: vec4f }
        struct FragmentOut { @location(0) color: vec4f }

        @vertex
        fn vertex_main(in: VertexIn) -> VertexOut {
            var out: VertexOut;
            out.clip = vec4f(f32((in.vertex & 1u) << 2u) - 1.0, f32((in.vertex & 2u) << 1u) - 1.0, 0.0, 1.0);
            return out;
        }

        @fragment
        fn fragment_main() -> FragmentOut {
            var out: FragmentOut;
            out.color = unpack4x8unorm(bitcast<u32>(exposure()));
            return out;
        }
        ",
    ),
    (
        "material/bits/module.ron",
        r#"(summary: "Emits a float given by its bits", params: {"bits": (type: U32, default: 0, doc: "Bits of the emitted radiance")})"#,
    ),
    (
        "material/bits/bits.wgsl",
        r"
        fn surface(at: Fragment) -> Surface {
            var s: Surface;
            s.position = at.position;
            s.normal = at.normal;
            s.geometric_normal = at.normal;
            s.alpha = 1.0;
            s.emission = vec3f(bitcast<f32>(params.bits));
            s.opacity = 1.0;
            return s;
        }
        ",
    ),
];

/// The standard library with these modules beside it.
fn catalog(folder: &Path) -> Arc<Catalog> {
    for (file, text) in MODULES {
        let file = folder.join(file);
        std::fs::create_dir_all(file.parent().expect("a folder")).expect("made");
        std::fs::write(file, text).expect("written");
    }
    let both = Overlay(vec![Arc::new(Folder::new(folder)), library()]);
    Arc::new(Catalog::load(Arc::new(both)).unwrap_or_else(|e| panic!("{e}")))
}

/// A scene's HDR frame and its display image.
fn both(catalog: &Arc<Catalog>, file: &SceneFile) -> (Vec<[f32; 4]>, Vec<[u8; 4]>) {
    let frame = file.frame(catalog, None).unwrap_or_else(|e| panic!("{e}"));
    let targets = Renderer::new(&GPU, Arc::clone(catalog))
        .render(&frame)
        .unwrap_or_else(|e| panic!("{e}"));
    let image = targets.read_display(&GPU).unwrap().expect("a display image");
    (targets.read_hdr(&GPU).unwrap(), image.as_chunks::<4>().0.to_vec())
}

fn color(texel: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(texel[0]), f64::from(texel[1]), f64::from(texel[2]))
}

/// What the display image must hold, in steps of a byte.
fn displayed(texel: [f32; 4], exposure: f64, white: f64) -> [f64; 3] {
    let exposed = reinhard_color(color(texel) * exposure, white);
    exposed.to_array().map(|c| 255.0 * srgb_encode(c.clamp(0.0, 1.0)))
}

/// Exposed like a photograph at this EV100, the luminance that saturates the sensor being 1.
fn check_chain(hdr: &[[f32; 4]], image: &[[u8; 4]], exposure: f64, white: f64) -> f64 {
    let mut worst = 0f64;
    for (i, (texel, pixel)) in hdr
        .iter()
        .zip(image)
        .enumerate()
        .filter(|(_, (t, _))| t.iter().all(|v| v.is_finite()))
    {
        for (found, expected) in pixel.iter().zip(displayed(*texel, exposure, white)) {
            let off = (f64::from(*found) - expected).abs();
            assert!(off < 0.51, "texel {i}: {texel:?} became {pixel:?}, not {expected}");
            worst = worst.max(off);
        }
        assert_eq!(pixel[3], 255);
    }
    worst
}

/// Catches an exposure without its factor 1.2, a curve per channel instead of on luminance, a white that is not squared, an encoding by a power of
/// 2.2 or twice, and red for blue: all pixels of two scenes.
#[test]
fn display_pixels_are_the_chain_of_the_hdr_pixels() {
    let folder = tempfile::tempdir().expect("a folder");
    let catalog = catalog(folder.path());
    let first = set(&read("first.scene.ron"), &[("size", "(240, 135)")]);
    let curve = r#"(module: "reinhard", params: {"white": 2.0})"#;
    let sphere = set(&read("ggx-sphere.scene.ron"), &[("post[0].fill.curve", curve)]);
    for (file, ev100, white) in [(first, 6.1, 3.0), (sphere, 8.0, 2.0)] {
        let (hdr, image) = both(&catalog, &file);
        let worst = check_chain(&hdr, &image, 1.0 / saturation_luminance(ev100), white);
        let shades: std::collections::HashSet<u8> = image.iter().map(|p| p[1]).collect();
        println!(
            "display: {worst:.4} of a byte's step at most, {} shades of green in {} pixels",
            shades.len(),
            image.len()
        );
        assert!(shades.len() > 150, "{}", shades.len());
    }
}

/// The exposure that a scene's display pass used: the bits that the pass `meter` shows.
fn metered(image: &[[u8; 4]]) -> f64 {
    assert!(image.iter().all(|pixel| *pixel == image[0]), "the exposure is one number");
    f64::from(f32::from_bits(u32::from_le_bytes(image[0])))
}

/// Key 0.18 over the logarithmic mean of all texels without NaN and infinity, negative luminance taken as 0, 1e-4 cd/m2 added.
fn expected_exposure(hdr: &[[f32; 4]]) -> f64 {
    let finite = hdr.iter().filter(|t| t[..3].iter().all(|v| v.is_finite()));
    let luminances: Vec<f64> = finite.map(|t| luminance(color(*t)).max(0.0)).collect();
    0.18 / log_average(&luminances, 1e-4)
}

const METER: &str = r#"(module: "meter", fill: {"exposure": "log-average"})"#;

/// Catches texels that are counted twice or not at all (sizes that are no multiple of a workgroup, more workgroups than partial sums, a single
/// texel), a mean that is divided by the wrong number, and a sum in which the dark texels get lost.
#[test]
fn log_average_exposure_is_that_of_the_frame() {
    let folder = tempfile::tempdir().expect("a folder");
    let catalog = catalog(folder.path());
    for (scene, size) in [
        ("first.scene.ron", "(240, 135)"),
        ("ggx-sphere.scene.ron", "(128, 128)"),
        ("lambert-plane.scene.ron", "(403, 301)"),
        ("lambert-plane.scene.ron", "(1, 1)"),
    ] {
        let text = std::fs::read_to_string(example(scene)).expect("a scene");
        let file = set(&parse(&without_post(&text)), &[("size", size), ("display", METER)]);
        let (hdr, image) = both(&catalog, &file);
        let (found, expected) = (metered(&image), expected_exposure(&hdr));
        let error = (found / expected - 1.0).abs();
        println!("log average of {scene} at {size}: exposure {expected:.6}, relative error {error:.2e}");
        assert!(error < 1e-4, "{scene}: {found}, not {expected}");
    }
}

/// The scene without its chain of post effects, which belongs to another display pass.
fn without_post(text: &str) -> String {
    let (before, rest) = text.split_once("    post: [").expect("a chain");
    let mut depth = 1;
    let end = rest.find(|c| {
        depth += i32::from(c == '[') - i32::from(c == ']');
        depth == 0
    });
    format!("{before}{}", &rest[end.expect("its end") + 2..])
}

/// Tiles that emit these numbers, on a background of 20 cd/m2.
fn hostile_tiles(numbers: &[f32]) -> SceneFile {
    let materials: String = numbers
        .iter()
        .enumerate()
        .map(|(i, n)| {
            format!(
                "\"{i}\": {{\"material\": (module: \"bits\", params: {{\"bits\": {}}})}},",
                n.to_bits()
            )
        })
        .collect();
    let objects: String = (0..numbers.len())
        .map(|i| format!("(mesh: \"tile\", material: \"{i}\", translate: ({}, 0, 0)),", i as f64 - 4.0))
        .collect();
    parse(&format!(
        r#"(
            camera: (eye: (0, 10, 0), target: (0, 0, 0), up: (0, 0, -1), fov: 40), size: (96, 48), pass: "forward", display: "display",
            background: (20, 20, 20), meshes: {{"tile": Plane(size: (0.8, 0.8))}}, materials: {{{materials}}}, objects: [{objects}],
        )"#
    ))
}

/// Catches a NaN that spreads over the picture by the mean, a clamp that a compiler takes away because there is no NaN, and an overflow of
/// what is only very bright.
#[test]
fn one_bad_texel_spoils_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let catalog = catalog(folder.path());
    let numbers = [f32::NAN, f32::INFINITY, 0.0, 65504.0, 3e38, -5.0, f32::NEG_INFINITY, 1e-40];
    let file = hostile_tiles(&numbers);
    let (hdr, image) = both(&catalog, &set(&file, &[("display", METER)]));
    let holds = |test: fn(f32) -> bool| hdr.iter().filter(|t| test(t[0])).count();
    assert!(holds(f32::is_nan) > 10 && holds(f32::is_infinite) > 20 && holds(|v| v > 1e38) > 10 && holds(|v| v == 65504.0) > 10);
    let exposure = expected_exposure(&hdr);
    let found = metered(&image);
    println!("a frame with NaN and infinity: exposure {found:.6}, {exposure:.6} expected");
    assert!((found / exposure - 1.0).abs() < 1e-4, "{found}, not {exposure}");

    let exposed = |by: &str| {
        let post = format!(r#"[(module: "tonemap", fill: {{"exposure": "{by}", "curve": "reinhard"}})]"#);
        both(&catalog, &set(&file, &[("post", &post)]))
    };
    for (by, exposure) in [("log-average", exposure), ("manual", 1.0 / saturation_luminance(12.0))] {
        let (hdr, image) = exposed(by);
        check_chain(&hdr, &image, exposure, 4.0);
        let shown = |number: usize| {
            hdr.iter()
                .zip(&image)
                .find(|(t, _)| t[0].to_bits() == numbers[number].to_bits())
                .map(|(_, p)| *p)
        };
        // Infinity is what overflowed: white, not a black hole in the sun. Less than nothing is black.
        for (number, value) in [(1, 255), (4, 255), (6, 0)] {
            assert_eq!(shown(number), Some([value, value, value, 255]), "{}", numbers[number]);
        }
    }
}
