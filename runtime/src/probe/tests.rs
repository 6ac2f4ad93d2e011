//! A function of a small module, evaluated on the device.

use std::sync::atomic::{AtomicBool, Ordering};

use serde_json::json;
use shadewright_compiler::program::Recipe;

use super::gpu::MOST_ROWS;
use super::*;
use crate::gpu::Form;
use crate::gpu::testing::{catalog, gpu, plain_gpu};

const CATEGORY: &str = "(summary: \"tested\", order: 1, group: 2, defaults: {\"S\": {\"alpha\": 0.5}})";
const INTERFACE: &str = "
    struct S { n: vec3f, alpha: f32, unread: vec2f }
    fn eval(s: S, v: vec3f, k: u32) -> vec3f { return vec3f(0.0); }";
const MANIFEST: &str = "(
    summary: \"tested\",
    params: {
        \"scale\": (type: F32, default: 1.0, range: Some((0.0, 10.0))),
        \"other\": (type: F32, default: 1.0),
        \"gain\": (type: F32, default: 1.0, mode: Override),
        \"fixed\": (type: U32, default: 1, mode: Constant),
    },
    instances: {\"power\": (type: F32, default: 0.25), \"gone\": (type: F32, default: 0.0)},
    resources: {\"tint\": (kind: Texture())},
)";
const SOURCE: &str = "
    var tint: texture_2d<f32>;
    fn eval(s: S, v: vec3f, k: u32) -> vec3f {
        var sum = 0.0;
        for (var l = 0u; l < arrayLength(&instances); l++) { sum += instances[l].power; }
        let white = textureLoad(tint, vec2u(0u), 0).x;
        return s.n * s.alpha * params.scale + v * f32(k * params.fixed) + vec3f(sum * white, params.gain * f32(arrayLength(&instances)), 1.0 / v.z);
    }";

fn run(inputs: &[Json]) -> Result<Vec<Json>, RuntimeError> {
    run_in(Form::Ir, inputs)
}

fn run_in(form: Form, inputs: &[Json]) -> Result<Vec<Json>, RuntimeError> {
    let catalog = catalog(&[
        ("tested/category.ron", CATEGORY),
        ("tested/interface.wgsl", INTERFACE),
        ("tested/lamp/module.ron", MANIFEST),
        ("tested/lamp/lamp.wgsl", SOURCE),
    ]);
    let recipe = Recipe::parse("test", "\"lamp\"").unwrap();
    let answer = probe(&gpu().with_form(form), &catalog, &recipe, "eval", inputs)?;
    assert_eq!((&answer["function"], &answer["device"]), (&json!("eval"), &json!(gpu().name())));
    Ok(answer["results"].as_array().unwrap().clone())
}

/// Catches lost order between batches, defaults and parameters that do not arrive, a padded instance buffer
/// (its length would add lamps) and textures that are not white; in the source form, an override or an entry point of another name.
#[test]
fn rows_come_back_in_order() {
    let rows = [
        json!({"s": {"n": [2, 4, 8], "unread": [1, 2]}, "v": [0, 0, 1], "k": 0}),
        json!({"s": {"n": [2, 4, 8], "alpha": 1}, "v": [1, 2, 4], "k": 3, "params": {"scale": 2}}),
        json!({"v": [1, 2, 0], "k": 1, "instances": [{"power": 1}, {"power": 2}, {"gone": 7}], "params": {"other": 1, "gain": -2}}),
        json!({"s": {"n": [0, 0, 2]}, "v": [0, 0, -1], "k": 0, "params": {"lamp.scale": 4}}),
    ];
    let expected = json!([[1.25, 3.0, 5.0], [7.25, 15.0, 28.25], [4.25, -4.0, "Infinity"], [0.25, 1.0, 3.0]]);
    for form in [Form::Ir, Form::Source] {
        assert_eq!(Json::Array(run_in(form, &rows).unwrap()), expected, "{form:?}");
    }
}

/// Catches a column at another number's place, rows that do not get the common row, and a column that nothing takes.
#[test]
fn columns_are_rows() {
    let catalog = catalog(&[
        ("tested/category.ron", CATEGORY),
        ("tested/interface.wgsl", INTERFACE),
        ("tested/lamp/module.ron", MANIFEST),
        ("tested/lamp/lamp.wgsl", SOURCE),
    ]);
    let probe = Probe::new(&catalog, &Recipe::parse("test", "\"lamp\"").unwrap(), "eval").unwrap();
    let row = json!({"s": {"n": [2, 4, 8]}, "v": [0, 0, 1], "k": 3, "params": {"scale": 2}});
    let (alpha, z) = ([0.5, 1.0, 2.0], [1.0, 2.0, 4.0]);
    let table = probe.varied(&row, &[("s.alpha", &alpha), ("v.z", &z)]).unwrap();
    let rows: Vec<Json> = alpha
        .iter()
        .zip(z)
        .map(|(alpha, z)| json!({"s": {"n": [2, 4, 8], "alpha": alpha}, "v": [0, 0, z], "k": 3, "params": {"scale": 2}}))
        .collect();
    assert_eq!(table, probe.table(&rows).unwrap());
    for (columns, message) in [
        (vec![("s.beta", &alpha[..])], "s.beta"),
        (vec![("k", &alpha[..])], "k: is no f32"),
        (vec![("s.alpha", &alpha[..]), ("v.z", &z[..2])], "v.z: 2 numbers, others have 3"),
    ] {
        let error = probe.varied(&row, &columns).expect_err("it does not fit").to_string();
        assert!(error.contains(message), "{error}");
    }
}

/// Catches the table being looked for at fixed bindings: parameters of a category of group 3 come before it.
#[test]
fn the_table_shares_its_group() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 3)"),
        ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return x; }"),
        (
            "tested/scale/module.ron",
            "(summary: \"tested\", params: {\"by\": (type: F32, default: 3.0)})",
        ),
        ("tested/scale/scale.wgsl", "fn eval(x: f32) -> f32 { return params.by * x; }"),
    ]);
    let recipe = Recipe::parse("test", "\"scale\"").unwrap();
    let answer = probe(
        &gpu(),
        &catalog,
        &recipe,
        "eval",
        &[json!({"x": 2}), json!({"x": 2, "params": {"by": 5}})],
    )
    .unwrap();
    assert_eq!(answer["results"], json!([6.0, 10.0]));
}

/// Catches a table that is cut at a dispatch's or a chunk's limit.
#[test]
fn large_tables_come_back_whole() {
    let count = usize::try_from(MOST_ROWS).unwrap() + 3;
    let rows: Vec<_> = (0..count).map(|i| json!({"v": [i % 1000, 0, 1], "k": 1})).collect();
    let results = run(&rows).unwrap();
    assert_eq!(results.len(), count);
    for (i, result) in results.iter().enumerate() {
        assert_eq!(result[0], json!((i % 1000) as f64 + 0.25), "row {i}");
    }
}

/// Catches bad rows that are taken, and errors that do not say where.
#[test]
fn bad_rows_are_located() {
    let fail = |row: Json| run(&[json!({"v": [0, 0, 1], "k": 0}), row]).unwrap_err().to_string();
    assert_eq!(fail(json!([])), "[1]: expected an object keyed by argument name");
    assert_eq!(fail(json!({"v": [0, 0, 1]})), "[1]: argument `k` of type u32 is missing");
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "kk": 0})),
        "[1]: the function has no argument `kk`; did you mean `k`?"
    );
    assert_eq!(fail(json!({"v": [0, 0], "k": 0})), "[1].v: vec3<f32> has 3 components, found 2");
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scal": 1}})),
        "[1].params.scal: the recipe has no parameter `scal`; did you mean `scale`?"
    );
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scale": [1, 2]}})),
        "lamp.scale: expected a number, found 2 numbers"
    );
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "params": {"scale": 11}})),
        "lamp.scale: 11 is outside 0 to 10"
    );
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "params": {"fixed": 2}})),
        "[1].params.fixed: is a constant of this recipe; freeze it to another value there"
    );
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "instances": [{"powr": 1}]})),
        "[1].instances[0]: the instance has no field `powr`; did you mean `power`?"
    );
    assert_eq!(
        fail(json!({"v": [0, 0, 1], "k": 0, "instances": []})),
        "[1].instances: expected at least one instance"
    );
}

/// Catches numbers in another order than their names, NaN and infinities that are lost on the way, rows of a later batch in an earlier
/// one's place, and a table that does not say what its rows share.
#[test]
fn a_struct_comes_back_as_its_numbers() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        (
            "tested/interface.wgsl",
            "struct Two { at: vec2f, count: u32 } struct All { a: f32, two: Two, m: mat2x2f, list: array<i32, 2> }
            fn eval(x: f32, up: bool) -> All { return All(); }",
        ),
        (
            "tested/all/module.ron",
            "(summary: \"tested\", params: {\"by\": (type: F32, default: 3.0), \"over\": (type: F32, default: 1.0, mode: Override)},
              instances: {\"power\": (type: F32, default: 0.25)})",
        ),
        (
            "tested/all/all.wgsl",
            "fn eval(x: f32, up: bool) -> All {
                return All(x / params.over, Two(vec2f(params.by, instances[0].power), u32(up) + 4u), mat2x2f(1.0, 2.0, 3.0, x), array(-7, 8));
            }",
        ),
    ]);
    let probe = Probe::new(&catalog, &Recipe::parse("test", "\"all\"").unwrap(), "eval").unwrap();
    let names = "a two.at.x two.at.y two.count m[0].x m[0].y m[1].x m[1].y list[0] list[1]";
    assert_eq!(probe.components().join(" "), names);
    let table = probe
        .table(&[
            json!({"x": 2, "up": true}),
            json!({"x": "Infinity", "up": false, "params": {"by": 5, "over": 0.5}, "instances": [{"power": 9}]}),
            json!({"x": -6, "up": false}),
            json!({"x": "NaN", "up": false}),
        ])
        .unwrap();
    let rows: Vec<_> = table.batches().iter().map(|batch| batch.rows.as_slice()).collect();
    assert_eq!(rows, [&[0, 2, 3][..], &[1]]);
    assert_eq!(
        (table.len(), table.row(2), table.row(4)),
        (4, &[0, 0, 0xc0, 0xc0, 0, 0, 0, 0][..], &[][..])
    );
    let float = |x: f32| x.to_le_bytes().to_vec();
    let [first, second] = table.batches() else { panic!("two batches") };
    assert_eq!(
        (&first.constants, &second.constants),
        (&vec![], &vec![("all_over".to_owned(), 0.5)])
    );
    assert_eq!(first.blocks.values().collect::<Vec<_>>(), [&float(3.0)]);
    assert_eq!(second.blocks.values().collect::<Vec<_>>(), [&float(5.0)]);
    assert_eq!(second.instances.values().collect::<Vec<_>>(), [&float(9.0)]);
    let got = probe.on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &table).unwrap();
    assert_eq!(got[0], [2.0, 3.0, 0.25, 5.0, 1.0, 2.0, 3.0, 2.0, -7.0, 8.0]);
    assert_eq!(got[1], [f64::INFINITY, 5.0, 9.0, 4.0, 1.0, 2.0, 3.0, f64::INFINITY, -7.0, 8.0]);
    assert!(got[3][0].is_nan() && got[3][7].is_nan(), "{:?}", got[3]);
    assert_eq!(got[2], [-6.0, 3.0, 0.25, 4.0, 1.0, 2.0, 3.0, -6.0, -7.0, 8.0]);
}

/// Catches lists of instances that go to another module's buffer where there are two.
#[test]
fn two_modules_have_instances_of_their_own() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return 0.0; }"),
        (
            "tested/inner/module.ron",
            "(summary: \"tested\", instances: {\"power\": (type: F32, default: 0.25)})",
        ),
        (
            "tested/inner/inner.wgsl",
            "fn eval(x: f32) -> f32 { return instances[0].power * x; }",
        ),
        (
            "tested/outer/module.ron",
            "(summary: \"tested\", slots: {\"below\": (interface: \"tested\", default: \"inner\", prefix: \"below_\")},
              instances: {\"gain\": (type: F32, default: 1.0)})",
        ),
        (
            "tested/outer/outer.wgsl",
            "fn eval(x: f32) -> f32 { return 10.0 * instances[0].gain + below_eval(x); }",
        ),
    ]);
    let probe = Probe::new(&catalog, &Recipe::parse("test", "\"outer\"").unwrap(), "eval").unwrap();
    let table = probe.table(&[
        json!({"x": 1}),
        json!({"x": 1, "instances": {"inner": [{"power": 2}]}}),
        json!({"x": 1, "instances": {"inner": [{"power": 2}], "outer": [{"gain": 3}]}}),
    ]);
    let got = probe.on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &table.unwrap()).unwrap();
    assert_eq!(got, [[10.25], [12.0], [32.0]]);
    assert_eq!(
        probe
            .table(&[json!({"x": 1, "instances": [{"power": 2}]})])
            .unwrap_err()
            .to_string(),
        "[0].instances: several modules have instances: expected an object with a list for each"
    );
}

/// Catches a probe without arguments that has no rows, and an empty table that is an error.
#[test]
fn a_function_without_arguments_has_rows_too() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        ("tested/interface.wgsl", "fn eval() -> f32 { return 0.0; }"),
        ("tested/one/module.ron", "(summary: \"tested\")"),
        ("tested/one/one.wgsl", "fn eval() -> f32 { return 2.5; }"),
    ]);
    let probe = Probe::new(&catalog, &Recipe::parse("test", "\"one\"").unwrap(), "eval").unwrap();
    assert_eq!(probe.components(), [""]);
    let run = |rows: &[Json]| {
        probe
            .on_gpu(&Pipelines::new(&gpu(), None), &gpu(), &probe.table(rows).unwrap())
            .unwrap()
    };
    assert_eq!(run(&[json!({}), json!({})]), [[2.5], [2.5]]);
    assert_eq!(run(&[]), Vec::<Vec<f64>>::new());
}

/// `eval` of one slow and one fast module.
fn slow_and_fast() -> [Probe; 2] {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return 0.0; }"),
        ("tested/slow/module.ron", "(summary: \"tested\")"),
        (
            "tested/slow/slow.wgsl",
            "fn eval(x: f32) -> f32 { var y = x; for (var i = 0; i < 300; i++) { y = sin(y + x); } return y; }",
        ),
        ("tested/fast/module.ron", "(summary: \"tested\")"),
        ("tested/fast/fast.wgsl", "fn eval(x: f32) -> f32 { return sin(x); }"),
    ]);
    ["\"slow\"", "\"fast\""].map(|text| Probe::new(&catalog, &Recipe::parse("test", text).unwrap(), "eval").unwrap())
}

/// Catches times under another alternative's name, times a pass instead of a row (the fast one has more rows in its pass), and a stop
/// that is not heard.
#[test]
fn times_are_told_apart() {
    let [slow, fast] = slow_and_fast();
    let rows = |count: usize| (0..count).map(|i| json!({"x": i})).collect::<Vec<_>>();
    let (few, many) = (slow.table(&rows(3)).unwrap(), fast.table(&rows(1000)).unwrap());
    let pipelines = Pipelines::new(&gpu(), None);
    let stop = AtomicBool::new(false);
    let times = time(&pipelines, &gpu(), &[(&slow, &few), (&fast, &many)], 7, &stop).unwrap();
    let times = times.expect("the device has timestamps");
    assert_eq!(times.iter().map(Vec::len).collect::<Vec<_>>(), [7, 7]);
    let mut ratios: Vec<f64> = times[0].iter().zip(&times[1]).map(|(slow, fast)| slow / fast).collect();
    ratios.sort_by(f64::total_cmp);
    assert!((5.0..20_000.0).contains(&ratios[3]), "{times:?}");
    // No device needs a millisecond or less than a hundredth of a nanosecond for 300 sines.
    assert!(times[0].iter().all(|t| (0.01..1e6).contains(t)), "{times:?}");

    // So many repetitions would take a minute.
    let many_times = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(std::time::Duration::from_millis(400));
            stop.store(true, Ordering::Relaxed);
        });
        time(&pipelines, &gpu(), &[(&slow, &few), (&fast, &many)], 10_000, &stop)
            .unwrap()
            .unwrap()
    });
    assert!(many_times[0].len() < 10_000 && many_times[0].len() == many_times[1].len());
    let none = time(&pipelines, &gpu(), &[(&slow, &few), (&fast, &many)], 7, &stop).unwrap();
    assert_eq!(none, Some(vec![vec![], vec![]]));
    stop.store(false, Ordering::Relaxed);
    let empty = time(&pipelines, &gpu(), &[(&slow, &slow.table(&[]).unwrap())], 7, &stop);
    assert_eq!(empty.unwrap_err().to_string(), "table: there are no rows to time");
}

/// Catches times of something else where the device tells none.
#[test]
fn a_device_without_timestamps_gives_no_times() {
    let [slow, _] = slow_and_fast();
    let gpu = plain_gpu();
    let table = slow.table(&[json!({"x": 1})]).unwrap();
    let times = time(&Pipelines::new(&gpu, None), &gpu, &[(&slow, &table)], 7, &AtomicBool::new(false));
    assert_eq!(times.unwrap(), None);
    assert_eq!(
        crate::gpu::Timer::new(&gpu).unwrap_err().to_string(),
        format!("timing passes needs timestamp queries on {}, which is not there", gpu.name())
    );
}

/// Catches a loop whose end is frozen and not seen, a free one that is, and operations of the probe that count for its function.
#[test]
fn frozen_ends_of_loops_are_seen() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 2)"),
        ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return 0.0; }"),
        (
            "tested/sum/module.ron",
            "(summary: \"tested\", params: {\"terms\": (type: U32, default: 8)})",
        ),
        (
            "tested/sum/sum.wgsl",
            "fn eval(x: f32) -> f32 { var s = 0.0; for (var i = 1u; i <= params.terms + 1u; i++) { s += x; } return s; }",
        ),
    ]);
    let cost = |recipe: &str| {
        let found = Probe::new(&catalog, &Recipe::parse("test", recipe).unwrap(), "eval")
            .unwrap()
            .cost();
        (found.loops[0].trips, found.cost.add, found.cost.bindings)
    };
    assert_eq!(cost("\"sum\""), (None, 1, 1));
    assert_eq!(cost("(module: \"sum\", freeze: {\"terms\": 11})"), (Some(12), 1, 0));
}

/// Catches rows in another order than the GPU's, parameters, pipeline constants and instances that do not reach the CPU, numbers that are
/// not those of [`Probe::components`], and operations of the table that are counted.
#[test]
fn the_cpu_computes_what_the_gpu_does() {
    let catalog = catalog(&[
        ("tested/category.ron", CATEGORY),
        ("tested/interface.wgsl", INTERFACE),
        ("tested/lamp/module.ron", MANIFEST),
        ("tested/lamp/lamp.wgsl", SOURCE),
    ]);
    let recipe = Recipe::parse("test", "\"lamp\"").unwrap();
    let probe = Probe::new(&catalog, &recipe, "eval").unwrap();
    let rows: Vec<Json> = (0..300)
        .map(|i| match i % 3 {
            0 => json!({"s": {"n": [2, 4, i]}, "v": [0, 0, 1], "k": i}),
            1 => json!({"s": {"n": [2, 4, 8], "alpha": 1}, "v": [1, i, 4], "k": 3, "params": {"scale": 2}}),
            _ => json!({"v": [1, 2, 0], "k": i, "instances": [{"power": 1}, {"power": i}], "params": {"gain": -2}}),
        })
        .collect();
    let table = probe.table(&rows).unwrap();
    let gpu = gpu();
    let device = probe.on_gpu(&Pipelines::new(&gpu, None), &gpu, &table).unwrap();
    let single = probe.on_cpu::<f32>(&table).unwrap();
    let double = probe.on_cpu::<f64>(&table).unwrap();
    for (row, numbers) in device.iter().enumerate() {
        let wide: Vec<f64> = single.values[row].iter().map(|x| f64::from(*x)).collect();
        assert_eq!((&wide, &double.values[row]), (numbers, numbers), "row {row}");
    }
    assert_eq!(probe.components(), ["x", "y", "z"]);
    assert_eq!(
        probe.answer_on_cpu::<f32>(&table).unwrap()["results"],
        probe.answer(&Pipelines::new(&gpu, None), &gpu, &table).unwrap()["results"]
    );
    // One trip for each instance; nothing of the probe's own comparison and branch.
    let trips = [0, 1, 2].map(|row| single.executed[row][shadewright_evaluate::Kind::Trip]);
    assert_eq!(trips, [1, 1, 2]);
    assert_eq!(single.executed[0], double.executed[0]);
}

/// Catches results that depend on the number of threads.
#[test]
fn the_cpus_results_are_the_same_on_any_number_of_threads() {
    let catalog = catalog(&[
        ("tested/category.ron", "(summary: \"tested\", order: 1, group: 3)"),
        ("tested/interface.wgsl", "fn eval(x: f32) -> f32 { return x; }"),
        ("tested/wave/module.ron", "(summary: \"tested\")"),
        ("tested/wave/wave.wgsl", "fn eval(x: f32) -> f32 { return sin(x) / (x + 0.1); }"),
    ]);
    let probe = Probe::new(&catalog, &Recipe::parse("test", "\"wave\"").unwrap(), "eval").unwrap();
    let table = probe
        .table(&(0..1000).map(|i| json!({"x": f64::from(i) * 0.003})).collect::<Vec<_>>())
        .unwrap();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| probe.on_cpu::<shadewright_evaluate::Allowed>(&table).unwrap())
    };
    assert_eq!(on(1), on(7));
    assert_eq!(on(1).values.len(), 1000);
}
