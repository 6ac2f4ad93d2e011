//! Tests of the module around.

use proptest::prelude::*;

use super::*;
use crate::manifest::{Filling, Value, check_category, check_module};

fn module(text: &str) -> String {
    parse_module("module.ron", text).map_or_else(|report| report.render(), |_| "accepted".to_owned())
}

/// Catches a syntax error without its place, or taken for an error of shape.
#[test]
fn not_ron() {
    let expected = "\
error[SW0101]: this is not RON
  --> module.ron:3:3
  |
3 |   source: [],
  |   ^^^^^^ expected comma
";
    assert_eq!(module("(\n  summary: \"x\"\n  source: [],\n)"), expected);
    let expected = "\
error[SW0101]: this is not RON
  --> module.ron:4:1
  |
3 |   source: [
  |           - never closed
4 | 
  | ^ unexpected end of RON
";
    assert_eq!(module("(\n  summary: \"x\",\n  source: [\n"), expected);
    let expected = "\
error[SW0101]: this is not RON
  --> module.ron:1:16
  |
1 | (summary: \"x\") trailing
  |                ^^^^^^^^ non-whitespace trailing characters
";
    assert_eq!(module("(summary: \"x\") trailing"), expected);
}

/// Catches unknown fields that pass silently, also inside variants, or a suggestion that is not there.
#[test]
fn unknown_field() {
    let expected = "\
error[SW0102]: there is no field `interfase` in `slots.ndf`
  --> module.ron:3:19
  |
3 |   slots: {\"ndf\": (interfase: \"ndf\")},
  |                   ^^^^^^^^^ unknown field
  |
  = did you mean `interface`?
  = fields: interface, arity, default, prefix, doc, represents
";
    assert_eq!(
        module("(\n  summary: \"x\",\n  slots: {\"ndf\": (interfase: \"ndf\")},\n)"),
        expected
    );
    for inner in [
        "slots: {\"a\": (interface: \"b\", default: (module: \"c\", fil: {}))}",
        "passes: {\"p\": Draw(root: \"d\", vew: Cube, resolution: \"r\")}",
        "resources: {\"t\": (kind: Texture(sgrb: true))}",
        "rules: [Requires(tag: \"a\", amog: Tree, because: \"b\")]",
        "params: {\"a\": (type: F32, default: 1, rang: (0, 1))}",
        "summry: \"y\"",
    ] {
        let text = module(&format!("(summary: \"x\", {inner})"));
        assert!(
            text.starts_with("error[SW0102]") && text.contains("did you mean"),
            "{inner}: {text}"
        );
    }
}

/// Catches a wrong or missing value without its place and path.
#[test]
fn wrong_shape() {
    let expected = "\
error[SW0103]: a value of another shape is needed for `summary`
  --> module.ron:2:12
  |
2 |   summary: 3,
  |            ^ expected string
";
    assert_eq!(module("(\n  summary: 3,\n)"), expected);
    let expected = "\
error[SW0103]: the field `interface` is missing in `slots.ndf`
  --> module.ron:3:32
  |
3 |   slots: {\"ndf\": (arity: Single)},
  |                                ^ ends without `interface`
";
    assert_eq!(module("(\n  summary: \"x\",\n  slots: {\"ndf\": (arity: Single)},\n)"), expected);
    let expected = "\
error[SW0103]: a value of another shape is needed for `slots.é.default`
  --> module.ron:1:57
  |
1 | (summary: \"é\", slots: {\"é\": (interface: \"ndf\", default: ggx)})
  |                                                         ^^^ expected a module's name, (module: \"name\", ...), or a list of these but found a unit value instead
  |
  = names and quantities are written in quotes
";
    assert_eq!(
        module("(summary: \"é\", slots: {\"é\": (interface: \"ndf\", default: ggx)})"),
        expected
    );
}

/// Catches a variant's name that is refused without saying which there are.
#[test]
fn unknown_variant() {
    let expected = "\
error[SW0104]: `Sngle` is no choice for `slots.ndf.arity`
  --> module.ron:3:44
  |
3 |   slots: {\"ndf\": (interface: \"ndf\", arity: Sngle)},
  |                                            ^^^^^ unknown word
  |
  = did you mean `Single`?
  = choices: Single, Optional, List
";
    assert_eq!(
        module("(\n  summary: \"x\",\n  slots: {\"ndf\": (interface: \"ndf\", arity: Sngle)},\n)"),
        expected
    );
}

/// Catches a second equal key that silently replaces the first, in structs and in maps.
#[test]
fn duplicate_key() {
    let expected = "\
error[SW0105]: `a` stands twice
  --> module.ron:4:5
  |
3 |     \"a\": (type: F32, default: 1),
  |     --- the first time
4 |     \"a\": (type: F32, default: 2),
  |     ^^^ the second time
  |
  = remove one of them
";
    let text = "(summary: \"x\", params:\n{\n    \"a\": (type: F32, default: 1),\n    \"a\": (type: F32, default: 2),\n})";
    assert_eq!(module(text), expected);
    assert!(module("(summary: \"x\", summary: \"y\")").starts_with("error[SW0105]: `summary` stands twice"));
}

/// Catches limits that are declared but not applied, and a stack that does not bear what they allow.
#[test]
fn limits_apply() {
    let nested = |levels: usize| format!("{}\"x\"{}", "(module: \"m\", fill: {\"s\": ".repeat(levels), "})".repeat(levels));
    assert!(parse_recipe("r", &nested(32)).is_ok());
    let expected = "error[SW0702]: brackets are nested too deep\n";
    let deep = parse_recipe("r", &nested(33)).unwrap_err().render();
    assert!(
        deep.starts_with(expected) && deep.contains("level 65") && deep.contains("at most 64 levels are taken"),
        "{deep}"
    );
    assert!(
        parse_recipe("r", &"(".repeat(limits::FILE_SIZE))
            .unwrap_err()
            .render()
            .starts_with(expected)
    );
    let list = |length: usize| format!("(module: \"m\", fill: {{\"s\": [{}]}})", "\"x\",".repeat(length));
    assert!(parse_recipe("r", &list(1024)).is_ok());
    assert!(
        parse_recipe("r", &list(1025))
            .unwrap_err()
            .render()
            .starts_with("error[SW0706]: a list is too long\n")
    );
    let large = format!("(summary: \"{}\")", "x".repeat(limits::FILE_SIZE));
    assert_eq!(
        module(&large),
        "error[SW0701]: `module.ron` is too large: 1048589 bytes\n = at most 1048576 bytes are read\n"
    );
}

/// Catches a form of recipe that is not taken, or is read as something else.
#[test]
fn forms_of_a_recipe() {
    for text in ["ggx", " ggx\n", "\"ggx\"", "(module: \"ggx\")", "Node(module: \"ggx\",) // end"] {
        assert_eq!(parse_recipe("r", text).unwrap().value, Node::new("ggx"), "{text}");
    }
    assert_eq!(
        parse_recipe("r", "filtering/cube-map").unwrap().value,
        Node::new("filtering/cube-map")
    );
    let text = "(module: \"m\", label: \"coat\",
            fill: {\"one\": \"a\", \"some\": [\"b\", (module: \"c\")], \"none\": []},
            freeze: {\"f\": 0.1, \"i\": 3, \"n\": -2, \"b\": true, \"t\": \"800 lm\", \"v\": (0, 0.5, 1e-3), \"w\": [1.0, 2.0]})";
    let node = parse_recipe("r", text).unwrap().value;
    assert_eq!(node.label.as_deref(), Some("coat"));
    assert_eq!(node.fill["one"], Filling::One(Node::new("a")));
    assert_eq!(node.fill["some"], Filling::Many(vec![Node::new("b"), Node::new("c")]));
    assert_eq!(node.fill["none"], Filling::Many(vec![]));
    let expected = [
        Value::Number(0.1),
        Value::Number(3.0),
        Value::Number(-2.0),
        Value::Bool(true),
        Value::Text("800 lm".to_owned()),
        Value::List(vec![0.0, 0.5, 1e-3]),
        Value::List(vec![1.0, 2.0]),
    ];
    assert!(node.freeze.values().eq(expected.iter()), "{:?}", node.freeze);
    for text in ["", "3", "a b", "a/b/c", "[\"a\"]", "-a", "()"] {
        assert!(parse_recipe("r", text).is_err(), "{text}");
    }
}

/// Catches optional fields that need an explicit `Some`, and variants that are not read.
#[test]
fn a_full_manifest() {
    let parsed = parse_module(
        "module.ron",
        r#"(
                summary: "s", source: ["a"], uses: ["math"], capabilities: [], properties: ["isotropic"], represents: ["gltf:x"],
                slots: {
                    "ndf": (interface: "ndf", default: "ggx"),
                    "lights": (interface: "light", arity: List, default: ["point", (module: "spot", freeze: {"a": 1})]),
                    "coat": (interface: "brdf", arity: Optional, prefix: "coat_", default: Some("c"), represents: {"gltf:c": "c"}),
                },
                params: {"flux": (type: F32, unit: "lm", also: {"klm": 1000}, default: "800 lm", range: (0, 1e6), mode: Override, role: "r")},
                resources: {
                    "a": (kind: Host("frame"), group: 0), "b": (kind: Texture(srgb: true)), "c": (kind: Texture()),
                    "d": (kind: Sampler(linear: true)), "e": (kind: Depth(pass: "p")), "f": (kind: Buffer(bytes: 16)),
                },
                rules: [Requires(tag: "t", among: Children, because: "b"), Excludes(tag: "t", among: Tree, because: "b")],
                passes: {
                    "p": Draw(root: (module: "depth", fill: {}), inherit: ["geometry"], view: Cube, resolution: "r"),
                    "q": Compute(entry: "main", over: Once),
                },
            )"#,
    );
    let manifest = parsed.map_err(|report| report.render()).unwrap().value;
    assert_eq!(manifest.slots["ndf"].default, Some(Filling::One(Node::new("ggx"))));
    assert_eq!(manifest.params["flux"].range, Some((0.0, 1e6)));
    assert_eq!(manifest.resources["a"].group, Some(0));
}

/// Catches a manifest of the repository that no longer loads, or says something that cannot be.
#[test]
fn the_repository_s_manifests() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../modules");
    let folders = |path: &std::path::Path| {
        let entries = std::fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
        entries.filter(|path| path.is_dir()).collect::<Vec<_>>()
    };
    let (mut categories, mut modules, mut errors) = (0, 0, String::new());
    for category in folders(&folder) {
        let path = category.join("category.ron");
        let Ok(text) = std::fs::read_to_string(&path) else { continue };
        let checked = parse_category(&path.display().to_string(), &text).and_then(|parsed| check_category(&parsed));
        errors += &checked.map_or_else(|report| report.render(), |()| String::new());
        categories += 1;
        for module in folders(&category) {
            let path = module.join("module.ron");
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            let checked = parse_module(&path.display().to_string(), &text).and_then(|parsed| check_module(&parsed));
            errors += &checked.map_or_else(|report| report.render(), |()| String::new());
            modules += 1;
        }
    }
    assert!(errors.is_empty(), "{errors}");
    assert!(categories > 10 && modules > 10, "{categories} {modules}");
}

fn nodes() -> impl Strategy<Value = Node> {
    let value = prop_oneof![
        any::<bool>().prop_map(Value::Bool),
        any::<f64>().prop_filter("finite", |n| n.is_finite()).prop_map(Value::Number),
        "\\PC{0,6}".prop_map(Value::Text),
        proptest::collection::vec(-1e9..1e9f64, 0..4).prop_map(Value::List),
    ];
    let leaf = (
        "[a-z-]{1,6}",
        proptest::option::of("[a-z]{1,3}"),
        proptest::collection::vec(("[a-z]{1,2}", value), 0..3),
    );
    let leaf = leaf.prop_map(|(module, label, freeze)| Node {
        label,
        freeze: freeze.into_iter().collect(),
        ..Node::new(module)
    });
    leaf.prop_recursive(4, 16, 3, |inner| {
        let filling = prop_oneof![
            inner.clone().prop_map(Filling::One),
            proptest::collection::vec(inner.clone(), 0..3).prop_map(Filling::Many),
        ];
        (inner, proptest::collection::vec(("[a-z]{1,2}", filling), 0..3)).prop_map(|(node, fill)| Node {
            fill: fill.into_iter().collect(),
            ..node
        })
    })
}

const VALID: &str = r##"(summary: "s", // c
  slots: {"é": (interface: "a", arity: List, default: ["b", (module: "c", freeze: {"d": (1.0, 2, -3e4)})])},
  params: {"x": (type: Vec3, default: "1 lm", range: (0, 1))}, resources: {"t": (kind: Sampler(linear: true))},
  passes: {"p": Draw(root: "d", view: Cube, resolution: "r")}, rules: [Requires(tag: "t", among: Tree, because: r#"b"#)])"##;

/// Catches a near-miss test whose starting point is no hit.
#[test]
fn the_valid_text_is_valid() {
    assert_eq!(module(VALID), "accepted");
}

proptest! {
    /// Catches a recipe that is read otherwise than it was written.
    #[test]
    fn recipes_round_trip(node in nodes()) {
        let text = ron::to_string(&node).unwrap();
        prop_assert_eq!(parse_recipe("r", &text).map(|parsed| parsed.value), Ok(node));
    }

    /// Catches text that makes the loader or its errors panic.
    #[test]
    fn any_text_is_judged(text in "\\PC{0,80}") {
        module(&text);
        let _ = parse_recipe("r", &text).map_err(|report| (report.render(), report.to_json()));
    }

    /// The same, near valid text: bytes cut out, doubled, or replaced by what means something.
    #[test]
    fn any_near_miss_is_judged(at in 0..VALID.len(), length in 0..12usize, put in "[(){}\\[\\],:\"'/*#r\\\\ a1.é-]{0,3}") {
        let (at, end) = (VALID.floor_char_boundary(at), VALID.floor_char_boundary((at + length).min(VALID.len())));
        let text = format!("{}{put}{}", &VALID[..at], &VALID[end.max(at)..]);
        let judged = parse_module("m", &text).and_then(|parsed| check_module(&parsed));
        if let Err(report) = judged {
            prop_assert!(report.render().starts_with("error[SW01"));
            for label in &report.diagnostics[0].labels {
                prop_assert!(text.get(label.span.clone()).is_some(), "{:?} in {}", label, text);
            }
        }
    }
}
