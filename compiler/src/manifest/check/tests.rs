//! Tests of the module around.

use super::*;
use crate::manifest::{parse_category, parse_module};

fn module(inner: &str) -> String {
    let parsed = parse_module("module.ron", &format!("(summary: \"s\",\n{inner})")).unwrap_or_else(|report| panic!("{report}"));
    check_module(&parsed).map_or_else(|report| report.render(), |()| String::new())
}

/// Catches a check that refuses what is right.
#[test]
fn nothing_wrong() {
    let text = r#"
            slots: {"ndf": (interface: "ndf"), "base": (interface: "brdf"), "coat": (interface: "brdf", prefix: "coat_")},
            params: {
                "alpha": (type: F32, default: 0.5, range: (0, 1)), "n": (type: U32, default: 3, mode: Override),
                "on": (type: Bool, default: true, mode: Constant), "tint": (type: Color, default: "2700 K"),
                "flux": (type: F32, unit: "lm", also: {"klm": 1000}, default: "1 klm"), "size": (type: U32, default: 512),
            },
            instances: {"position": (type: Vec3, unit: "m", default: (0, 0, 0))},
            resources: {"depth": (kind: Depth(pass: "shadow")), "views": (kind: Views(pass: "shadow"), group: 1)},
            capabilities: ["SHADER_FLOAT16"],
            passes: {"shadow": Draw(root: "depth", view: Cube, resolution: "size"), "sum": Compute(entry: "reduce", over: Frame)}"#;
    assert_eq!(module(text), "");
}

/// Catches names that WGSL would refuse only after linking, far from here.
#[test]
fn names() {
    let expected = "\
error[SW0106]: `loop` cannot be a name here
  --> module.ron:2:10
  |
2 | params: {\"loop\": (type: F32, default: 1)})
  |          ^^^^^^ a word that WGSL reserves
  |
  = ASCII letters, digits and underscores, not a digit or two underscores first
";
    assert_eq!(module("params: {\"loop\": (type: F32, default: 1)}"), expected);
    for inner in [
        "params: {\"a-b\": (type: F32, default: 1)}",
        "instances: {\"1a\": (type: F32, default: 1)}",
        "slots: {\"_\": (interface: \"a\")}",
        "slots: {\"a\": (interface: \"a\", prefix: \"coat-\")}",
        "resources: {\"__a\": (kind: Texture())}",
        "passes: {\"é\": Compute(entry: \"a\", over: Once)}",
        "passes: {\"p\": Compute(entry: \"\", over: Once)}",
    ] {
        assert!(module(inner).starts_with("error[SW0106]"), "{inner}");
    }
}

/// Catches a default that no recipe could write.
#[test]
fn defaults() {
    let expected = "\
error[SW0107]: the default of `alpha` does not fit
  --> module.ron:2:40
  |
2 | params: {\"alpha\": (type: F32, default: 2, range: (0, 1))})
  |                                        ^ 2 is outside 0 to 1
";
    assert_eq!(module("params: {\"alpha\": (type: F32, default: 2, range: (0, 1))}"), expected);
    for inner in [
        "params: {\"a\": (type: Vec3, default: (0, 0))}",
        "params: {\"a\": (type: U32, default: 0.5)}",
        "params: {\"a\": (type: F32, default: inf)}",
        "instances: {\"a\": (type: F32, unit: \"m\", default: \"1 ft\")}",
    ] {
        assert!(module(inner).starts_with("error[SW0107]"), "{inner}");
    }
}

/// Catches a range that nothing can be in.
#[test]
fn ranges() {
    let expected = "\
error[SW0108]: the range of `a` is empty
  --> module.ron:2:46
  |
2 | params: {\"a\": (type: F32, default: 1, range: (1, 1))})
  |                                              ^^^^^^ the first number must be below the second
";
    assert_eq!(module("params: {\"a\": (type: F32, default: 1, range: (1, 1))}"), expected);
    assert!(module("params: {\"a\": (type: F32, default: 1, range: (NaN, 1))}").starts_with("error[SW0108]"));
    assert!(module("params: {\"a\": (type: F32, default: 1, range: (0, inf))}").starts_with("error[SW0108]"));
}

/// Catches parameters that have no place in a uniform buffer or among pipeline constants.
#[test]
fn modes() {
    let expected = "\
error[SW0109]: `a` cannot reach the shader this way
  --> module.ron:2:22
  |
2 | params: {\"a\": (type: Bool, default: true)})
  |                      ^^^^ WGSL has no `bool` in uniform buffers
  |
  = add `mode: Override` or `mode: Constant`
";
    assert_eq!(module("params: {\"a\": (type: Bool, default: true)}"), expected);
    for inner in [
        "params: {\"a\": (type: Color, default: (1, 1, 1), mode: Override)}",
        "instances: {\"a\": (type: Bool, default: true)}",
    ] {
        assert!(module(inner).starts_with("error[SW0109]"), "{inner}");
    }
}

/// Catches a shadow map of a pass that is not there, or is a compute pass.
#[test]
fn passes_of_resources() {
    let expected = "\
error[SW0110]: there is no `Draw` pass `shdow`
  --> module.ron:2:39
  |
2 | resources: {\"map\": (kind: Depth(pass: \"shdow\"))},
  |                                       ^^^^^^^ not declared
  |
  = did you mean `shadow`?
  = passes that draw: shadow
";
    let pass = "params: {\"size\": (type: U32, default: 512)},\npasses: {\"shadow\": Draw(root: \"d\", view: Cube, resolution: \"size\")}";
    assert_eq!(
        module(&format!("resources: {{\"map\": (kind: Depth(pass: \"shdow\"))}},\n{pass}")),
        expected
    );
    let text = module("resources: {\"v\": (kind: Views(pass: \"p\"))}, passes: {\"p\": Compute(entry: \"a\", over: Once)}");
    assert!(text.starts_with("error[SW0110]") && text.contains("draws nothing"), "{text}");
}

/// Catches a pass without a size.
#[test]
fn resolution() {
    let expected = "\
error[SW0111]: the pass `p` needs a `U32` parameter for its resolution
  --> module.ron:3:55
  |
3 | passes: {\"p\": Draw(root: \"d\", view: Cube, resolution: \"size\")})
  |                                                       ^^^^^^ not a `U32`
  |
  = `U32` parameters: none
";
    let text = "params: {\"size\": (type: F32, default: 512)},\npasses: {\"p\": Draw(root: \"d\", view: Cube, resolution: \"size\")}";
    assert_eq!(module(text), expected);
    assert!(module("passes: {\"p\": Draw(root: \"d\", view: Cube, resolution: \"size\")}").contains("not declared"));
}

/// Catches two slots whose calls cannot be told apart, and a resource that hides what the linker generates.
#[test]
fn clashes() {
    let expected = "\
error[SW0112]: calls to the slots `a` and `b` look the same
  --> module.ron:2:35
  |
2 | slots: {\"a\": (interface: \"brdf\"), \"b\": (interface: \"brdf\")})
  |         ---                       ^^^ functions of `brdf`
  |         |                          
  |         and here
  |
  = give one of them a `prefix`
";
    assert_eq!(
        module("slots: {\"a\": (interface: \"brdf\"), \"b\": (interface: \"brdf\")}"),
        expected
    );
    assert!(module("resources: {\"params\": (kind: Texture())}").starts_with("error[SW0112]"));
}

/// Catches conversions that give nothing, or the wrong sign.
#[test]
fn units() {
    let expected = "\
error[SW0113]: `a` cannot be written in `cm`
  --> module.ron:2:51
  |
2 | params: {\"a\": (type: F32, unit: \"m\", also: {\"cm\": 0}, default: 1)})
  |                                                   ^ not a positive finite factor
";
    assert_eq!(
        module("params: {\"a\": (type: F32, unit: \"m\", also: {\"cm\": 0}, default: 1)}"),
        expected
    );
    assert!(module("params: {\"a\": (type: F32, unit: \"m\", also: {\"m\": 2}, default: 1)}").contains("own unit"));
}

/// Catches a capability that no device could ever be asked for.
#[test]
fn capabilities() {
    let text = module("capabilities: [\"SHADER_FLOT16\"]");
    let expected = "\
error[SW0114]: there is no capability `SHADER_FLOT16`
  --> module.ron:2:16
  |
2 | capabilities: [\"SHADER_FLOT16\"])
  |                ^^^^^^^^^^^^^^^ unknown
  |
  = did you mean `SHADER_FLOAT16`?
";
    assert_eq!(text, expected);
}

/// Catches a bind group that no device has room for.
#[test]
fn groups() {
    let parsed = parse_category("category.ron", "(summary: \"s\", order: 1, group: 4)").unwrap();
    let expected = "\
error[SW0116]: there is no bind group 4
  --> category.ron:1:33
  |
1 | (summary: \"s\", order: 1, group: 4)
  |                                 ^ too large
  |
  = groups: 0 frame, 1 lights and shadows, 2 material, 3 pass
";
    assert_eq!(check_category(&parsed).unwrap_err().render(), expected);
    assert!(module("resources: {\"a\": (kind: Texture(), group: 4)}").starts_with("error[SW0116]"));
}

/// Catches a check that stops at the first error.
#[test]
fn all_errors_are_told() {
    let text = module("params: {\"a-b\": (type: F32, default: true), \"c\": (type: Bool, default: 1)}");
    assert_eq!(text.matches("error[SW").count(), 4, "{text}");
}
