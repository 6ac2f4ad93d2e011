//! Tests of the module around.

use super::*;

fn names(text: &str, item: &str) -> Vec<String> {
    let scan = scan(text);
    let item = scan.item(item).unwrap();
    item.references
        .iter()
        .map(|r| text[scan.tokens[r.token].range()].to_owned())
        .collect()
}

#[test]
fn locals_shadow_only_after_their_statement_and_inside_their_scope() {
    let text = "fn f(a: f32) -> f32 { let b = b(a); if true { let c = b; } for (var i = i0; i < n; i++) { d(i); } return c.x + i; }";
    let refs: Vec<_> = names(text, "f")
        .into_iter()
        .filter(|n| !matches!(n.as_str(), "f32" | "if" | "true" | "return"))
        .collect();
    assert_eq!(refs, ["b", "i0", "n", "d", "c", "i"]);
}

#[test]
fn attributes_members_and_address_spaces_are_no_references() {
    let text = "struct S { @builtin(position) position: vec4f, @location(L) uv: T }\nvar<storage, read> s: array<S>;";
    assert_eq!(names(text, "S"), ["vec4f", "L", "T"]);
    assert_eq!(names(text, "s"), ["array", "S"]);
}

#[test]
fn items_know_their_doc_lines_fields_and_bodies() {
    let text = "const A = 1;\n/// one\n/// two\n@must_use fn g(x: array<f32, 3>, y: f32) -> @location(0) vec4f { return h(); }";
    let scan = scan(text);
    let g = scan.item("g").unwrap();
    assert_eq!(&text[g.doc_start..g.doc_start + 7], "/// one");
    assert_eq!(
        g.fields.iter().map(|f| &text[scan.bytes(&f.ty)]).collect::<Vec<_>>(),
        ["array<f32, 3>", "f32"]
    );
    assert_eq!(&text[scan.bytes(&g.result)], "@location(0) vec4f");
    assert!(!scan.item("A").unwrap().typed);
}

#[test]
fn broken_text_never_panics() {
    let text = "@fn struct S { a: , @x( b } fn f( { } } ) var< x; const; let @ . fn g() -> { for ( ; { .";
    for end in 0..text.len() {
        scan(&text[..end]);
        scan(&text[end..]);
    }
}
