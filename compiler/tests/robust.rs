//! No input makes the compiler panic, abort or hang: damaged manifests, WGSL and recipes of the standard library are refused with an
//! error in its place, or linked lawfully.
//!
//! `ROBUST_CASES` and `ROBUST_SEED` run more cases, or others, by hand.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod common;

use std::time::{Duration, Instant};

use common::{Texts, recipes, small, standard};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use shadewright_compiler::canonical::canonical_hash;
use shadewright_compiler::diagnostics::codes;
use shadewright_compiler::{Catalog, Recipe, Report, Target, emit, limits};

/// Far above what any of these inputs takes, also in a debug build on a loaded machine.
const PATIENCE: Duration = Duration::from_secs(20);

/// One change of a text; the numbers choose where and what, modulo what there is.
#[derive(Clone, Debug)]
enum Change {
    /// Another byte, if the text stays UTF-8.
    Byte(usize, u8),
    /// A stretch goes.
    Delete(usize, usize),
    /// A line stands twice.
    Line(usize),
    /// Two words or signs change places.
    Swap(usize, usize),
    /// A word or sign of another text replaces one.
    Foreign(usize, usize, usize),
    /// The text ends early.
    Cut(usize),
    /// Signs that mean much, somewhere.
    Insert(usize, usize),
}

const SIGNS: [&str; 24] = [
    "(",
    ")",
    "{",
    "}",
    "[",
    "]",
    "<",
    ">",
    ";",
    ",",
    "/*",
    "//",
    "@",
    "\"",
    "\\",
    ".",
    "..",
    "é",
    "\0",
    "-",
    "&",
    "*",
    "_",
    "fn value() {}",
];

fn change() -> impl Strategy<Value = Change> {
    let at = any::<usize>;
    prop_oneof![
        (at(), any::<u8>()).prop_map(|(a, b)| Change::Byte(a, b)),
        (at(), 1..40usize).prop_map(|(a, n)| Change::Delete(a, n)),
        at().prop_map(Change::Line),
        (at(), at()).prop_map(|(a, b)| Change::Swap(a, b)),
        (at(), at(), at()).prop_map(|(a, b, c)| Change::Foreign(a, b, c)),
        at().prop_map(Change::Cut),
        (at(), at()).prop_map(|(a, b)| Change::Insert(a, b)),
    ]
}

/// Byte ranges of words, numbers and single signs.
fn tokens(text: &str) -> Vec<std::ops::Range<usize>> {
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| !c.is_whitespace()) {
        match tokens.last_mut() {
            Some(last) if last.end == at && word(c) && text[last.clone()].chars().all(word) => last.end += c.len_utf8(),
            _ => tokens.push(at..at + c.len_utf8()),
        }
    }
    tokens
}

impl Change {
    fn apply(&self, text: &str, others: &[&String]) -> String {
        if text.is_empty() {
            return text.to_owned();
        }
        let place = |at: usize| text.floor_char_boundary(at % text.len());
        let tokens = tokens(text);
        let token = |at: usize| tokens.get(at % tokens.len().max(1)).cloned().unwrap_or(0..0);
        match *self {
            Self::Byte(at, byte) => {
                let mut bytes = text.as_bytes().to_vec();
                bytes[at % text.len()] = byte;
                String::from_utf8(bytes).unwrap_or_else(|_| text.to_owned())
            }
            Self::Delete(at, length) => {
                let start = place(at);
                format!(
                    "{}{}",
                    &text[..start],
                    &text[text.ceil_char_boundary((start + length).min(text.len()))..]
                )
            }
            Self::Line(at) => {
                let lines: Vec<&str> = text.lines().collect();
                let twice = at % lines.len();
                let all = lines
                    .iter()
                    .enumerate()
                    .flat_map(|(i, line)| vec![*line; 1 + usize::from(i == twice)]);
                all.collect::<Vec<_>>().join("\n")
            }
            Self::Swap(a, b) => {
                let (a, b) = (token(a), token(b));
                let (a, b) = if a.start <= b.start { (a, b) } else { (b, a) };
                if a.end > b.start {
                    return text.to_owned();
                }
                format!(
                    "{}{}{}{}{}",
                    &text[..a.start],
                    &text[b.clone()],
                    &text[a.end..b.start],
                    &text[a.clone()],
                    &text[b.end..]
                )
            }
            Self::Foreign(at, which, from) => {
                let other = others[which % others.len()];
                let there = self::tokens(other);
                let Some(piece) = there.get(from % there.len().max(1)) else {
                    return text.to_owned();
                };
                let here = token(at);
                format!("{}{}{}", &text[..here.start], &other[piece.clone()], &text[here.end..])
            }
            Self::Cut(at) => text[..place(at)].to_owned(),
            Self::Insert(at, sign) => {
                let at = place(at);
                format!("{}{}{}", &text[..at], SIGNS[sign % SIGNS.len()], &text[at..])
            }
        }
    }
}

/// An error has a known code, and places that are places of its files.
fn assert_sound(report: &Report) {
    assert!(!report.diagnostics.is_empty());
    for diagnostic in &report.diagnostics {
        assert!(codes::ALL.iter().any(|(code, _)| *code == diagnostic.code), "{}", diagnostic.code);
        assert!(!diagnostic.message.is_empty(), "{report}");
        for label in &diagnostic.labels {
            let (text, span) = (&label.file.text, &label.span);
            assert!(text.get(span.clone()).is_some(), "{span:?} of {}: {report}", label.file.name);
        }
    }
    report.render();
    report.to_json();
}

/// Compiles what there is of a library and a recipe. What links is lawful.
fn run(texts: &Texts, name: &str, recipe: &str, module: Option<&str>, target: Target) -> Result<(), Report> {
    let catalog: Catalog = texts.catalog()?;
    if let Some(module) = module {
        catalog.check_module(module)?;
    }
    let recipe = Recipe::parse(name, recipe)?;
    let program = catalog.compile(&recipe, "main")?;
    let text = program.wgsl();
    match canonical_hash("source form", text) {
        Ok(hash) => assert_eq!(hash, program.hash(), "the two forms differ:\n{text}"),
        Err(report) => panic!("the source form is no WGSL: {report}\n{text}"),
    }
    serde_json::to_string(program.reflection()).unwrap();
    emit(
        program.validated(),
        target,
        program.reflection().entry_points.first().map(|e| e.name.as_str()),
    )?;
    Ok(())
}

#[test]
fn damaged_libraries_and_recipes() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let cases = number("ROBUST_CASES").unwrap_or(300) as u32;
    let mut seed = [7; 32];
    seed[..8].copy_from_slice(&number("ROBUST_SEED").unwrap_or(1).to_le_bytes());
    let config = Config {
        cases,
        failure_persistence: None,
        max_shrink_iters: 200,
        ..Config::default()
    };
    let library = standard();
    let recipes: Vec<(String, String)> = recipes().into_iter().collect();
    let paths: Vec<&String> = library.0.keys().collect();
    let all: Vec<&String> = library.0.values().collect();
    let mut runner = TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    let strategy = (any::<usize>(), any::<usize>(), proptest::collection::vec(change(), 1..4));
    let outcomes = std::cell::RefCell::new(std::collections::BTreeMap::<String, usize>::new());
    let result = runner.run(&strategy, |(which, recipe, changes)| {
        let start = Instant::now();
        let (name, mut recipe) = recipes[recipe % recipes.len()].clone();
        let mut texts = library.clone();
        let target = Target::ALL[which % Target::ALL.len()];
        let which = which % (paths.len() + 4);
        let damage = |text: &str| changes.iter().fold(text.to_owned(), |text, change| change.apply(&text, &all));
        let mut module = None;
        if let Some(path) = paths.get(which) {
            texts.0.insert((*path).clone(), damage(&library.0[*path]));
            let folder: Vec<&str> = path.split('/').collect();
            module = (folder.len() == 3).then(|| format!("{}/{}", folder[0], folder[1]));
        } else {
            recipe = damage(&recipe);
        }
        let outcome = run(&texts, &name, &recipe, module.as_deref(), target);
        if let Err(report) = &outcome {
            assert_sound(report);
        }
        let outcome = outcome.map_or_else(|report| report.diagnostics[0].code, |()| "linked");
        *outcomes.borrow_mut().entry(outcome.to_owned()).or_default() += 1;
        prop_assert!(start.elapsed() < PATIENCE, "took {:?}", start.elapsed());
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    let outcomes = outcomes.into_inner();
    if number("ROBUST_CASES").is_some() {
        println!("{outcomes:?}");
    }
    assert!(outcomes.len() > 5, "the changes reach too little: {outcomes:?}");
}

/// Catches recursion of ours as deep as an input wants: what the limits let through links, on a thread's ordinary stack.
#[test]
fn the_deepest_accepted_modules() {
    let chain = (0..2000).fold(String::new(), |text, i| {
        text + &format!("fn go{i}(x: f32) -> f32 {{ return go{}(x); }}\n", i + 1)
    });
    let blocks = limits::WGSL_NESTING - 2;
    for (what, body) in [
        (
            "blocks",
            format!(
                "fn value(x: f32) -> f32 {{ var y = x; {}y += x;{} return y; }}",
                "if y > x { ".repeat(blocks),
                "}".repeat(blocks)
            ),
        ),
        (
            "else",
            format!(
                "fn value(x: f32) -> f32 {{ var y = x; if x > 0.0 {{ y = 1.0; }} {} return y; }}",
                "else if x > 0.0 { y = 2.0; } ".repeat(1000)
            ),
        ),
        ("sum", format!("fn value(x: f32) -> f32 {{ return x{}; }}", " + x".repeat(1000))),
        (
            "calls",
            format!("{chain}fn go2000(x: f32) -> f32 {{ return x; }}\nfn value(x: f32) -> f32 {{ return go0(x); }}"),
        ),
    ] {
        let texts = small().module("value", "m", "", &body);
        // The long chain takes its time in a debug build.
        let targets = if what == "calls" { &Target::ALL[..1] } else { &Target::ALL[..] };
        for &target in targets {
            if let Err(report) = run(&texts, "r", r#"(module: "run", fill: {"value": "m"})"#, Some("m"), target) {
                assert_sound(&report);
                assert!(report.diagnostics[0].code.starts_with("SW06"), "{what}: {report}");
            }
        }
    }
}
