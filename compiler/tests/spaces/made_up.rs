//! Libraries and spaces made up from a tape of numbers, so that proptest can shrink them.

use crate::common::Texts;

/// Numbers to decide by; zeros where it ends.
pub struct Tape<'t>(pub &'t [u8], pub usize);

impl Tape<'_> {
    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        let number = self.0.get(self.1).copied().unwrap_or(0);
        self.1 += 1;
        usize::from(number) % n
    }

    fn one<'a>(&mut self, of: &[&'a str]) -> &'a str {
        of[self.below(of.len())]
    }
}

/// Categories from the top down; modules of each have slots for those below it.
const LEVELS: [&str; 3] = ["top", "mid", "low"];
/// Words that rules look for.
const TAGS: [&str; 8] = ["p", "q", "top", "mid", "low", "mid0", "low0", "low1"];

/// A library: a root `run`, three levels of modules with slots, rules, properties and constants.
pub fn library(tape: &mut Tape) -> Texts {
    let mut texts = Texts::default().category("pass", "group: 3", "");
    for level in LEVELS {
        let interface = format!("fn {level}(x: f32) -> f32 {{\n    return x;\n}}\n");
        texts = texts.category(level, &format!("combine: {{\"{level}\": Sum}}"), &interface);
    }
    texts = texts.module(
        "pass",
        "run",
        &format!(
            r#"slots: {{"top": (interface: "top", arity: {}, default: "top0")}}, resources: {{"out": (kind: Host("out"))}}"#,
            tape.one(&["Single", "List"])
        ),
        "var<storage, read_write> out: array<f32>;\n\n@compute @workgroup_size(1)\nfn main() {\n    out[0] = top(out[1]);\n}\n",
    );
    for (depth, level) in LEVELS.iter().enumerate() {
        for number in 0..1 + tape.below(3) {
            texts = module(texts, tape, depth, level, number);
        }
    }
    // Every word that rules look for is somebody's, if nobody's who is ever used.
    let spare = "fn spare() -> f32 {\n    return 0.0;\n}\n";
    texts
        .category("spare", "", spare)
        .module("spare", "low1", r#"properties: ["p", "q"]"#, spare)
}

fn module(texts: Texts, tape: &mut Tape, depth: usize, level: &str, number: usize) -> Texts {
    let mut slots = String::new();
    let mut sum = format!("x * {}.0", 2 + number);
    for below in LEVELS.iter().skip(depth + 1) {
        if tape.below(4) == 0 {
            continue;
        }
        let arity = tape.one(&["Single", "Optional", "List"]);
        let default = if arity == "Single" || tape.below(3) == 0 {
            format!("default: \"{below}0\", ")
        } else {
            String::new()
        };
        slots += &format!("\"{below}\": (interface: \"{below}\", arity: {arity}, {default}), ");
        sum += &format!(" + {below}(x)");
    }
    let params = if tape.below(2) == 0 {
        sum += " + f32(params.k)";
        "params: {\"k\": (type: U32, default: 1, range: (0, 9), mode: Constant)},"
    } else {
        ""
    };
    let properties = tape.one(&["", "\"p\"", "\"q\"", "\"p\", \"q\""]);
    let rules = if tape.below(4) == 0 { rule(tape, None) } else { String::new() };
    texts.module(
        level,
        &format!("{level}{number}"),
        &format!("slots: {{{slots}}}, {params} properties: [{properties}], rules: [{rules}],"),
        &format!("fn {level}(x: f32) -> f32 {{\n    return {sum};\n}}\n"),
    )
}

fn rule(tape: &mut Tape, when: Option<&str>) -> String {
    let kind = tape.one(&["Requires", "Excludes"]);
    let (tag, among) = (tape.one(&TAGS), tape.one(&["Parent", "Children", "Tree"]));
    let when = when.map_or(String::new(), |when| format!("when: \"{when}\", "));
    format!("{kind}({when}tag: \"{tag}\", among: {among}, because: \"made up\"), ")
}

/// A space over a library of [`library`]. `known` says whether the library has a module.
pub fn space(tape: &mut Tape, texts: &Texts) -> String {
    let manifest = |category: &str, name: &str| texts.0.get(&format!("{category}/{name}/module.ron")).cloned();
    let list = manifest("pass", "run").unwrap().contains("arity: List");
    let top = choice(tape, &manifest, "top", list, 0);
    let mut rules = String::new();
    for _ in 0..tape.below(3) {
        let when = tape.one(&["run", "p", "q", "mid", "low0", "w"]);
        let when = if tape.below(3) == 0 { None } else { Some(when) };
        let kind = rule(tape, when);
        rules += &if tape.below(3) == 0 {
            kind.replacen("tag: \"p\"", "tag: \"w\"", 1)
        } else {
            kind
        };
    }
    // The tag `w` is in every space, so that rules may name it.
    format!("(root: (module: \"run\", tags: [\"w\"], fill: {{\"top\": {top}}}), rules: [{rules}])")
}

type Manifests<'a> = dyn Fn(&str, &str) -> Option<String> + 'a;

fn choice(tape: &mut Tape, manifest: &Manifests, level: &str, list: bool, depth: usize) -> String {
    match tape.below(if depth > 4 { 3 } else { 7 }) {
        0 => format!("(fits: {})", tape.one(&["Open", "Defaults"])),
        1 | 2 => node(tape, manifest, level, depth),
        3 | 4 => {
            let of: Vec<String> = (0..1 + tape.below(3))
                .map(|_| choice(tape, manifest, level, list, depth + 1))
                .collect();
            format!("(one_of: [{}])", of.join(", "))
        }
        kind if list => {
            let of: Vec<String> = (0..tape.below(4))
                .map(|_| choice(tape, manifest, level, false, depth + 1))
                .collect();
            let min = tape.below(of.len() + 1);
            let max = min + tape.below(3);
            match kind {
                5 => format!("[{}]", of.join(", ")),
                _ => format!("(some_of: [{}], min: {min}, max: {max})", of.join(", ")),
            }
        }
        _ => node(tape, manifest, level, depth),
    }
}

fn node(tape: &mut Tape, manifest: &Manifests, level: &str, depth: usize) -> String {
    let number = tape.below(3);
    let (name, text) = match manifest(level, &format!("{level}{number}")) {
        Some(text) => (format!("{level}{number}"), text),
        None => (format!("{level}0"), manifest(level, &format!("{level}0")).unwrap()),
    };
    let mut fields = String::new();
    let mut fill = String::new();
    for below in LEVELS {
        let Some((_, rest)) = text.split_once(&format!("\"{below}\": (interface")) else {
            continue;
        };
        if tape.below(2) == 0 {
            let arity = rest.split("arity: ").nth(1).unwrap();
            let inner = match arity.split(',').next().unwrap() {
                "Optional" if tape.below(3) == 0 => "(one_of: [[], (fits: Open)])".to_owned(),
                "List" => choice(tape, manifest, below, true, depth + 1),
                _ => choice(tape, manifest, below, false, depth + 1),
            };
            fill += &format!("\"{below}\": {inner}, ");
        }
    }
    if text.contains("params") && tape.below(2) == 0 {
        let values = tape.one(&["3", "(values: [1, 2])", "(from: 1, to: 3, steps: 2)"]);
        fields += &format!("freeze: {{\"k\": {values}}}, ");
    }
    if tape.below(2) == 0 {
        fields += "label: \"l\", ";
    }
    if tape.below(4) == 0 {
        fields += "tags: [\"w\"], ";
    }
    format!("(module: \"{name}\", fill: {{{fill}}}, {fields})")
}
