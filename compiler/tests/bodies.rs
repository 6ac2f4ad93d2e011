//! Bodies that are hard on whoever cuts dead text: for each, the source form means what the IR form means.

mod common;

use common::small;
use shadewright_compiler::canonical::canonical_hash;

const NONE: &str = "";
const NO: &str = r#"params: {"flag": (type: Bool, default: false, mode: Constant), "n": (type: U32, default: 3, mode: Constant)}"#;
const YES: &str = r#"params: {"flag": (type: Bool, default: true, mode: Constant), "n": (type: U32, default: 3, mode: Constant)}"#;

/// What the bodies call: functions that act and functions that don't, some with names that begin like the language's own.
const HELPERS: &str = "struct S {
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
alias Alias = S;
const WHOLE = S(1.0, 2.0, vec2f(3.0));
const LISTED = array<T, 2>(T(1.0, 2.0), T(3.0, 4.0));
const DERIVED = WHOLE.b * 2.0;
var<private> started: S = S(1.0, 2.0, vec2f(3.0));
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
alias Again = Alias;
alias Two = array<S, 2>;
struct Deep {
    one: Nest,
    two: f32,
}
fn rayleigh(x: f32) -> f32 {
    return x * 11.0;
}
fn quadratic(x: f32) -> f32 {
    return x * x;
}
fn atomic_mass(x: f32) -> f32 {
    return x * 13.0;
}
fn only_dead(x: f32) -> f32 {
    return other(x) + rayleigh(x);
}
fn take(s: S) -> f32 {
    return s.a;
}
fn setp(p: ptr<function, f32>, x: f32) -> f32 {
    *p = x;
    return x;
}
fn early(x: f32) -> f32 {
    if x > 2.0 {
        return 1.0;
    }
    return 2.0;
}
";

/// What is hard, the manifest, and the body of `value(x)`.
const CASES: &[(&str, &str, &str)] = &[
    (
        "typed second name",
        NONE,
        "{ let k = other(x); let a: f32 = k; } let a = x * 2.0; return a;",
    ),
    (
        "identity cast second name",
        NONE,
        "{ let k = other(x); let a = f32(k); } let a = x * 2.0; return a;",
    ),
    (
        "identity vec cast",
        NONE,
        "{ let k = vec2f(other(x)); let a = vec2f(k); } let a = x * 2.0; return a;",
    ),
    (
        "deref of address",
        NONE,
        "var s: S; s.a = x; { let p = &s.b; let q = &*p; *q = 3.0; } let q = x * 2.0; return q + s.a;",
    ),
    ("rayleigh unread", NONE, "let k = rayleigh(x); return x;"),
    ("rayleigh phony", NONE, "_ = rayleigh(x); return x;"),
    ("quadratic unread", NONE, "let k = quadratic(x); return x;"),
    (
        "atomic_mass dead arg",
        NONE,
        "let k = atomic_mass(x); let s = S(x, k, vec2f(k)); return s.a;",
    ),
    ("comment with and", NONE, "let k = other(x) /* a && b */; return x;"),
    ("comment with and inside", NONE, "let k = other(x /* a && b */); return x;"),
    ("comment with and in phony", NONE, "_ = other(x) // a || b\n; return x;"),
    (
        "comment with and in arg",
        NONE,
        "let s = S(x, other(x /* && */), vec2f(1.0)); return s.a;",
    ),
    (
        "comment with and beside arg",
        NONE,
        "let s = S(x, other(x) /* && */, vec2f(1.0)); return s.a;",
    ),
    (
        "comment with and in dead store",
        NONE,
        "var s: S; s.b = other(x) /* && */; s.a = x; return s.a;",
    ),
    (
        "block that leaves by constant",
        YES,
        "var y = x; { if params.flag { return y; } } y = other(y); return y;",
    ),
    ("block that leaves", NONE, "var y = x; { return y; } y = other(y); return y;"),
    ("return then code", NONE, "var y = x; return y; y = other(y); return y;"),
    (
        "both sides leave",
        NONE,
        "var y = x; if x > 1.0 { return y; } else { return 2.0; } y = other(y); return y;",
    ),
    (
        "const both consts leave",
        YES,
        "var y = x; if !params.flag { y = 1.0; } else if params.flag { return y; } y = other(y); return y;",
    ),
    (
        "nested blocks leave",
        YES,
        "var y = x; { { if params.flag { return y; } y = pure(y); } y = act(y); } y = other(y); return y;",
    ),
    (
        "break then code",
        NONE,
        "var y = x; loop { y += 1.0; break; y = other(y); } return y;",
    ),
    (
        "loop break const in block",
        YES,
        "var y = x; loop { y += 1.0; { if params.flag { break; } } y = other(y); continuing { y += pure(1.0); } } return y;",
    ),
    (
        "loop continue const in block",
        YES,
        "var y = x; loop { y += 1.0; if y > 5.0 { break; } { if params.flag { continue; } } y = other(y); continuing { y += pure(1.0); } } return y;",
    ),
    (
        "switch case leaves const",
        YES,
        "var y = x; switch u32(x) { case 1u: { if params.flag { break; } y = other(y); } case 2u, default: { y += 1.0; } } return y;",
    ),
    (
        "switch in loop with continuing",
        YES,
        "var y = x; loop { switch u32(y) { case 1u { y += 1.0; continue; } case 2u { if params.flag { continue; } y = other(y); } default { y += 2.0; } } if y > 6.0 { break; } continuing { y += 0.5; let k = pure(y); break if y > 9.0; } } return y;",
    ),
    ("const alias struct", NONE, "const k = Alias(1.0, 2.0, vec2f(3.0)); return x + k.b;"),
    (
        "const alias of alias",
        NONE,
        "const k = Again(1.0, 2.0, vec2f(3.0)); return x + k.b;",
    ),
    (
        "module constant of a struct",
        NONE,
        "var s = S(x, x, vec2f(x)); s.b = 4.0; return s.a + WHOLE.c.x;",
    ),
    (
        "module constants in a chain",
        NONE,
        "var s = S(x, x, vec2f(x)); s.b = 4.0; return s.a + DERIVED;",
    ),
    (
        "module constant of an array of structs",
        NONE,
        "var t = T(x, x); t.a = 1.0; return t.b + LISTED[u32(x)].b;",
    ),
    (
        "private variable with a struct for a start",
        NONE,
        "var s = S(x, x, vec2f(x)); s.b = 4.0; started.c.y = s.a; return s.c.x + started.c.x;",
    ),
    (
        "module constant behind a branch that is never taken",
        NO,
        "var s = S(x, x, vec2f(x)); s.b = 4.0; if params.flag { s.a = WHOLE.b; } return s.a;",
    ),
    (
        "const assert struct",
        NONE,
        "const_assert S(1.0, 2.0, vec2f(3.0)).b > 1.0; return x;",
    ),
    (
        "deep chain dead middle",
        NONE,
        "var d: Deep; d.one.unread = other(x); d.two = x; return d.two;",
    ),
    (
        "deep chain dead middle2",
        NONE,
        "var d: Deep; d.one.one = make(x); d.one.inner[next()].b = other(x); d.two = x; return d.two + count;",
    ),
    (
        "deep chain ctor",
        NONE,
        "let d = Deep(Nest(array<S, 2>(S(x, 1.0, vec2f(x)), make(x)), S(other(x), x, vec2f(2.0)), act(x)), pure(x)); return d.two;",
    ),
    (
        "deep chain ctor read mid",
        NONE,
        "let d = Deep(Nest(array<S, 2>(S(x, 1.0, vec2f(x)), make(x)), S(other(x), x, vec2f(2.0)), pure(x)), pure(x)); return d.one.one.b;",
    ),
    (
        "nested ctor all pure",
        NONE,
        "let d = Deep(Nest(Two(S(x, 1.0, vec2f(x)), S(x, pure(x), vec2f(x))), S(other(x), x, vec2f(2.0)), pure(x)), pure(x),); return d.one.inner[1].b;",
    ),
    (
        "ctor comments",
        NONE,
        "let s = S(/* a, b */ x, // one, two\n other(x) /* ) */, vec2f(x) /* , */,); return s.a;",
    ),
    ("ctor first dead", NONE, "let s = S(other(x), x, vec2f(x)); return s.b;"),
    ("ctor last only", NONE, "let s = S(other(x), pure(x), vec2f(x),); return s.c.y;"),
    (
        "lets in nested blocks",
        NONE,
        "let a = x; { let a = other(a); { let a = pure(a); { let a = a + 1.0; } } } return a;",
    ),
    (
        "lets in nested blocks used",
        NONE,
        "var y = 0.0; let a = x; { let a = other(a); { let a = pure(a); y += a; { let a = a + 1.0; } } } return a + y;",
    ),
    (
        "local named as function",
        NONE,
        "let other = x * 2.0; let pure = other + 1.0; { let act = pure; } return other;",
    ),
    ("local named as struct", NONE, "let S = x * 2.0; var T = S; return T;"),
    (
        "param-like name",
        NONE,
        "let value_ = x; let m = value_ * 2.0; let m_other = other(m); return m;",
    ),
    (
        "local named like linked",
        NONE,
        "let m_pure = pure(x); let m_other = 1.0; return other(m_other) + m_pure;",
    ),
    ("only dead caller", NO, "if params.flag { return only_dead(x); } return x;"),
    (
        "only dead caller let",
        NONE,
        "let k = only_dead(x); let l = k; let m = l + k; return x;",
    ),
    ("phony of let", NONE, "let k = other(x); _ = k; return x;"),
    ("phony of pointer", NONE, "var s: S; s.a = x; let p = &s.b; _ = p; return s.a;"),
    ("phony of struct", NONE, "var s: S; s.a = x; s.b = other(x); _ = s; return s.a;"),
    ("phony ctor", NONE, "_ = S(x, other(x), vec2f(x)); return x;"),
    ("phony ctor act", NONE, "_ = S(x, act(x), vec2f(0.0)).a; return x + count;"),
    (
        "phony in for",
        NONE,
        "var y = x; for (_ = pure(x); y < 5.0; _ = act(y)) { y += 1.0; } return y + count;",
    ),
    (
        "phony pure in for",
        NONE,
        "var y = x; for (_ = pure(x); y < 5.0; _ = other(y)) { y += 1.0; } return y;",
    ),
    (
        "for var struct",
        NONE,
        "var y = x; for (var s = S(x, other(x), vec2f(x)); s.a < 5.0; s.a += 1.0) { y += 1.0; } return y;",
    ),
    (
        "for dead both",
        NONE,
        "var s: S; var y = x; for (s.b = pure(x); y < 5.0; s.b = act(y)) { y += 1.0; } return y + s.a + count;",
    ),
    (
        "for dead both pure",
        NONE,
        "var s: S; var y = x; for (s.b = pure(x); y < 5.0; s.b = other(y)) { y += 1.0; } return y + s.a;",
    ),
    (
        "for no cond",
        NONE,
        "var s: S; var y = x; for (;; s.b += 1.0) { y += 1.0; if y > 5.0 { break; } } return y + s.a;",
    ),
    ("if with only pure", NONE, "if x > 1.0 { pure(x); } else { other(x); } return x;"),
    (
        "if with only dead store",
        NONE,
        "var s: S; if x > 1.0 { s.b = other(x); } else if x > 2.0 { s.b = 1.0; } s.a = x; return s.a;",
    ),
    (
        "switch only pure",
        NONE,
        "switch u32(x) { case 1u { pure(x); } default { let k = other(x); } } return x;",
    ),
    (
        "continuing only pure",
        NONE,
        "var y = x; loop { y += 1.0; continuing { pure(y); let k = other(y); break if y > 5.0; } } return y;",
    ),
    (
        "setp dead member",
        NONE,
        "var s: S; s.a = x; let r = setp(&s.b, other(x)); return s.a;",
    ),
    (
        "pointer chain",
        NONE,
        "var d: Deep; let p = &d.one; let q = &(*p).one; let r = &q.b; *r = other(x); q.a = pure(x); return d.two + x;",
    ),
    (
        "pointer chain read",
        NONE,
        "var d: Deep; let p = &d.one; let q = &(*p).one; let r = &q.b; *r = other(x); q.a = pure(x); return d.one.one.a;",
    ),
    (
        "pointer second name",
        NONE,
        "var s: S; { let p = &s.b; let q = p; *q = other(x); } let q = x; return q + s.a;",
    ),
    (
        "pointer in for",
        NONE,
        "var s: S; let p = &s; for (p.b = x; p.a < 4.0; p.b += 1.0) { p.a += 1.0; } return p.a;",
    ),
    (
        "const condition let later",
        YES,
        "let k = other(x); let l = pure(k); var y = x; if params.flag { y += 1.0; } else { y += l; } return y;",
    ),
    (
        "const let condition",
        YES,
        "let c = params.flag; let k = other(x); if c { return x; } return k;",
    ),
    (
        "const let condition not",
        NO,
        "let c = params.flag; let d = !c; let k = other(x); if d { return x; } return k;",
    ),
    (
        "const local condition",
        NO,
        "const c = params.n > 5u; let k = other(x); if c { return k; } return x;",
    ),
    (
        "const var condition",
        NO,
        "var c = params.flag; let k = other(x); if c { return k; } return x;",
    ),
    ("select const", NO, "return select(x, other(x), params.flag);"),
    (
        "switch const",
        NO,
        "switch params.n { case 3u { return x; } default { return other(x); } }",
    ),
    (
        "else if chain const middle",
        YES,
        "var y = x; if x > 1.0 { y = 1.0; } else if params.flag { y = pure(y); } else if x > 0.7 { y = other(x); } else { y = act(x); } return y;",
    ),
    (
        "else if chain const middle no",
        NO,
        "var y = x; if x > 1.0 { y = 1.0; } else if params.flag { y = pure(y); } else if x > 0.7 { y = other(x); } else { y = act(x); } return y + count;",
    ),
    (
        "else if chain const first no",
        NO,
        "var y = x; if params.flag { y = 1.0; } else if x > 0.7 { y = other(x); } else { y = act(x); } return y + count;",
    ),
    (
        "else if chain const last no",
        NO,
        "var y = x; if x > 1.0 { y = 1.0; }\n// why\nelse if params.flag { y = act(x); } return y + count;",
    ),
    ("if parens", YES, "var y = x; if(params.flag){y=1.0;}else{y=other(x);} return y;"),
    (
        "if true empty",
        YES,
        "var y = x; if params.flag { } else { y = other(x); } return y;",
    ),
    (
        "if false in single line loop",
        NO,
        "var y = x; loop { if params.flag { y = other(y); } if y > 4.0 { break; } y += 1.0; } return y;",
    ),
    (
        "while on literal in function",
        YES,
        "var y = x; while true { if params.flag { break; } y = other(y); } return y;",
    ),
    (
        "empty else break",
        YES,
        "var y = x; loop { if params.flag { } else { break; } y += 1.0; if y > 4.0 { break; } } return y;",
    ),
    (
        "empty then break no",
        NO,
        "var y = x; loop { if params.flag { } else { break; } y = other(y); } return y;",
    ),
    (
        "lowered in const if",
        YES,
        "var t = false; if params.flag { t = x > 1.0 && pure(x) > 2.0; } return select(0.0, 1.0, t);",
    ),
    (
        "lowered let in const if",
        YES,
        "var t = x; if params.flag { let u = x > 1.0 && act(x) > 2.0; } return t + count;",
    ),
    (
        "lowered let in const if no",
        NO,
        "var t = x; if params.flag { let u = x > 1.0 && act(x) > 2.0; } return t + count;",
    ),
    (
        "lowered chain of and",
        NONE,
        "let u = x > 1.0 && act(x) > 2.0 || pure(x) > 1.0 && other(x) < 3.0; return x + count;",
    ),
    (
        "lowered in ctor",
        NONE,
        "let s = Both(x > 1.0 && pure(x) > 2.0, other(x), x < 2.0 || other(x) > 1.0); return s.middle;",
    ),
    (
        "unicode",
        NONE,
        "let größe = x * 2.0; let λ = other(größe); /* ∑ */ let 名 = größe; return 名;",
    ),
    (
        "let chain in calls in args",
        NONE,
        "let a = pure(other(S(x, pure(x), vec2f(act(x))).b)); let b = S(a, a, vec2f(a)); return b.a + count;",
    ),
    (
        "call in ctor in let dead",
        NONE,
        "let a = S(pure(x), act(other(x)), vec2f(rayleigh(x))); return x + count;",
    ),
    ("atomic let", NONE, "let k = atomicLoad(&shared_count); return x;"),
    ("atomic phony", NONE, "_ = atomicAdd(&shared_count, 1u); return x;"),
    (
        "atomic in ctor",
        NONE,
        "let s = S(x, f32(atomicMax(&shared_count, 2u)), vec2f(1.0)); return s.a;",
    ),
    ("uniform load", NONE, "let s = early(x); let k = early(s); return s;"),
    (
        "array len and match",
        NONE,
        "let a = array<f32, 3>(x, other(x), pure(x)); let b = a[1]; return a[0];",
    ),
    (
        "matrix",
        NONE,
        "let m = mat2x2<f32>(x, other(x), pure(x), 1.0); let s = S(m[0][0], m[0][1], m[1]); return s.a;",
    ),
    (
        "comparison gt lt in ctor",
        NONE,
        "let i = 1; let s = Both(i < 2, select(x, other(x), (i > 1)), (i >= 1)); return s.middle;",
    ),
    (
        "shift in ctor",
        NONE,
        "let u = u32(x); let s = S(f32(u >> 1u), f32(u << 2u), vec2f(x)); return s.a;",
    ),
    (
        "bitcast in ctor",
        NONE,
        "let s = S(bitcast<f32>(bitcast<u32>(x)), bitcast<f32>(1u), vec2f(x)); return s.b;",
    ),
    (
        "vec template in ctor",
        NONE,
        "let s = S(vec4<f32>(x, 1.0, 2.0, 3.0).x, dot(vec3<f32>(x), vec3<f32>(1.0, 2.0, 3.0)), vec2<f32>(x, other(x))); return s.a;",
    ),
    ("let no spaces", NONE, "let a=other(x);let b=pure(a);return x;"),
    (
        "let multi line",
        NONE,
        "let a =\n other(\n x\n);\n\n let b = a\n + 1.0;\n return x;",
    ),
    (
        "let typed struct",
        NONE,
        "let s: S = S(x, other(x), vec2f(x)); let t: Alias = s; return t.a;",
    ),
    (
        "let typed array",
        NONE,
        "let s: array<S, 2> = array<S, 2>(S(x, other(x), vec2f(x)), S(x, x, vec2f(x))); return s[1].a;",
    ),
    (
        "let second name member",
        NONE,
        "let s = make(x); let t = s; let u = t; { let s = u.b; } return t.a + count;",
    ),
    (
        "assign struct whole",
        NONE,
        "var s: S; var t: S; t.b = other(x); t.a = x; s = t; return s.a;",
    ),
    (
        "assign struct from ctor dead",
        NONE,
        "var s = S(x, other(x), vec2f(x)); s = S(s.b, pure(x), s.c); return s.a;",
    ),
    (
        "nest in array store",
        NONE,
        "var n: Nest; n.inner = array<S, 2>(S(x, other(x), vec2f(x)), S(x, x, vec2f(x))); n.one = n.inner[next()]; return n.one.b + count;",
    ),
    (
        "swap members",
        NONE,
        "var s: S; s.a = x; s.b = other(x); let t = s.a; s.a = s.b; s.b = t; return s.a;",
    ),
    (
        "self feeding dead",
        NONE,
        "var s: S; for (var i = 0; i < 3; i++) { s.b = s.b + other(x); s.a += 1.0; } return s.a;",
    ),
    (
        "self feeding dead incr",
        NONE,
        "var s: S; s.b += 1.0; s.b += 1.0; s.a = x; return s.a;",
    ),
    ("semicolon statements", NONE, ";;let k = other(x);;; return x;;"),
];

/// Each case catches a form of its own of text that stays where the IR has lost what it stands for, or the other way round.
#[test]
fn bodies_in_both_forms() {
    let mut faults = Vec::new();
    for (name, manifest, body) in CASES {
        let wgsl = format!("{HELPERS}fn value(x: f32) -> f32 {{\n    {body}\n}}\n");
        let library = small().module("value", "m", manifest, &wgsl);
        let program = match library.compile(r#"(module: "run", fill: {"value": "m"})"#) {
            Ok(program) => program,
            Err(report) => {
                faults.push(format!("== {name} does not link: {report}"));
                continue;
            }
        };
        let text = program.wgsl();
        match canonical_hash("source form", text) {
            Ok(hash) if hash == program.hash() => {}
            Ok(_) => faults.push(format!("== {name}: the forms differ:\n{text}")),
            Err(report) => faults.push(format!("== {name}: the source form is no WGSL: {report}\n{text}")),
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
