//! Spaces against the same spaces multiplied out and judged one by one.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "../common/mod.rs"]
mod common;
mod made_up;
mod naive;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use common::{Texts, small};
use made_up::Tape;
use naive::{Naive, T};
use proptest::prelude::*;
use shadewright_compiler::space::{Passes, Permutation, Space, SpaceFile, Work, compile_all};
use shadewright_compiler::{Catalog, Recipe};

/// More trees than this are not worth the time.
const MOST: usize = 1000;

/// A catalog and a space over it, with all its trees; `None` where there are too many.
fn make(numbers: &[u8]) -> Option<(Catalog, SpaceFile, Vec<T>)> {
    let mut tape = Tape(numbers, 0);
    let texts = made_up::library(&mut tape);
    let text = made_up::space(&mut tape, &texts);
    let catalog = texts.catalog().unwrap_or_else(|report| panic!("{report}"));
    let file = match SpaceFile::parse("made-up.space.ron", &text) {
        Ok(file) => file,
        Err(report) => panic!("{report}"),
    };
    // Fillings that a slot does not take are errors of the space, told before anything is counted.
    if let Err(report) = Space::open(&catalog, &file) {
        let codes: Vec<&str> = report.diagnostics.iter().map(|d| d.code).collect();
        assert!(matches!(codes[..], ["SW0207" | "SW1003"]), "{report}\n{text}");
        return None;
    }
    let naive = Naive {
        catalog: &catalog,
        most: MOST,
    };
    let trees = naive.trees(&file).ok()?;
    Some((catalog, file, trees))
}

fn sorted(mut list: Vec<String>) -> Vec<String> {
    list.sort();
    list
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    /// Catches a count that is off, a legal permutation that is missing, an illegal one that is there, one that comes twice, a rule that
    /// looks at the wrong modules, a number that leads to another permutation.
    #[test]
    fn a_space_holds_exactly_what_is_legal(numbers in proptest::collection::vec(any::<u8>(), 160)) {
        let Some((catalog, file, trees)) = make(&numbers) else { return Ok(()) };
        let naive = Naive { catalog: &catalog, most: MOST };
        let legal = trees.iter().filter(|tree| {
            let (wrong, kept) = naive.judge(tree, &file.rules);
            wrong.is_empty() && kept
        });
        let expected = sorted(legal.map(|tree| naive.text(tree)).collect());
        let space = Space::open(&catalog, &file).unwrap();
        prop_assert_eq!(space.count().unwrap(), expected.len() as u128, "{}", &file.source.text);
        let all: Vec<Permutation> = space.iter().unwrap().collect();
        let found = sorted(all.iter().map(|p| naive.text_of(&p.recipe.root)).collect());
        prop_assert_eq!(&found, &expected, "{}", &file.source.text);
        for (index, permutation) in all.iter().enumerate() {
            prop_assert_eq!(permutation.index, Some(index as u128));
        }
        // To go on later is to go on where one was.
        let rest: Vec<String> = space.iter_from(all.len() as u128 / 2).unwrap().map(|p| p.recipe.source.text.clone()).collect();
        let half: Vec<String> = all[all.len() / 2..].iter().map(|p| p.recipe.source.text.clone()).collect();
        prop_assert_eq!(rest, half);
        let different: BTreeSet<&Vec<usize>> = all.iter().map(|p| &p.options).collect();
        prop_assert_eq!(different.len(), all.len());
    }

    /// Catches a pair of options that the cover misses, a permutation of the cover that is illegal or numbered wrong, and a cover that
    /// is no smaller than everything.
    #[test]
    fn the_cover_has_every_legal_pair(numbers in proptest::collection::vec(any::<u8>(), 160)) {
        let Some((catalog, file, _)) = make(&numbers) else { return Ok(()) };
        let space = Space::open(&catalog, &file).unwrap();
        let all: Vec<Permutation> = space.iter().unwrap().collect();
        let cover = space.pairwise().unwrap();
        prop_assert_eq!(pairs(&cover), pairs(&all), "{}", &file.source.text);
        prop_assert!(cover.len() <= all.len());
        prop_assert_eq!(cover.is_empty(), all.is_empty());
        for permutation in &cover {
            let same = space.get(permutation.index.unwrap()).unwrap();
            prop_assert_eq!(&same.recipe.source.text, &permutation.recipe.source.text);
            prop_assert_eq!(&same.options, &permutation.options);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, failure_persistence: None, ..ProptestConfig::default() })]

    /// Catches rules that mean one thing to a space and another to the compiler: what is left out for a module's rule or a label is
    /// refused by `plan` with that code, everything else passes it.
    #[test]
    fn the_compiler_refuses_what_a_space_leaves_out(numbers in proptest::collection::vec(any::<u8>(), 160)) {
        let Some((catalog, _, trees)) = make(&numbers) else { return Ok(()) };
        let naive = Naive { catalog: &catalog, most: MOST };
        for tree in trees.iter().take(60) {
            let (wrong, _) = naive.judge(tree, &[]);
            match catalog.plan(&Recipe::from(naive.recipe(tree)), "main") {
                Ok(_) => prop_assert!(wrong.is_empty(), "{:?} {}", wrong, naive.text(tree)),
                Err(report) => prop_assert!(wrong.contains(&report.diagnostics[0].code), "{} {}", report, naive.text(tree)),
            }
        }
    }
}

/// Catches made-up spaces that are nearly all too large, wrong or without a choice, so that the laws above hold of nothing.
#[test]
fn the_made_up_spaces_are_worth_something() {
    let mut random = 1u64;
    let (mut judged, mut several, mut forbidden, mut labelled) = (0, 0, 0, 0);
    for _ in 0..300 {
        let next = |random: &mut u64| {
            *random = random
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*random >> 56) as u8
        };
        let numbers: Vec<u8> = (0..160).map(|_| next(&mut random)).collect();
        let Some((catalog, file, trees)) = make(&numbers) else { continue };
        let naive = Naive {
            catalog: &catalog,
            most: MOST,
        };
        let verdicts: Vec<_> = trees.iter().map(|tree| naive.judge(tree, &file.rules)).collect();
        judged += 1;
        let legal = verdicts.iter().filter(|(wrong, kept)| wrong.is_empty() && *kept).count();
        several += usize::from(legal > 3);
        forbidden += usize::from(legal > 0 && legal < trees.len());
        labelled += usize::from(verdicts.iter().any(|(wrong, _)| wrong.contains(&"SW0209")));
    }
    println!("{judged} of 300 judged, {several} with several, {forbidden} with some forbidden, {labelled} by a label");
    assert!(
        judged > 120 && several > 50 && forbidden > 30 && labelled > 3,
        "{judged} {several} {forbidden} {labelled}"
    );
}

/// The pairs of options that stand together, options that stand alone as pairs with themselves.
fn pairs(permutations: &[Permutation]) -> BTreeSet<(usize, usize)> {
    let mut found = BTreeSet::new();
    for permutation in permutations {
        for &a in &permutation.options {
            found.extend(permutation.options.iter().map(|&b| (a, b)));
        }
    }
    found
}

/// Three values, two of them with a slot and a parameter.
fn library() -> Texts {
    let value = |body: &str| format!("fn value(x: f32) -> f32 {{\n    return {body};\n}}\n");
    small()
        .module("value", "plain", r#"properties: ["flat"]"#, &value("x"))
        .module(
            "value",
            "twice",
            r#"slots: {"inner": (interface: "value", arity: Optional, prefix: "inner_")}"#,
            &value("inner_value(x) * 2.0"),
        )
        .module(
            "value",
            "scaled",
            r#"params: {"by": (type: F32, default: 1.0, range: (0.0, 100.0)), "times": (type: U32, default: 1, range: (0, 9), mode: Constant)}"#,
            &value("x * params.by * f32(params.times)"),
        )
}

fn space(text: &str) -> Space {
    Space::parse(&library().catalog().unwrap(), "a.space.ron", text).unwrap_or_else(|report| panic!("{report}"))
}

fn recipes(text: &str) -> Vec<String> {
    space(text).iter().unwrap().map(|p| p.recipe.source.text.clone()).collect()
}

fn value(text: &str) -> String {
    format!(r#"(module: "run", fill: {{"value": {text}}})"#)
}

/// Catches a recipe that is not read as a space of one, or comes back changed.
#[test]
fn a_recipe_is_a_space_of_one() {
    assert_eq!(recipes(&value("\"plain\"")), [r#"(module:"run",fill:{"value":(module:"plain")})"#]);
    let catalog = common::standard().catalog().unwrap();
    for (name, text) in common::recipes() {
        let space = Space::parse(&catalog, &name, &text).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(space.count().unwrap(), 1, "{name}");
        let only = space.get(0).unwrap();
        assert_eq!(only.recipe.root, Recipe::parse(&name, &text).unwrap().root, "{name}");
        assert_eq!((only.choices, space.choices(), space.pairwise().unwrap().len()), (Vec::new(), 0, 1));
    }
    let bare = Space::parse(&catalog, "bare", "ndf/ggx").unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(bare.get(0).unwrap().recipe.root.module, "ndf/ggx");
}

/// Catches ranges that miss an end, are spaced the wrong way, or repeat a whole number.
#[test]
fn ranges_of_values() {
    let values = |param: &str, range: &str| -> Vec<String> {
        let text = value(&format!(r#"(module: "scaled", freeze: {{"{param}": {range}}})"#));
        space(&text).iter().unwrap().map(|p| p.choices[0].chosen.clone()).collect()
    };
    assert_eq!(values("by", "(from: 0.0, to: 1.0, steps: 4)"), ["0", "0.25", "0.5", "0.75", "1"]);
    assert_eq!(values("by", "(from: 0.1, to: 0.7, step: 0.2)").len(), 4);
    assert_eq!(values("by", "(from: 0.0, to: 1.0, step: 0.4)"), ["0", "0.4", "0.8"]);
    let log = values("by", "(from: 0.01, to: 100.0, steps: 4, scale: Log)");
    assert_eq!((log[0].as_str(), log[4].as_str(), log.len()), ("0.01", "100", 5));
    for (found, expected) in log.iter().zip([0.01, 0.1, 1.0, 10.0, 100.0]) {
        assert!((found.parse::<f64>().unwrap() / expected - 1.0).abs() < 1e-12, "{found}");
    }
    assert_eq!(
        values("times", "(from: 1, to: 9, steps: 6, scale: Log)"),
        ["1", "2", "3", "4", "6", "9"]
    );
    assert_eq!(values("times", "(values: [7, 0])"), ["7", "0"]);
}

/// Catches bounds of a list that are not kept, and elements that change their order.
#[test]
fn lists_are_subsets_in_order() {
    let text = r#"(module: "twice", fill: {"inner": "plain"})"#;
    let library = library().module(
        "value",
        "sum",
        r#"slots: {"all": (interface: "value", arity: List, prefix: "all_")}"#,
        "fn value(x: f32) -> f32 {\n    return all_value(x);\n}\n",
    );
    let catalog = library.catalog().unwrap();
    let taken = |bounds: &str| -> Vec<String> {
        let of = format!(r#"(some_of: ["plain", {text}, "scaled"]{bounds})"#);
        let text = value(&format!(r#"(module: "sum", fill: {{"all": {of}}})"#));
        let space = Space::parse(&catalog, "a", &text).unwrap_or_else(|report| panic!("{report}"));
        space.iter().unwrap().map(|p| p.choices[0].chosen.clone()).collect()
    };
    assert_eq!(taken("").len(), 8);
    assert_eq!(
        sorted(taken(", min: 2, max: 2")),
        ["[plain, scaled]", "[plain, twice]", "[twice, scaled]"]
    );
    assert_eq!(sorted(taken(", max: 1")), ["[]", "[plain]", "[scaled]", "[twice]"]);
    // `sum` inside `sum` is never opened.
    let all = Space::parse(&catalog, "a", &value("(fits: Open)")).unwrap();
    assert!(all.iter().unwrap().all(|p| p.recipe.source.text.matches("\"sum\"").count() <= 1));
    assert!(all.count().unwrap() > 8);
}

/// Catches limits that are not counted, counted for the wrong kind of resource, or not taken together over the tree.
#[test]
fn limits_of_the_target() {
    let texture = |name: &str| {
        (
            name.to_owned(),
            r#"resources: {"image": (kind: Texture()), "image_sampler": (kind: Sampler(linear: true))}"#,
            "var image: texture_2d<f32>;\nvar image_sampler: sampler;\nfn value(x: f32) -> f32 {\n    return textureSampleLevel(image, image_sampler, vec2f(x), 0.0).x;\n}\n",
        )
    };
    let mut library = library().module(
        "value",
        "sum",
        r#"slots: {"all": (interface: "value", arity: List, prefix: "all_")}"#,
        "fn value(x: f32) -> f32 {\n    return all_value(x);\n}\n",
    );
    for (name, manifest, wgsl) in [texture("a"), texture("b"), texture("c")] {
        library = library.module("value", &name, manifest, wgsl);
    }
    library = library.module(
        "value",
        "half",
        r#"capabilities: ["SHADER_FLOAT16"]"#,
        "enable f16;\nfn value(x: f32) -> f32 {\n    return f32(f16(x));\n}\n",
    );
    let catalog = library.catalog().unwrap();
    let count = |limits: &str| {
        let root = value(r#"(module: "sum", fill: {"all": (some_of: ["a", "b", "c", "half"])})"#);
        let text = format!("(root: {root}, limits: ({limits}))");
        Space::parse(&catalog, "a", &text)
            .unwrap_or_else(|report| panic!("{report}"))
            .count()
            .unwrap()
    };
    assert_eq!(count(""), 16);
    assert_eq!(count("textures: 3"), 16);
    assert_eq!(count("textures: 2"), 14);
    assert_eq!(count("samplers: 1"), 8);
    assert_eq!(count("textures: 0"), 2);
    // `run` has a storage buffer of its own.
    assert_eq!(count("storage_buffers: 1"), 16);
    assert_eq!(count("bindings: 3"), 8);
    assert_eq!(count(r#"lacks: ["SHADER_FLOAT16"]"#), 8);
    assert_eq!(count(r#"textures: 1, lacks: ["SHADER_FLOAT16"]"#), 4);
    // By declarations: what is counted is never less than what is linked.
    let root = value(r#"(module: "sum", fill: {"all": (some_of: ["a", "b", "c"])})"#);
    let limited = Space::parse(&catalog, "a", &format!("(root: {root}, limits: (bindings: 5))")).unwrap();
    assert_eq!(limited.count().unwrap(), 7);
    for permutation in limited.iter().unwrap() {
        let program = catalog
            .compile(&permutation.recipe, "main")
            .unwrap_or_else(|report| panic!("{report}"));
        assert!(program.reflection().bindings.len() <= 5);
    }
}

/// Catches draws that are not uniform, repeat, or depend on anything but the seed.
#[test]
fn samples_are_uniform_and_repeatable() {
    let space = space(&value(r#"(module: "scaled", freeze: {"by": (from: 0.0, to: 9.0, steps: 9)})"#));
    assert_eq!(space.count().unwrap(), 10);
    assert_eq!(space.random(4, 1).unwrap(), space.random(4, 1).unwrap());
    assert_eq!(space.random(99, 1).unwrap(), (0..10).collect::<Vec<u128>>());
    let mut drawn: BTreeMap<u128, u32> = BTreeMap::new();
    for seed in 0..2000 {
        let sample = space.random(3, seed).unwrap();
        assert_eq!(sample.iter().collect::<BTreeSet<_>>().len(), 3);
        for index in sample {
            *drawn.entry(index).or_default() += 1;
        }
    }
    // Of 6000 each has 600; the standard deviation is 20.5.
    assert_eq!(drawn.len(), 10);
    assert!(drawn.values().all(|&n| (500..700).contains(&n)), "{drawn:?}");
}

/// Catches an order of results that depends on the threads, one failure that takes others with it, and a wish to stop that is not heard.
#[test]
fn compiling_many() {
    let broken = library().module("value", "broken", "", "fn value(x: f32) -> f32 {\n    return y;\n}\n");
    let catalog = broken.catalog().unwrap();
    let space = Space::parse(&catalog, "a", &value("(fits: Open)")).unwrap();
    let all: Vec<Permutation> = space.iter().unwrap().collect();
    assert_eq!(all.len(), 7);
    let done = AtomicUsize::new(0);
    let results = |threads: usize, cancel: bool| {
        let work = Work {
            passes: Passes::All,
            threads,
            cancel: &AtomicBool::new(cancel),
            progress: &|_| {
                done.fetch_add(1, Ordering::Relaxed);
            },
        };
        compile_all(&catalog, &all, &work, |p, compiled| {
            let programs = compiled
                .into_iter()
                .map(|(pass, result)| (pass, result.map(|program| program.hash()).map_err(|report| report.render())));
            (p.index, programs.collect::<Vec<_>>())
        })
    };
    let one = results(1, false);
    assert_eq!(done.load(Ordering::Relaxed), 7);
    assert_eq!(one, results(3, false));
    for (permutation, result) in all.iter().zip(&one) {
        let (index, programs) = result.as_ref().unwrap();
        assert_eq!(*index, permutation.index);
        let broken = permutation.recipe.source.text.contains("broken");
        assert!(
            matches!(&programs[..], [(pass, result)] if pass == "main" && result.is_err() == broken),
            "{programs:?}"
        );
    }
    assert!(results(2, true).iter().all(Option::is_none));
}
