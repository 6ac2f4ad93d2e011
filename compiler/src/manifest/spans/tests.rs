//! Tests of the module around.

use proptest::prelude::*;

use super::Step::{Index, Key};
use super::*;

const TEXT: &str = r##"#![enable(implicit_some)]
/* a /* nested */ comment: ( */
Manifest(
    summary: "brackets ) ] \" and // no comment", // fill: {"x": 1}
    raw: r#"a " ) b"#,
    fill: {"ndf": (module: "ggx"), "lights": ["a", ("b/c", 1.5e-3), Some((module: "d"))]},
    default: Some("x"),
    r#type: F32,
    pass: Draw(root: (module: "depth"), view: Cube,),
    host: Host("frame"), letter: '(', quote: ''', range: (-1.0, 2),
    empty: [], unit: (),
)
"##;

fn found(path: &[Step]) -> Option<&'static str> {
    Locator::new(TEXT).find(path).map(|span| &TEXT[span])
}

/// Catches values lost behind comments, strings, escapes, variants or attributes, and spans that are off.
#[test]
fn finds_values() {
    assert_eq!(found(&[Key("summary")]), Some(r#""brackets ) ] \" and // no comment""#));
    assert_eq!(found(&[Key("raw")]), Some(r##"r#"a " ) b"#"##));
    assert_eq!(found(&[Key("fill"), Key("ndf"), Key("module")]), Some("\"ggx\""));
    assert_eq!(found(&[Key("fill"), Key("ndf")]), Some("(module: \"ggx\")"));
    assert_eq!(found(&[Key("fill"), Key("lights"), Index(1), Index(1)]), Some("1.5e-3"));
    assert_eq!(found(&[Key("fill"), Key("lights"), Index(2), Key("module")]), Some("\"d\""));
    assert_eq!(found(&[Key("default")]), Some("\"x\""));
    assert_eq!(found(&[Key("type")]), Some("F32"));
    assert_eq!(found(&[Key("pass"), Key("root"), Key("module")]), Some("\"depth\""));
    assert_eq!(found(&[Key("pass")]), Some("Draw(root: (module: \"depth\"), view: Cube,)"));
    assert_eq!(found(&[Key("host"), Index(0)]), Some("\"frame\""));
    assert_eq!(found(&[Key("letter")]), Some("'('"));
    assert_eq!(found(&[Key("quote")]), Some("'''"));
    assert_eq!(found(&[Key("range"), Index(0)]), Some("-1.0"));
    assert_eq!(found(&[Key("empty")]), Some("[]"));
    assert_eq!(found(&[Key("unit")]), Some("()"));
    assert_eq!(found(&[Key("nothing")]), None);
    assert_eq!(found(&[Key("range"), Index(2)]), None);
    assert_eq!(found(&[Key("fill"), Index(0)]), None);
    assert!(found(&[]).is_some_and(|all| all.starts_with("Manifest(") && all.ends_with(')')));
}

/// Catches keys taken for values, and a near miss that points at nothing.
#[test]
fn finds_keys_and_parents() {
    let locator = Locator::new(TEXT);
    let key = |path: &[Step]| locator.find_key(path).map(|span| &TEXT[span]);
    assert_eq!(key(&[Key("fill"), Key("ndf")]), Some("\"ndf\""));
    assert_eq!(key(&[Key("type")]), Some("r#type"));
    assert_eq!(key(&[Key("fill"), Key("lights"), Index(0)]), None);
    assert_eq!(
        &TEXT[locator.find_near(&[Key("fill"), Key("ndf"), Key("fill"), Key("x")])],
        "(module: \"ggx\")"
    );
    assert_eq!(locator.path_at(TEXT.find("1.5e-3").unwrap()), "fill.lights[1][1]");
    assert_eq!(locator.path_at(TEXT.find("Cube").unwrap()), "pass.view");
    assert_eq!(Locator::new("").find_near(&[Key("a")]), 0..0);
}

/// Catches a name alone that is torn apart at its slash.
#[test]
fn a_name_alone() {
    assert_eq!(Locator::new(" brdf/cube-map // c").find(&[]), Some(1..14));
}

/// Catches maps in which a second, equal key silently wins.
#[test]
fn finds_duplicates() {
    let text = r#"(a: {"x": 1, "y": 2, "x": 3}, a: 1, b: [(c: 1), (c: 2)])"#;
    let locator = Locator::new(text);
    let names: Vec<_> = locator
        .duplicates()
        .into_iter()
        .map(|(name, first, second)| (name, first.start, second.start))
        .collect();
    assert_eq!(names, [("x", 5, 21), ("a", 1, 30)]);
    assert_eq!(locator.find(&[Key("a")]).map(|span| &text[span]), Some("1"));
}

proptest! {
    /// Catches text without end or balance that makes the scanner panic, loop, or cut a character in two.
    #[test]
    fn any_text_is_scanned(text in "([(){}\\[\\],:\"'/*#r\\\\]|b|br|é|\u{2028}|\n| |Some\\(|//|a){0,120}") {
        let locator = Locator::new(&text);
        for value in &locator.values {
            prop_assert!(text.get(value.span.clone()).is_some());
        }
        locator.duplicates();
        for byte in 0..text.len() {
            locator.path_at(byte);
        }
    }

    /// Catches anything that the scanner reads otherwise than ron does.
    #[test]
    fn agrees_with_ron(value in arbitrary()) {
        let text = ron::ser::to_string_pretty(&value, ron::ser::PrettyConfig::new()).unwrap();
        let locator = Locator::new(&text);
        prop_assert_eq!(locator.find(&[]), Some(0..text.len()));
        compare(&locator, &text, &value, &mut Vec::new())?;
    }
}

#[derive(Clone, Debug, serde::Serialize)]
#[serde(untagged)]
enum Tree {
    Number(f64),
    Text(String),
    List(Vec<Tree>),
    Map(indexmap::IndexMap<String, Tree>),
}

fn arbitrary() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        any::<i32>().prop_map(|n| Tree::Number(f64::from(n) / 8.0)),
        "\\PC{0,8}".prop_map(Tree::Text)
    ];
    leaf.prop_recursive(4, 24, 4, |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..4).prop_map(Tree::List),
            proptest::collection::vec(("[a-z\"\\\\é(]{1,4}", inner), 0..4).prop_map(|pairs| Tree::Map(pairs.into_iter().collect())),
        ]
    })
}

fn compare<'a>(locator: &Locator, text: &str, value: &'a Tree, path: &mut Vec<Step<'a>>) -> Result<(), TestCaseError> {
    let Some(span) = locator.find(path) else {
        return Err(TestCaseError::fail(format!("{path:?} in {text}")));
    };
    let written = &text[span];
    match value {
        Tree::Number(number) => prop_assert_eq!(ron::from_str::<f64>(written), Ok(*number)),
        Tree::Text(string) => prop_assert_eq!(ron::from_str::<String>(written), Ok(string.clone())),
        Tree::List(items) => {
            for (index, item) in items.iter().enumerate() {
                path.push(Index(index));
                compare(locator, text, item, path)?;
                path.pop();
            }
        }
        Tree::Map(entries) => {
            for (key, item) in entries {
                path.push(Key(key));
                compare(locator, text, item, path)?;
                path.pop();
            }
        }
    }
    Ok(())
}
