//! Every module's WGSL, run on the device, against the oracles in double precision: over grids that hold the hard cases, with a
//! bound on the relative error, and without a NaN or an infinity anywhere.

// A helper that fails is a test that fails.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod common;

use common::probe;
use glam::DVec3;
use indexmap::IndexMap;
use serde_json::{Value as Json, json};
use shadewright::compiler::Library;
use shadewright::compiler::manifest::{ModuleManifest, Node, ParamMode, Value};
use shadewright::modules::cases::{self, Case, Expected};
use shadewright::modules::oracles::quadrature::{direction, hemisphere};
use shadewright::modules::oracles::{display, lights, reflection, shadows};
use shadewright::modules::{Embedded, library};

/// A number as the device gets it.
fn single(x: f64) -> f64 {
    f64::from(x as f32)
}

/// A vector as the device gets it.
fn single3(v: DVec3) -> DVec3 {
    DVec3::new(single(v.x), single(v.y), single(v.z))
}

fn list(v: DVec3) -> Json {
    json!([v.x, v.y, v.z])
}

fn deg(theta: f64, phi: f64) -> DVec3 {
    single3(direction(theta.to_radians(), phi.to_radians()))
}

/// Components of a result. NaN and infinities come as text, so a result with one is no number here and fails.
#[track_caller]
fn components(result: &Json, of: &str) -> Vec<f64> {
    let number = |x: &Json| match x.as_f64() {
        Some(x) if x.is_finite() => x,
        _ => panic!("{of}: {result} is not finite"),
    };
    match result {
        Json::Array(list) => list.iter().map(number).collect(),
        one => vec![number(one)],
    }
}

/// Probes a table of inputs, each with the value that it must give and the relative and absolute error allowed.
#[derive(Default)]
struct Table {
    inputs: Vec<Json>,
    expected: Vec<(Vec<f64>, f64, f64)>,
}

impl Table {
    fn row(&mut self, input: Json, expected: impl Into<Vec<f64>>, relative: f64, absolute: f64) {
        self.inputs.push(input);
        self.expected.push((expected.into(), relative, absolute));
    }

    #[track_caller]
    fn check(self, recipe: &str, function: &str) {
        let results = probe(recipe, function, Json::Array(self.inputs.clone()));
        let results = results.as_array().expect("a list of results");
        assert_eq!(results.len(), self.inputs.len(), "{recipe}");
        for ((result, input), (expected, relative, absolute)) in results.iter().zip(&self.inputs).zip(&self.expected) {
            let got = components(result, &input.to_string());
            assert_eq!(got.len(), expected.len(), "{recipe} {input}");
            for (g, e) in got.iter().zip(expected) {
                let allowed = absolute + relative * e.abs();
                assert!(
                    (g - e).abs() <= allowed,
                    "{recipe} {function} {input}\n got {got:?}\nexpected {expected:?}, within {allowed:e}"
                );
            }
        }
    }
}

/// Angles to the normal in degrees, up to the horizon.
const ANGLES: [f64; 9] = [0.0, 0.01, 1.0, 20.0, 45.0, 70.0, 85.0, 89.0, 89.99];
const ALPHAS: [f64; 7] = [1e-4, 1e-3, 0.01, 0.05, 0.25, 0.6, 1.0];

/// The recipe, parameters and rows of a module's case file.
#[test]
fn cases_of_every_module() {
    for (path, text) in Embedded.files().filter(|(path, _)| path.ends_with("/cases.ron")) {
        let module = path.trim_end_matches("/cases.ron");
        let manifest = Library::read(&*library(), &format!("{module}/module.ron")).unwrap().unwrap();
        let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
        let manifest: ModuleManifest = options.from_str(&manifest).unwrap();
        for case in cases::parse(text).unwrap() {
            run_case(module, &manifest, &case);
        }
    }
}

fn run_case(module: &str, manifest: &ModuleManifest, case: &Case) {
    // Constants are part of the recipe; the other parameters are set where they reach the shader.
    let constant = |name: &String| manifest.params.get(name).is_some_and(|p| p.mode == ParamMode::Constant);
    let (frozen, set): (IndexMap<_, _>, IndexMap<_, _>) = case.params.clone().into_iter().partition(|(name, _)| constant(name));
    let node = Node {
        fill: case.fill.clone(),
        freeze: frozen,
        ..Node::new(module)
    };
    let recipe = ron::to_string(&node).unwrap();
    let mut input = serde_json::to_value(&case.inputs).unwrap();
    if !set.is_empty() {
        input["params"] = serde_json::to_value(&set).unwrap();
    }
    if !case.instances.is_empty() {
        input["instances"] = serde_json::to_value(&case.instances).unwrap();
    }
    let results = probe(&recipe, &case.function, json!([input]));
    let check = |expected: &Value, got: &Json, of: &str| {
        let expected = match expected {
            Value::Number(x) => vec![*x],
            Value::List(list) => list.clone(),
            other => panic!("{module}: {other:?} is no expected value"),
        };
        let got = components(got, of);
        assert_eq!(got.len(), expected.len(), "{of}");
        let fits = expected.iter().zip(&got).all(|(e, g)| case.accepts(*e, *g));
        assert!(fits, "{of}\n got {got:?}\nexpected {expected:?} ({})", case.source);
    };
    match &case.expect {
        Expected::Value(value) => check(value, &results[0], &format!("{module} {input}")),
        Expected::Struct(members) => {
            for (name, value) in members {
                check(value, &results[0][name], &format!("{module} {input} .{name}"));
            }
        }
    }
}

/// Catches the cancelling form of the denominator (its error is 1 and more at alpha 1e-4), and roughness taken for alpha.
#[test]
fn ggx() {
    let mut straight = Table::default();
    let mut tilted = Table::default();
    // A frame that is aligned with no axis.
    let n = single3(DVec3::new(0.48, -0.6, 0.64).normalize());
    let t = n.cross(DVec3::Y).normalize();
    for alpha in ALPHAS.map(single) {
        for factor in [0.0, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0] {
            let theta = (alpha * factor).atan();
            let h = single3(direction(theta, 0.7));
            let d = reflection::ggx_d(alpha, reflection::angle(DVec3::Z, h));
            straight.row(json!({"s": {"alpha": alpha}, "h": list(h)}), [d], 3e-6, 0.0);

            let h = single3(n * theta.cos() + t * theta.sin());
            let d = reflection::ggx_d(alpha, reflection::angle(n, h));
            // Rounding of the products in n x h, 6e-8, against a lobe as wide as alpha.
            tilted.row(
                json!({"s": {"alpha": alpha, "normal": list(n)}, "h": list(h)}),
                [d],
                3e-6 + 5e-7 / alpha,
                0.0,
            );
        }
        for angle in ANGLES {
            let h = deg(angle, 200.0);
            let d = reflection::ggx_d(alpha, reflection::angle(DVec3::Z, h));
            straight.row(json!({"s": {"alpha": alpha}, "h": list(h)}), [d], 3e-6, 0.0);
            straight.row(
                json!({"s": {"alpha": alpha}, "h": list(DVec3::new(h.x, h.y, -h.z))}),
                [0.0],
                0.0,
                0.0,
            );
        }
    }
    straight.check("ggx", "distribution");
    tilted.check("ggx", "distribution");
}

/// Catches 0 / 0 at the horizon, the separable form, and a missing 4 n.l n.v.
#[test]
fn smith_ggx_correlated() {
    let mut table = Table::default();
    for alpha in ALPHAS.map(single) {
        for (tv, tl) in ANGLES.iter().flat_map(|v| ANGLES.iter().map(move |l| (*v, *l))) {
            let (v, l) = (deg(tv, 0.0), deg(tl, 130.0));
            let h = single3((v + l).normalize());
            let row = |v: DVec3, l: DVec3| json!({"s": {"alpha": alpha}, "v": list(v), "l": list(l), "h": list(h)});
            table.row(row(v, l), [reflection::ggx_v_correlated(alpha, DVec3::Z, v, l)], 3e-6, 0.0);
            table.row(row(v, DVec3::new(l.x, l.y, -l.z)), [0.0], 0.0, 0.0);
        }
        let flat = json!({"s": {"alpha": alpha}, "v": [1.0, 0.0, 0.0], "l": [0.0, 1.0, 0.0], "h": [0.0, 0.0, 1.0]});
        table.row(flat, [0.0], 0.0, 0.0);
    }
    table.check("smith-ggx-correlated", "masking");
}

#[test]
fn schlick() {
    let mut table = Table::default();
    for f0 in [0.0, 0.02, 0.04, 0.5, 1.0].map(single) {
        for cosine in [0.0, 1e-6, 0.1, 0.5, 0.9, 0.999_999, 1.0].map(single) {
            let f = reflection::schlick(f0, cosine);
            table.row(json!({"s": {"f0": [f0, f0, f0]}, "cosine": cosine}), [f, f, f], 1e-6, 1e-12);
        }
        // What rounding makes of cosines of 0 and 1.
        for (cosine, f) in [(-1e-7, 1.0), (1.000_000_2, f0)] {
            table.row(json!({"s": {"f0": [f0, f0, f0]}, "cosine": cosine}), [f, f, f], 1e-6, 1e-12);
        }
    }
    table.check("schlick", "fresnel");
}

/// Pairs of directions: all angles against all angles, in the plane of incidence and across it, l = v and l = -v among them.
fn pairs() -> Vec<(DVec3, DVec3)> {
    let mut pairs = Vec::new();
    for (tv, tl) in ANGLES.iter().flat_map(|v| ANGLES.iter().map(move |l| (*v, *l))) {
        for phi in [0.0, 90.0, 135.0, 180.0] {
            pairs.push((deg(tv, 0.0), deg(tl, phi)));
        }
    }
    pairs
}

/// Catches errors of composition (a missing factor, the wrong angle in F), NaN for l = -v, light through the horizon.
#[test]
fn microfacet() {
    let mut table = Table::default();
    for alpha in ALPHAS.map(single) {
        let s = |f0: f64, diffuse: f64| reflection::Surface {
            normal: DVec3::Z,
            diffuse,
            f0,
            alpha,
        };
        let surface = json!({"alpha": alpha, "f0": [single(0.04), 0.5, 1.0], "diffuse": [single(0.8), 0.0, 0.25]});
        let channels = [s(single(0.04), single(0.8)), s(0.5, 0.0), s(1.0, 0.25)];
        for (v, l) in pairs() {
            let row = |v: DVec3, l: DVec3| json!({"s": surface, "v": list(v), "l": list(l)});
            // The half vector is rounded to 6e-8 in a lobe as wide as alpha.
            table.row(
                row(v, l),
                channels.map(|s| reflection::microfacet(&s, v, l)),
                1e-5 + 1e-6 / alpha,
                1e-12,
            );
            table.row(row(v, -v), [0.0; 3], 0.0, 0.0);
            table.row(row(v, DVec3::new(l.x, l.y, -l.z)), [0.0; 3], 0.0, 0.0);
            table.row(row(DVec3::new(v.x, v.y, -v.z), l), [0.0; 3], 0.0, 0.0);
        }
        // Opposite directions, both above the horizon by less than f32 can square: any finite number will do.
        let flat = json!({"s": surface, "v": [1.0, 0.0, 1e-25], "l": [-1.0, 0.0, 1e-25]});
        table.row(flat, [0.0; 3], 0.0, 3e38);
    }
    table.check("microfacet", "brdf");
}

/// White facets of alpha 1 under a white sky: the closed form of their albedo. Catches what the pointwise oracle and the
/// shader could have wrong in the same way.
#[test]
fn microfacet_white_furnace() {
    let sky = hemisphere(24, 24);
    for (mu, albedo) in [(1.0, 0.306_852_819), (0.5, 0.450_693_856), (0.1, 0.760_210_473)] {
        let v = direction(f64::acos(mu), 0.0);
        let row = |l: &DVec3| json!({"s": {"alpha": 1.0, "f0": [1, 1, 1], "diffuse": [0, 0, 0]}, "v": list(v), "l": list(*l)});
        let inputs: Vec<Json> = sky.iter().map(|(l, _)| row(l)).collect();
        let results = probe("microfacet", "brdf", Json::Array(inputs));
        let got: f64 = sky
            .iter()
            .zip(results.as_array().unwrap())
            .map(|((l, w), f)| w * l.z * components(f, "furnace")[0])
            .sum();
        assert!((got - albedo).abs() < 1e-4 * albedo, "{mu}: {got} {albedo}");
    }
}

/// Catches a wrong window, inverse square or cosine, a NaN at zero distance, light from below the horizon.
#[test]
fn point() {
    let mut table = Table::default();
    let distances = [0.0, 1e-20, 1e-6, 1e-3, 0.01, 0.5, 1.0, 5.0, 9.0, 9.99, 10.0, 11.0, 1e3, 1e6];
    let light_at = DVec3::new(0.5, -0.25, 2.0);
    for (range, intensity) in [(0.0, 100.0), (10.0, 65504.0), (10.0, 0.0), (0.0, 1e9)] {
        let light = lights::Point {
            position: light_at,
            intensity,
            range,
            size: single(0.01),
        };
        let instance = json!([{"position": list(light_at), "intensity": intensity, "range": range, "size": light.size}]);
        for distance in distances {
            for (angle, phi) in ANGLES.iter().map(|a| (*a, 40.0)).chain([(91.0, 40.0), (180.0, 0.0)]) {
                // The surface faces +z; the light is at this distance and angle from it.
                let place = single3(light_at - direction(f64::to_radians(angle), f64::to_radians(phi)) * distance);
                let e = lights::point_illuminance(&light, place, DVec3::Z);
                let d = (light_at - place).length();
                // Rounding of the distance, where the window's 1 - (d / range)^4 cancels.
                let x = if range > 0.0 { (d / range).min(1.0) } else { 0.0 };
                let relative = 3e-6 + 3e-6 / (1.0 - x.powi(4)).max(1e-9);
                let l = e / std::f64::consts::PI;
                let input = json!({"instances": instance, "s": {"position": list(place), "normal": [0, 0, 1]}, "v": [0, 0, 1]});
                table.row(input, [l; 3], relative, 1e-12 * intensity);
            }
        }
    }
    table.check("point", "light");
}

#[test]
fn directional() {
    let mut table = Table::default();
    for illuminance in [0.0, 0.25, 65504.0, 1e9] {
        for length in [1e-6, 1.0, 1e6] {
            for angle in ANGLES.into_iter().chain([90.5, 180.0]) {
                let travel = single3(-direction(f64::to_radians(angle), 0.4) * length);
                let instance = json!([{"direction": list(travel), "illuminance": illuminance, "color": [1.0, 0.5, 0.0]}]);
                let l = lights::directional_illuminance(travel, single(illuminance), DVec3::Z) / std::f64::consts::PI;
                let input = json!({"instances": instance, "s": {"normal": [0, 0, 1]}, "v": [0, 0, 1]});
                table.row(input, [l, 0.5 * l, 0.0], 3e-6, 0.0);
            }
        }
    }
    table.check("directional", "light");
}

/// Many lights add up, and each is lit by its own instance. Catches an index that stands still.
#[test]
fn lights_add() {
    let instances: Vec<Json> = (1..=40)
        .map(|i| json!({"position": [0, 0, i], "intensity": i * i, "color": [1.0, f64::from(i % 2), 0.0]}))
        .collect();
    let mut table = Table::default();
    let l = 40.0 / std::f64::consts::PI;
    table.row(
        json!({"instances": instances, "s": {"normal": [0, 0, 1]}, "v": [0, 0, 1]}),
        [l, l / 2.0, 0.0],
        1e-5,
        0.0,
    );
    table.check("point", "light");
}

#[test]
fn reinhard() {
    let mut table = Table::default();
    for white in [0.0625, 1.0, 4.0, 1e6] {
        for level in [0.0, 1e-30, 1e-6, 0.18, 1.0, 4.0, 100.0, 65504.0, 1e18] {
            for tint in [DVec3::ONE, DVec3::X, DVec3::new(0.5, 0.25, 1.0)] {
                let c = single3(tint * level);
                let e = display::reinhard_color(c, white);
                table.row(json!({"params": {"white": white}, "c": list(c)}), [e.x, e.y, e.z], 3e-6, 1e-36);
            }
        }
    }
    table.check("reinhard", "tone_curve");
}

#[test]
fn manual_exposure() {
    let mut table = Table::default();
    for ev in [-20.0, -6.0, 0.0, 7.5, 12.0, 14.965_784_3, 30.0].map(single) {
        table.row(
            json!({"params": {"ev100": ev}}),
            [1.0 / display::saturation_luminance(ev)],
            1e-5,
            0.0,
        );
    }
    table.check("manual", "exposure");
}

/// The interface's edge, lit where offset.x < place.x, at every position against every radius.
#[test]
fn shadow_filters() {
    for radius in [0, 1, 2, 5, 8] {
        let mut table = Table::default();
        for step in -20..=20 {
            let edge = f64::from(step) / 2.0;
            let share = shadows::tent_filter(radius, |x, _| f64::from(x) < edge);
            table.row(json!({"at": {"place": [edge, 0, 0]}}), [share], 1e-6, 1e-7);
            if radius == 0 {
                let mut hard = Table::default();
                hard.row(json!({"at": {"place": [edge, 0, 0]}}), [share], 0.0, 0.0);
                hard.check("hard", "filter_shadow");
            }
        }
        table.check(&format!("(module: \"pcf\", freeze: {{\"radius\": {radius}}})"), "filter_shadow");
    }
}

/// Catches roughness that is not squared, a metal with a diffuse part, a dielectric that shines in its own colour.
#[test]
fn metalness() {
    let base = [single(0.9), 0.5, 0.0];
    let mut inputs = Vec::new();
    let mut expected = Vec::new();
    for metalness in [0.0, 0.25, 1.0] {
        for roughness in [0.0, 1e-3, 0.01, 0.5, 1.0].map(single) {
            inputs.push(json!({"params": {"base_color": base, "metalness": metalness, "roughness": roughness}, "at": {}}));
            let diffuse = base.map(|c| c * (1.0 - metalness));
            let f0 = base.map(|c| 0.04 * (1.0 - metalness) + c * metalness);
            expected.push((diffuse, f0, (roughness * roughness).max(1e-4)));
        }
    }
    let results = probe("metalness", "surface", Json::Array(inputs.clone()));
    for ((input, (diffuse, f0, alpha)), result) in inputs.iter().zip(expected).zip(results.as_array().unwrap()) {
        for (name, values) in [("diffuse", &diffuse[..]), ("f0", &f0[..]), ("alpha", &[alpha][..])] {
            for (g, e) in components(&result[name], name).iter().zip(values) {
                assert!((g - e).abs() <= 1e-6 * e + 1e-8, "{input} {name}: {g} {e}");
            }
        }
    }
}

/// Catches a layer that gives light: over a white matte surface fuzz gives back all that it gets, and a coat no more than that; and one that
/// takes too much, below 80 degrees.
#[test]
fn layers_over_a_white_surface_keep_the_energy() {
    let sky = hemisphere(16, 16);
    let albedo = |layer: &str, s: Json, degrees: f64| -> f64 {
        let v = deg(degrees, 0.0);
        let row = |(l, _): &(DVec3, f64)| json!({"s": s, "v": list(v), "l": list(single3(*l))});
        let recipe = format!("(module: \"brdf/{layer}\", fill: {{\"base\": \"lambert\"}})");
        let results = probe(&recipe, "brdf", Json::Array(sky.iter().map(row).collect()));
        let of = |(value, (l, weight)): (&Json, &(DVec3, f64))| components(value, layer)[0] * l.z * weight;
        results.as_array().unwrap().iter().zip(&sky).map(of).sum()
    };
    for degrees in [0.0, 30.0, 60.0, 75.0] {
        for roughness in [0.2, 0.5, 1.0] {
            let got = albedo("fuzz", json!({"diffuse": [1, 1, 1], "fuzz_roughness": roughness}), degrees);
            assert!((got - 1.0).abs() < 2e-3, "fuzz {roughness} {degrees}: {got}");
        }
        for alpha in [0.2, 0.5, 1.0] {
            let got = albedo("coat", json!({"diffuse": [1, 1, 1], "coat_alpha": alpha}), degrees);
            assert!(got < 1.001 && got > 0.7, "coat {alpha} {degrees}: {got}");
        }
    }
}
