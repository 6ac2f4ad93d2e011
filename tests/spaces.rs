//! The space of everything that the standard library can be put together to: its size, its pairwise cover, and what others say of that.
#![allow(clippy::expect_used, clippy::unwrap_used, clippy::print_stdout)]

#[path = "../compiler/tests/spaces/naive.rs"]
mod naive;
mod support;
mod verdict;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;

use naive::Naive;
use shadewright::compiler::space::{Passes, Permutation, Space, SpaceFile, Work, compile_all};
use shadewright::compiler::{Catalog, Program, Recipe, Target, emit};
use support::good;
use verdict::{naga_takes, spirv_val, tint};

/// Trees that are multiplied out at most; a library that makes more is counted by the other tests only.
const FEASIBLE: usize = 50_000;

static CATALOG: LazyLock<Catalog> =
    LazyLock::new(|| Catalog::load(shadewright::modules::library()).unwrap_or_else(|report| panic!("{report}")));

fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/spaces").join(name)
}

fn file(name: &str) -> SpaceFile {
    let text = std::fs::read_to_string(example(name)).expect("an example");
    SpaceFile::parse(name, &text).unwrap_or_else(|report| panic!("{report}"))
}

static STANDARD: LazyLock<Space> = LazyLock::new(|| open(&file("standard.space.ron")));

fn open(file: &SpaceFile) -> Space {
    Space::open(&CATALOG, file).unwrap_or_else(|report| panic!("{report}"))
}

/// Catches a count of real spaces that multiplying out does not bear out, a legal recipe that is missing, and an alternative left out for
/// a module's rule that the compiler would take.
#[test]
fn the_library_holds_exactly_what_is_legal() {
    let naive = Naive {
        catalog: &CATALOG,
        most: FEASIBLE,
    };
    let roots = CATALOG.modules().filter(|m| m.category == "pass");
    let mut files: Vec<SpaceFile> = roots
        .map(|root| {
            let others = CATALOG.modules().filter(|m| m.category == "pass" && m.name != root.name);
            let others: Vec<String> = others.map(|m| m.name.clone()).collect();
            let text = format!("(fits: Open, of: \"pass\", without: {others:?})");
            SpaceFile::parse(&root.name, &text).unwrap_or_else(|report| panic!("{report}"))
        })
        .collect();
    let number = files.len();
    files.push(file("shadows.space.ron"));
    // The whole library has more reflectance and lights than can be multiplied out: with one or two modules of each kind it can, shadows and maps and rules as they are.
    let kinds = ["material", "brdf", "ndf", "masking", "fresnel", "diffuse", "light", "falloff"];
    let kept = [
        "metalness",
        "lambert",
        "microfacet",
        "ggx",
        "smith-ggx-correlated",
        "schlick",
        "lambertian",
        "point",
        "directional",
        "frostbite",
    ];
    let others = CATALOG.modules().filter(|m| {
        m.category == "pass" && m.name != "forward" || kinds.contains(&m.category.as_str()) && !kept.contains(&m.name.as_str())
    });
    let others: Vec<String> = others.map(|m| m.name.clone()).collect();
    let text = format!("(fits: Open, of: \"pass\", without: {others:?})");
    files.push(SpaceFile::parse("one of each kind", &text).unwrap_or_else(|report| panic!("{report}")));
    let (mut sum, mut counted, mut refused) = (0, 0, 0);
    for file in &files {
        let space = open(file);
        let name = &file.source.name;
        let Ok(trees) = naive.trees(file) else {
            println!("{name}: too many to multiply out");
            continue;
        };
        let mut legal = BTreeSet::new();
        for (index, tree) in trees.iter().enumerate() {
            let (wrong, kept) = naive.judge(tree, &file.rules);
            if wrong.is_empty() && kept {
                legal.insert(naive.text(tree));
            } else if !wrong.is_empty() && index % 40 == 0 {
                let report = CATALOG
                    .plan(&Recipe::from(naive.recipe(tree)), "main")
                    .expect_err("a rule forbids it");
                assert!(wrong.contains(&report.diagnostics[0].code), "{report}");
                refused += 1;
            }
        }
        println!("{name}: {} legal of {}, {} choices", legal.len(), trees.len(), space.choices());
        assert_eq!(space.count().expect("few"), legal.len() as u128, "{name}");
        let found: BTreeSet<String> = space.iter().expect("few").map(|p| naive.text_of(&p.recipe.root)).collect();
        assert_eq!(found, legal, "{name}");
        counted += 1;
        if files[..number].iter().any(|one| std::ptr::eq(file, one)) {
            sum += legal.len() as u128;
        }
    }
    assert!(counted >= 4 && refused > 0, "{counted} {refused}");
    if counted == files.len() {
        assert_eq!(STANDARD.count().expect("few"), sum);
    }
}

fn pairs(permutations: &[Permutation]) -> BTreeSet<(usize, usize)> {
    let of = |p: &Permutation| p.options.clone();
    let all = permutations.iter().map(of).collect::<BTreeSet<_>>();
    all.iter()
        .flat_map(|options| options.iter().flat_map(|&a| options.iter().map(move |&b| (a, b))))
        .collect()
}

/// Catches a legal pair of options of the real library that the cover misses, judged by all legal permutations one after the other (or a
/// large sample, where a library has grown too large for that).
#[test]
fn the_cover_has_every_legal_pair() {
    let all: Vec<Permutation> = match STANDARD.count() {
        Ok(count) if count <= FEASIBLE as u128 => STANDARD.iter().expect("few").collect(),
        _ => {
            let drawn = STANDARD.random(FEASIBLE / 5, 1).expect("it can be numbered");
            drawn.into_iter().filter_map(|index| STANDARD.get(index)).collect()
        }
    };
    let cover = STANDARD.pairwise().expect("not too many");
    let (legal, covered) = (pairs(&all), pairs(&cover));
    println!("{} permutations cover the {} pairs of {}", cover.len(), legal.len(), all.len());
    assert!(legal.is_subset(&covered), "{:?}", legal.difference(&covered).next());
    // Layers of reflectance stand in each other: the pairs of what lies in one place and in another are many.
    assert!(
        legal.len() > 500 && cover.len() * 10 < legal.len(),
        "{} {}",
        legal.len(),
        cover.len()
    );
}

/// Catches a legal recipe that does not compile. Of a library with many, a sample.
#[test]
fn every_legal_recipe_compiles() {
    const MOST: u128 = 4000;
    let numbers = match STANDARD.count() {
        Ok(count) if count <= MOST => (0..count).collect(),
        _ => STANDARD.random(MOST as usize, 2).expect("it can be numbered"),
    };
    let drawn: Vec<Permutation> = numbers.into_iter().filter_map(|index| STANDARD.get(index)).collect();
    let work = Work {
        passes: Passes::One("main".to_owned()),
        threads: 2,
        cancel: &AtomicBool::new(false),
        progress: &|_| {},
    };
    let mut distinct = BTreeSet::new();
    for (permutation, hash) in drawn.iter().zip(compile_all(&CATALOG, &drawn, &work, |_, mut compiled| {
        compiled.remove(0).1.map(|program| program.hash())
    })) {
        let hash = hash.expect("nobody stops it");
        distinct.insert(hash.unwrap_or_else(|report| panic!("{}\n{report}", permutation.recipe.source.text)));
    }
    println!("{} permutations, {} distinct programs", drawn.len(), distinct.len());
    assert!(drawn.len() > 100 && distinct.len() > 100);
}

/// The distinct programs of the cover, every pass of each, by hash.
fn programs() -> Vec<Program> {
    let cover = STANDARD.pairwise().expect("not too many");
    let work = Work {
        passes: Passes::All,
        threads: 2,
        cancel: &AtomicBool::new(false),
        progress: &|_| {},
    };
    let mut distinct = BTreeMap::new();
    for compiled in compile_all(&CATALOG, &cover, &work, |_, compiled| compiled) {
        for (pass, result) in compiled.expect("nobody stops it") {
            let program = result.unwrap_or_else(|report| panic!("pass {pass}: {report}"));
            distinct.entry(program.hash()).or_insert(program);
        }
    }
    println!("{} permutations, {} distinct programs", cover.len(), distinct.len());
    distinct.into_values().collect()
}

/// Catches a legal combination of the library that does not link or validate, whose source naga or a browser refuses, or whose SPIR-V breaks
/// Vulkan's rules.
#[test]
fn everybody_accepts_the_cover() {
    let programs = programs();
    assert!(programs.len() >= 20, "{}", programs.len());
    let judge = |programs: &[Program]| {
        let (mut tinted, mut validated) = (0, 0);
        for program in programs {
            let wgsl = program.wgsl();
            naga_takes(wgsl).unwrap_or_else(|error| panic!("{error}\n{wgsl}"));
            if let Some(verdict) = tint(wgsl) {
                verdict.unwrap_or_else(|error| panic!("{error}\n{wgsl}"));
                tinted += 1;
            }
            let spirv = emit(program.validated(), Target::SpirV, None).unwrap_or_else(|report| panic!("{report}\n{wgsl}"));
            if let Some(verdict) = spirv_val(&spirv) {
                verdict.unwrap_or_else(|error| panic!("{error}\n{wgsl}"));
                validated += 1;
            }
        }
        (tinted, validated)
    };
    let halves = programs.split_at(programs.len() / 2);
    let (a, b) = std::thread::scope(|scope| {
        let other = scope.spawn(|| judge(halves.1));
        (
            judge(halves.0),
            other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
        )
    });
    println!("tint accepts {}, spirv-val {}", a.0 + b.0, a.1 + b.1);
    // Installed or not, but not for some.
    assert!([0, programs.len()].contains(&(a.0 + b.0)) && [0, programs.len()].contains(&(a.1 + b.1)));
}

/// Catches an example that does not say what it means to.
#[test]
fn the_examples_are_right() {
    for name in ["standard.space.ron", "shadows.space.ron"] {
        let path = example(name);
        assert!(good(&["check", path.to_str().expect("UTF-8")]).text().starts_with("ok     space "));
    }
    // 2 sides, times 3 pairs of material and BRDF, times lights: the sun's 4 and a lamp's 2 alone, and together all but soft with cube.
    let shadows = open(&file("shadows.space.ron"));
    assert_eq!(shadows.count().expect("few"), 2 * 3 * (4 + 2 + (4 * 2 - 2)));
    assert_eq!(shadows.never(), []);
}
