//! What a linked shader computes is what the modules' text says: adversarial modules, run on the device and compared with
//! values computed here; and the source form means the same as the IR form that ran.

#![allow(clippy::unwrap_used)]

mod common;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use common::gpu;
use serde_json::json;
use shadewright::compiler::canonical::canonical_hash;
use shadewright::compiler::{Catalog, Library, Recipe};
use shadewright::runtime::probe::probe;

#[derive(Clone, Default)]
struct Texts(BTreeMap<String, String>);

impl Library for Texts {
    fn folders(&self, folder: &str) -> Vec<String> {
        let prefix = if folder.is_empty() { String::new() } else { format!("{folder}/") };
        let below = self
            .0
            .keys()
            .filter_map(|p| p.strip_prefix(&prefix)?.split_once('/').map(|(n, _)| n.to_owned()));
        below.collect::<BTreeSet<_>>().into_iter().collect()
    }

    fn read(&self, path: &str) -> Result<Option<String>, String> {
        Ok(self.0.get(path).cloned())
    }
}

impl Texts {
    fn category(mut self, name: &str, manifest: &str, interface: &str) -> Self {
        let manifest = format!("(summary: \"{name}\", order: 1, {manifest})");
        self.0.insert(format!("{name}/category.ron"), manifest);
        self.0.insert(format!("{name}/interface.wgsl"), interface.to_owned());
        self
    }

    fn module(mut self, category: &str, name: &str, manifest: &str, wgsl: &str) -> Self {
        let manifest = format!("(summary: \"{name}\", {manifest})");
        self.0.insert(format!("{category}/{name}/module.ron"), manifest);
        self.0.insert(format!("{category}/{name}/{name}.wgsl"), wgsl.to_owned());
        self
    }

    /// What is wrong with `value(x)` of a recipe at 0.5, 1.5, 2.5 and 3.5, if anything is.
    fn fault(&self, recipe: &str, expected: &dyn Fn(f32) -> f32) -> Option<String> {
        let catalog = match Catalog::load(Arc::new(self.clone())) {
            Ok(catalog) => catalog,
            Err(report) => return Some(format!("no catalog: {report}")),
        };
        let recipe = Recipe::parse("test", recipe).unwrap();
        let program = match catalog.compile_probe(&recipe, "value") {
            Ok(program) => program,
            Err(report) => return Some(format!("no program: {report}")),
        };
        let text = program.wgsl();
        let module = match naga::front::wgsl::parse_str(text) {
            Ok(module) => module,
            Err(error) => return Some(format!("the source form is no WGSL: {}\n{text}", error.emit_to_string(text))),
        };
        let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        if let Err(error) = validator.validate(&module) {
            return Some(format!("the source form is invalid: {error:?}\n{text}"));
        }
        match canonical_hash("source form", text) {
            Ok(hash) if hash == program.hash() => {}
            Ok(_) => return Some(format!("the forms differ:\n{text}")),
            Err(report) => return Some(format!("the source form does not link: {report}\n{text}")),
        }
        let inputs = [0.5f32, 1.5, 2.5, 3.5];
        let rows = inputs.map(|x| json!({ "x": x }));
        let answer = match probe(&gpu(), &catalog, &recipe, "value", &rows) {
            Ok(answer) => answer,
            Err(error) => return Some(format!("it does not run: {error}\n{text}")),
        };
        for (x, got) in inputs.iter().zip(answer["results"].as_array().unwrap()) {
            let got = got.as_f64().unwrap_or(f64::NAN) as f32;
            let expected = expected(*x);
            if got.to_bits() != expected.to_bits() {
                return Some(format!("value({x}) is {got}, expected {expected}\n{text}"));
            }
        }
        None
    }
}

/// Interface `value`, as a slot and offered things.
fn base() -> Texts {
    Texts::default().category(
        "value",
        r#"group: 2, combine: {"value": Sum}"#,
        "fn value(x: f32) -> f32 {\n    return x;\n}\n",
    )
}

/// What every module of these tests may call: a function that acts, one that does not.
const HELPERS: &str = "
struct S {
    a: f32,
    b: f32,
    c: vec2f,
}
struct Flags {
    on: bool,
    n: f32,
}
var<private> count: f32;
fn act(x: f32) -> f32 {
    count += x;
    return x * 2.0;
}
fn next() -> u32 {
    count += 1.0;
    return u32(count) % 2u;
}
fn pure(x: f32) -> f32 {
    return x * 3.0;
}
fn other(x: f32) -> f32 {
    return x * 5.0;
}
";
const NONE: &str = "";
const NO: &str = r#"params: {"flag": (type: Bool, default: false, mode: Constant), "n": (type: U32, default: 3, mode: Constant)}"#;
const YES: &str = r#"params: {"flag": (type: Bool, default: true, mode: Constant), "n": (type: U32, default: 3, mode: Constant)}"#;

type Case = (&'static str, &'static str, &'static str, fn(f32) -> f32);

/// Body of `value` over the helpers, and what it gives.
const CASES: &[Case] = &[
    (
        "a second name of a value, hidden by another let",
        NONE,
        "{ let k = other(x); let a = k; } let a = x * 2.0; return a;",
        |x| x * 2.0,
    ),
    (
        "a chain of second names in parentheses, one of them read",
        NONE,
        "var y = x; { let k = other(x); let a = (k); let b = (a); y += b; } { let k = pure(x); let a = (k); let b = a; } let a = y; let b = a; return b;",
        |x| x + x * 5.0,
    ),
    (
        "a second name of a parameter and of a variable",
        NONE,
        "var v = x * 2.0; { let a = x; let b = v; } let a = v; v = 7.0; let b = x; return a + b;",
        |x| x * 2.0 + x,
    ),
    (
        "act among the arguments of a call of nothing",
        NONE,
        "nothing(act(x)); nothing(1.0); return x + count;",
        |x| x + x,
    ),
    (
        "two names of an act",
        NONE,
        "let k = act(x); let m = k; let n = m + 1.0; return count;",
        |x| x,
    ),
    (
        "calls in conditions",
        NONE,
        "var y = x; while pure(y) < 12.0 && act(1.0) > 0.0 { y += 1.0; } return y + count;",
        |x| {
            let n = (4.0 - x).ceil().max(0.0);
            x + n + n
        },
    ),
    (
        "act in a switch and a discarded comparison",
        NONE,
        "_ = act(x) > 1.0; switch u32(act(1.0)) { case 2u { return count; } default { return 0.0; } }",
        |x| x + 1.0,
    ),
    (
        "constant loop within a branch that leaves",
        YES,
        "var y = x; loop { if params.flag { y += 1.0; if y > 4.0 { break; } continue; } y = other(y); } return y;",
        |x| x + (4.0 - x).floor() + 1.0,
    ),
    (
        "let of a dead chain beside an act",
        NONE,
        "let a = other(x); let b = a + 1.0; let c = b * act(x); return count;",
        |x| x,
    ),
    (
        "dead argument that reads a let",
        NONE,
        "let a = other(x); let b = a + 1.0; let s = S(x, b, vec2f(a)); return s.a;",
        |x| x,
    ),
    (
        "infinite loop with break if true",
        YES,
        "var y = x; loop { y += 1.0; continuing { y += 2.0; break if params.flag; } } return y;",
        |x| x + 3.0,
    ),
    (
        "array of a struct by value",
        NONE,
        "var s = array<S, 2>(make(x), S(1.0, x, vec2f(2.0))); let k = s; return k[1].b + k[0].a + count;",
        |x| x + x * 5.0 + x,
    ),
    (
        "act in the index of a dead store",
        NONE,
        "var s: array<S, 2>; s[next()].b = x; s[0].a = x; return s[0].a + count;",
        |x| x + 1.0,
    ),
    (
        "act in a dead compound assignment",
        NONE,
        "var s: S; s.a = x; s.b += act(x); return s.a + count;",
        |x| x + x,
    ),
    (
        "act in the index of a dead increment",
        NONE,
        "var s: array<Flags, 2>; s[next()].n += 1.0; return x + count;",
        |x| x + 1.0,
    ),
    (
        "act within a pure call whose result is dropped",
        NONE,
        "pure(act(x)); return count;",
        |x| x,
    ),
    (
        "act within a pure call within a dead store",
        NONE,
        "var s: S; s.b = pure(act(x)); s.a = x; return s.a + count;",
        |x| x + x,
    ),
    (
        "act beside a pure call in an unread let",
        NONE,
        "let k = pure(x + 1.0) + act(x); return count;",
        |x| x,
    ),
    (
        "act beside a pure call in a phony assignment",
        NONE,
        "_ = pure(x + 1.0) + act(x); return count;",
        |x| x,
    ),
    (
        "act within pure in an unread let",
        NONE,
        "let k = pure(other(x) + act(x)); return count;",
        |x| x,
    ),
    (
        "act in a let of a branch never taken",
        NO,
        "if params.flag { let k = act(x); return k; } return x + count;",
        |x| x,
    ),
    (
        "pure beside act in a let of a branch never taken",
        NO,
        "if params.flag { let k = act(x) + pure(x); return k; } return x + count;",
        |x| x,
    ),
    (
        "atomics in a branch never taken",
        NO,
        "if params.flag { let k = next(); return f32(k); } return x;",
        |x| x,
    ),
    (
        "loop on false, function only there",
        NO,
        "var y = x; while params.flag { y = other(y); } y = y + 1.0; return y;",
        |x| x + 1.0,
    ),
    (
        "for on false",
        NO,
        "var y = x; for (var i = 0; params.flag; i++) { y = other(y); } y += 1.0; y = pure(y); return y;",
        |x| (x + 1.0) * 3.0,
    ),
    (
        "let read only by a loop on false",
        NO,
        "let k = other(x); var y = x; while params.flag { y += k; } y += 2.0; return y;",
        |x| x + 2.0,
    ),
    (
        "while true",
        YES,
        "var y = x; while params.flag { y += 1.0; if y > 5.0 { break; } } return y;",
        |x| x + (5.0 - x).floor() + 1.0,
    ),
    (
        "for with true",
        YES,
        "var y = x; for (var i = 0u; params.flag; i++) { if i > 3u { break; } y += pure(1.0); } return y;",
        |x| x + 12.0,
    ),
    (
        "continue before continuing",
        YES,
        "var y = x; var i = 0u; loop { if params.flag { continue; } y = other(y); continuing { i++; y += 1.0; break if i > 3u; } } return y;",
        |x| x + 4.0,
    ),
    (
        "continue not taken before continuing",
        NO,
        "var y = x; var i = 0u; loop { if params.flag { continue; } y += 10.0; continuing { i++; y += 1.0; break if i > 3u; } } return y;",
        |x| x + 10.0 + 1.0 + 10.0 + 1.0 + 10.0 + 1.0 + 10.0 + 1.0,
    ),
    (
        "break before continuing",
        YES,
        "var y = x; var i = 0u; loop { y += 1.0; if params.flag { break; } y = other(y); continuing { i++; y += pure(1.0); } } return y;",
        |x| x + 1.0,
    ),
    (
        "continue in for",
        YES,
        "var y = x; for (var i = 0u; i < 3u; i++) { y += 1.0; if params.flag { continue; } y = other(y); } return y;",
        |x| x + 3.0,
    ),
    (
        "dead store in a for header",
        NONE,
        "var s: S; var y = x; var i = 0u; for (s.b = x; i < 3u; s.b += 1.0) { y += 1.0; i++; } y += 1.0; return y + s.a;",
        |x| x + 4.0,
    ),
    (
        "dead store as the update of a for",
        NONE,
        "var s: S; var y = x; for (var i = 0u; y < 5.0; s.b += 1.0) { y += 1.0; } y += 100.0; return y + s.a;",
        |x| x + (5.0 - x).ceil() + 100.0,
    ),
    (
        "pure call as the update of a for",
        NONE,
        "var y = x; for (; y < 5.0; pure(y)) { y += 1.0; } y += 100.0; return y;",
        |x| x + (5.0 - x).ceil() + 100.0,
    ),
    (
        "pure call as the start of a for",
        NONE,
        "var y = x; for (pure(y); y < 5.0; y += 1.0) { } y += 100.0; return y;",
        |x| x + (5.0 - x).ceil() + 100.0,
    ),
    (
        "unread let in a for header",
        NONE,
        "var y = x; for (let k = x; y < 5.0; y += 1.0) { } return y;",
        |x| x + (5.0 - x).ceil(),
    ),
    (
        "alias of a struct that loses members",
        NONE,
        "var t = Alias(x, other(x), vec2f(x)); return t.a;",
        |x| x,
    ),
    (
        "local const struct",
        NONE,
        "const k = S(1.0, 2.0, vec2f(3.0)); return x + k.b;",
        |x| x + 2.0,
    ),
    (
        "let struct of constants",
        NONE,
        "let k = S(1.0, 2.0, vec2f(3.0)); return x + k.b;",
        |x| x + 2.0,
    ),
    ("private struct only written", NONE, "state = T(x, x); return x;", |x| x),
    (
        "private struct read in part",
        NONE,
        "state = T(x, act(x)); return state.a + count;",
        |x| x + x,
    ),
    (
        "unread short circuit with pure",
        NONE,
        "let k = x > 1.0 && pure(x) > 2.0; return x;",
        |x| x,
    ),
    (
        "unread short circuit with act",
        NONE,
        "let k = x > 1.0 && act(x) > 2.0; return x + count;",
        |x| if x > 1.0 { x + x } else { x },
    ),
    ("phony short circuit", NONE, "_ = x > 1.0 || act(x) > 2.0; return x + count;", |x| {
        if x > 1.0 { x } else { x + x }
    }),
    (
        "dead store of a short circuit",
        NONE,
        "var s: Flags; s.on = x > 1.0 && act(x) > 2.0; s.n = x; return s.n + count;",
        |x| if x > 1.0 { x + x } else { x },
    ),
    (
        "dead store of a pure short circuit",
        NONE,
        "var s: Flags; s.on = x > 1.0 && pure(x) > 2.0; s.n = x; return s.n;",
        |x| x,
    ),
    (
        "dead argument with a pure short circuit",
        NONE,
        "let s = Flags(x > 1.0 && pure(x) > 2.0, x); return s.n;",
        |x| x,
    ),
    (
        "short circuit on a constant",
        NO,
        "let k = other(x); let c = params.flag && k > 1.0; return select(x, 7.0, c);",
        |x| x,
    ),
    (
        "short circuit on a constant true",
        YES,
        "let k = other(x); let c = params.flag || k > 1.0; return select(x, 7.0, c);",
        |_| 7.0,
    ),
    (
        "branch on a constant and",
        NO,
        "let k = other(x); if params.flag && act(k) > 1.0 { return 7.0; } return x + count;",
        |x| x,
    ),
    (
        "branch on an or with a constant",
        YES,
        "let k = other(x); if params.flag || act(k) > 1.0 { return 7.0; } return x + count;",
        |_| 7.0,
    ),
    ("branch on a not", NO, "if !params.flag { return other(x); } return x;", |x| x * 5.0),
    (
        "comparisons with variables named like templates",
        NONE,
        "let material = x; let arrays = x; let y = pure(x); let s = Both(material < 2.0, y, (arrays > 1.0)); return select(0.0, 1.0, s.first) + select(0.0, 2.0, s.last);",
        |x| if x < 2.0 { 1.0 } else { 0.0 } + if x > 1.0 { 2.0 } else { 0.0 },
    ),
    (
        "comparisons and dead first",
        NONE,
        "let mat = x; let s = Both(mat < 2.0, pure(x), (x > 1.0)); return s.middle;",
        |x| x * 3.0,
    ),
    (
        "templates in arguments",
        NONE,
        "let s = Big(array<vec2<f32>, 2>(vec2<f32>(x, 1.0), vec2<f32>(2.0, x)), vec2<f32>(x, other(x)), select(1.0, 2.0, x < 1.0)); return s.last;",
        |x| if x < 1.0 { 2.0 } else { 1.0 },
    ),
    (
        "templates in arguments, the first",
        NONE,
        "let s = Big(array<vec2<f32>, 2>(vec2<f32>(x, 1.0), vec2<f32>(2.0, x)), vec2<f32>(x, other(x)), select(1.0, 2.0, x < 1.0)); return s.list[1].x;",
        |_| 2.0,
    ),
    (
        "let alive in one scope",
        NONE,
        "var y = x; if x > 1.0 { let a = other(x); y += a; } else { let a = pure(x); } return y;",
        |x| if x > 1.0 { x + x * 5.0 } else { x },
    ),
    (
        "names shadowed",
        NONE,
        "let other = x; { let x = other + 1.0; let pure = x; return pure + helper(other); }",
        |x| x + 1.0 + x * 7.0,
    ),
    (
        "lets named like their functions",
        NONE,
        "let pure = pure(x); let s = S(pure, x, vec2f(x)); let count = s.a; return count + pure;",
        |x| x * 6.0,
    ),
    (
        "params with blanks",
        YES,
        "var y = x; if params /* { */ . // if }\n flag { y += f32( params\n.\nn ); } return y;",
        |x| x + 3.0,
    ),
    (
        "comments with braces",
        NO,
        "var y = x; /* { if */ if params.flag /* } */ { // } else {\n y = other(y); } else /* if { */ { y += 1.0; /* } */ } return y;",
        |x| x + 1.0,
    ),
    (
        "chain of constants",
        NO,
        "if x > 3.0 { return 1.0; } else if params.flag { return other(x); } else if params.n == 3u { return 2.0; } else { return act(x); }",
        |x| if x > 3.0 { 1.0 } else { 2.0 },
    ),
    (
        "chain with an open tail",
        NO,
        "var y = x; if params.flag { y = other(x); } else if x > 2.0 { y = 2.0; } else if params.n == 4u { y = act(x); } return y + count;",
        |x| if x > 2.0 { 2.0 } else { x },
    ),
    (
        "return in a loop",
        YES,
        "for (var i = 0u; i < 4u; i++) { if x > f32(i) { continue; } if params.flag { return f32(i); } return other(x); } return -1.0;",
        |x| if x > 3.0 { -1.0 } else { x.ceil() },
    ),
    (
        "return not in a loop",
        NO,
        "for (var i = 0u; i < 4u; i++) { if x > f32(i) { continue; } if params.flag { return f32(i); } return other(x); } return -1.0;",
        |x| if x > 3.0 { -1.0 } else { x * 5.0 },
    ),
    (
        "switch with groups",
        YES,
        "var y = 0.0; switch u32(x) { case 0u, 2u { y = 1.0; } case 1u { if params.flag { break; } y = other(x); } default { y = 3.0; } } return y;",
        |x| [1.0, 0.0, 1.0, 3.0][x as usize],
    ),
    (
        "switch on a constant",
        YES,
        "switch params.n { case 1u { return act(x); } case 3u, default { return x + count; } }",
        |x| x,
    ),
    (
        "default in the middle",
        NONE,
        "var y = x; switch u32(x) { case 3u { y += 1.0; } case default, 0u { y += 2.0; } case 1u { y += 4.0; } } return y;",
        |x| x + [2.0, 4.0, 2.0, 1.0][x as usize],
    ),
    (
        "pointer parameter",
        NONE,
        "var s = S(x, 1.0, vec2f(2.0)); bump(&s); bump(&s); return sum(&s);",
        |x| x + 1.0 + 1.0 + 4.0,
    ),
    (
        "result of a pointer function unread",
        NONE,
        "var y = x; let unread = raise(&y); raise(&y); _ = raise(&y); return y;",
        |x| x + 3.0,
    ),
    (
        "copies",
        NONE,
        "var p = S(x, 1.0, vec2f(2.0, 3.0)); var q = p; p.a = 9.0; q.b = p.a; p = q; return p.a + p.b;",
        |x| x + 9.0,
    ),
    (
        "array of structs",
        NONE,
        "var s: array<S, 3>; for (var i = 0u; i < 3u; i++) { s[i].a = x * f32(i); s[i].b = act(1.0); s[i].c.y = 4.0; } return s[u32(x) % 3u].a + count;",
        |x| x * ((x as u32 % 3) as f32) + 3.0,
    ),
    (
        "nested structs",
        NONE,
        "var n: Nest; n.inner[next()] = S(x, 2.0, vec2f(x)); n.one.b = pure(x); n.unread = act(1.0); let k = n.inner; return k[1].a + n.one.b + count;",
        |x| x + x * 3.0 + 2.0,
    ),
    ("partly read result", NONE, "let k = make(x).b; return k + count;", |x| x * 2.0 + x),
    (
        "read before the store of the next round",
        NONE,
        "var last = 0.0; var sum = 0.0; var s: S; for (var i = 0u; i < 3u; i++) { sum += last + s.b; last = x; s.b = pure(x); s.a = sum; } return sum;",
        |x| x * 2.0 + x * 6.0,
    ),
    (
        "break if reads what the body stores",
        NONE,
        "var s: S; var y = x; loop { s.a += 1.0; s.b = y; y += 1.0; continuing { s.a += 1.0; break if s.a > 5.0; } } return y;",
        |x| x + 3.0,
    ),
    (
        "modf and frexp",
        NONE,
        "let m = modf(x); let f = frexp(x); let unread = modf(act(x)); return m.fract + m.whole * 10.0 + f32(f.exp) + count;",
        |x| x.fract() + x.trunc() * 10.0 + (x.log2().floor() + 1.0) + x,
    ),
    (
        "pointer to a member",
        NONE,
        "var s: S; let p = &s.a; let q = &s.b; *p = x; *q = act(x); *p += 1.0; return s.a + count;",
        |x| x + 1.0 + x,
    ),
    (
        "member through a pointer",
        NONE,
        "var s: S; let p = &s; p.b = 3.0; (*p).a = x; (*p).c = vec2f(1.0); return p.a;",
        |x| x,
    ),
    (
        "comment that ends above a dead store",
        NONE,
        "var s: S;\n/* one\n// two */\n    s.b = 3.0;\n s.a = x; return s.a;",
        |x| x,
    ),
    (
        "workgroup and atomics",
        NONE,
        "let unread = atomicAdd(&shared_count, 1u); var s: S; s.b = f32(atomicAdd(&shared_count, 1u)); s.a = x; return s.a;",
        |x| x,
    ),
    (
        "vector components",
        NONE,
        "var s: S; s.c.x = x; s.c[1] = act(x); s.c += vec2f(1.0); return s.c.x + count;",
        |x| x + 1.0 + x,
    ),
    (
        "nested constant ifs",
        YES,
        "var y = x; if params.flag { if params.n == 3u { y += 1.0; if !params.flag { return other(x); } else { y += 2.0; } } else { return act(x); } } else { return other(y); } return y;",
        |x| x + 3.0,
    ),
    (
        "leaves through nested constants",
        YES,
        "var y = x; if params.flag { if params.n == 3u { y += 1.0; return y; } y = other(y); } y = act(y); return y;",
        |x| x + 1.0,
    ),
    (
        "let before what leaves",
        YES,
        "let k = other(x); if params.flag { return x; } return k;",
        |x| x,
    ),
    (
        "pure function that reads what acts write",
        NONE,
        "let before = peek(); let k = act(x); let after = peek(); var s = S(before, k, vec2f(after)); return s.a + s.c.x;",
        |x| x,
    ),
    ("call order", NONE, "let a = act(x) + peek() * 10.0; return a;", |x| {
        x * 2.0 + x * 10.0
    }),
];

const MORE: &str = "
alias Alias = S;
struct T {
    a: f32,
    b: f32,
}
struct Both {
    first: bool,
    middle: f32,
    last: bool,
}
struct Big {
    list: array<vec2<f32>, 2>,
    pair: vec2<f32>,
    last: f32,
}
struct Nest {
    inner: array<S, 2>,
    one: S,
    unread: f32,
}
var<private> state: T;
var<workgroup> shared_count: atomic<u32>;
fn bump(p: ptr<function, S>) {
    (*p).a += (*p).b;
    p.c.y = 7.0;
}
fn sum(p: ptr<function, S>) -> f32 {
    return (*p).a + (*p).c.x * 2.0;
}
fn raise(p: ptr<function, f32>) -> f32 {
    *p += 1.0;
    return *p;
}
fn helper(x: f32) -> f32 {
    return x * 7.0;
}
fn make(x: f32) -> S {
    return S(other(x), act(x), vec2f(x));
}
fn nothing(x: f32) {
}
fn peek() -> f32 {
    return count;
}
";

/// Each case catches a form of its own of a linked shader that does something else than the text, or two forms that differ.
#[test]
fn bodies() {
    let mut faults = Vec::new();
    for (name, manifest, body, expected) in CASES {
        let wgsl = format!("{HELPERS}{MORE}fn value(x: f32) -> f32 {{\n    {body}\n}}\n");
        let texts = base().module("value", "m", manifest, &wgsl);
        if let Some(fault) = texts.fault("\"m\"", expected) {
            faults.push(format!("== {name}: {fault}"));
        }
    }
    assert!(
        faults.is_empty(),
        "{} of {} cases:\n{}",
        faults.len(),
        CASES.len(),
        faults.join("\n")
    );
}

/// Catches instances that share what they should not (private variables, frozen values), sums and chains that lose or
/// reorder a module, and structs of an interface that lose what another module reads.
#[test]
fn trees() {
    let texts = base()
        .category("chain", r#"group: 2, combine: {"step": Chain, "factor": Product}"#,
            "struct P {\n    a: f32,\n    b: f32,\n    unread: f32,\n}\nconst LIMIT: f32 = 64.0;\nfn step(p: P, x: f32) -> P {\n    return p;\n}\nfn factor(x: f32) -> f32 {\n    return 1.0;\n}\n")
        .module("value", "top", r#"slots: {"steps": (interface: "chain", arity: List)}"#,
            "fn value(x: f32) -> f32 {\n    let P_ = step(P(x, 1.0, 5.0), x);\n    return min(P_.a + P_.b, LIMIT) * factor(2.0);\n}\n")
        .module("chain", "add", r#"params: {"by": (type: F32, default: 1.0, mode: Constant)}"#,
            "var<private> seen: f32;\nfn step(p: P, x: f32) -> P {\n    var q = p;\n    seen += params.by;\n    q.a += seen;\n    q.unread = seen;\n    return q;\n}\nfn factor(x: f32) -> f32 {\n    seen += 1.0;\n    return x;\n}\n")
        .module("chain", "double", "",
            "fn step(p: P, x: f32) -> P {\n    return P(p.a * 2.0, p.b + x, p.unread);\n}\nfn factor(x: f32) -> f32 {\n    return x + 1.0;\n}\n")
        .module("value", "sum", r#"slots: {"all": (interface: "value", arity: List, prefix: "part_")}"#,
            "fn value(x: f32) -> f32 {\n    return part_value(x + 1.0) * 2.0;\n}\n")
        .module("value", "private", r#"params: {"by": (type: F32, default: 1.0, mode: Constant), "on": (type: Bool, default: true, mode: Constant)}"#,
            "var<private> seen: f32;\nfn value(x: f32) -> f32 {\n    seen += x * params.by;\n    if params.on { return seen; }\n    return -seen;\n}\n");
    type Tree = (&'static str, fn(f32) -> f32);
    let trees: &[Tree] = &[
        (r#"(module: "top")"#, |x| x + 1.0),
        (r#"(module: "top", fill: {"steps": ["double"]})"#, |x| (x * 2.0 + 1.0 + x) * 3.0),
        (r#"(module: "top", fill: {"steps": ["add", "double"]})"#, |x| {
            ((x + 1.0) * 2.0 + 1.0 + x) * 6.0
        }),
        (r#"(module: "top", fill: {"steps": ["double", "add"]})"#, |x| {
            (x * 2.0 + 1.0 + 1.0 + x) * 6.0
        }),
        (
            r#"(module: "top", fill: {"steps": ["add", "double", "add", (module: "add", freeze: {"by": 4}), "double"]})"#,
            |x| (((x + 1.0) * 2.0 + 2.0 + 4.0) * 2.0 + 1.0 + x + x).min(64.0) * 72.0,
        ),
        (r#"(module: "sum")"#, |x| (x + 1.0) * 2.0),
        (r#"(module: "sum", fill: {"all": ["private"]})"#, |x| (x + 1.0) * 2.0),
        (r#"(module: "sum", fill: {"all": ["private", "private"]})"#, |x| (x + 1.0) * 6.0),
        (
            r#"(module: "sum", fill: {"all": ["private", (module: "private", label: "own"), (module: "private", freeze: {"by": 4, "on": false})]})"#,
            |x| (x + 1.0) * -4.0,
        ),
        (
            r#"(module: "sum", fill: {"all": [(module: "sum", fill: {"all": ["private", "sum"]}), (module: "sum", fill: {"all": ["private"]})]})"#,
            |x| ((x + 2.0 + (x + 3.0) * 2.0) * 2.0 + (x + 2.0) * 2.0 * 2.0) * 2.0,
        ),
    ];
    let faults: Vec<String> = trees
        .iter()
        .filter_map(|(recipe, expected)| Some(format!("== {recipe}: {}", texts.fault(recipe, expected)?)))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
