//! The whole text of each diagnostic that WESL can give.

use shadewright_compiler::diagnostics::{Report, codes};
use shadewright_compiler::upstream;

use super::{ROOT, grain, resolved};

fn refused(path: &str, text: &str, expected: &str) {
    let report = resolved(grain().with(path, text)).map(|file| file.text.clone()).unwrap_err();
    assert_eq!(report, expected.trim_start());
}

/// Catches an error of wesl that loses its file or its place, and a text that changes by accident; so do the following.
#[test]
fn sw0416_wesl_syntax() {
    refused(
        ROOT,
        "fn f() {\n    let x 1;\n}\n",
        r#"
error[SW0416]: `1` does not fit here
  --> brdf/grain/grain.wesl:2:11
  |
2 |     let x 1;
  |           ^ not understood
  |
  = expected is `:` or `=`
"#,
    );
    refused(
        "shared/noise.wgsl",
        "fn f(",
        r#"
error[SW0416]: the file ends too early
  --> shared/noise.wgsl:1:6
  |
1 | fn f(
  |      ^ not understood
  |
  = expected is `@` or `)` or a name
"#,
    );
}

#[test]
fn sw0417_wesl_import() {
    refused(
        ROOT,
        "import super::nothing::f;\nfn g() { f(); }\n",
        r#"
error[SW0417]: the import `package::brdf::grain::nothing` leads nowhere
  --> brdf/grain/grain.wesl:1:15
  |
1 | import super::nothing::f;
  |               ^^^^^^^ not there
  |
  = looked for `brdf/grain/nothing.wesl` and `brdf/grain/nothing.wgsl` in the library's folder
"#,
    );
    refused(
        ROOT,
        "import package::shared::noise::{hush, Cell};\nfn g(c: Cell) -> f32 { return hush(c); }\n",
        r#"
error[SW0417]: `package::shared::noise` has no declaration `hush`
  --> brdf/grain/grain.wesl:1:33
  |
1 | import package::shared::noise::{hush, Cell};
  |                                 ^^^^ not there
  |
  = did you mean `hash`?
  = declarations of `shared/noise.wgsl`: LIMIT, Cell, unused, mix_up, hash
"#,
    );
    refused(
        ROOT,
        "import bevy::pbr::f;\nfn g() { f(); }\n",
        r#"
error[SW0417]: the import `bevy::pbr` leads nowhere
  --> brdf/grain/grain.wesl:1:14
  |
1 | import bevy::pbr::f;
  |              ^^^ not there
  |
  = a path begins with `package::`, the library's folder, or `super::`; other packages are not taken
"#,
    );
    refused(
        "brdf/grain/tools.wesl",
        "@publish import super::grain::twice;\n",
        r#"
error[SW0417]: an import that is passed on
  --> brdf/grain/tools.wesl:1:2
  |
1 | @publish import super::grain::twice;
  |  ^^^^^^^ not taken
  |
  = import from the file that has the declaration
"#,
    );
}

#[test]
fn sw0418_wesl_condition() {
    refused(
        ROOT,
        "@if(fine && slow)\nfn f() {}\n",
        r#"
error[SW0418]: there is no feature `slow`
  --> brdf/grain/grain.wesl:1:13
  |
1 | @if(fine && slow)
  |             ^^^^ asked for here
  |
  = declare it in the `wesl.ron` of the module's folder: `(features: {"slow": true})`
"#,
    );
    refused(
        ROOT,
        "fn f() {}\n@else\nfn g() {}\n",
        r#"
error[SW0418]: an @elif or @else attribute must be preceded by a @if or @elif on the previous node
  --> brdf/grain/grain.wesl:2:1
  |  
2 | / @else
3 | | fn g() {}
  | \---------^ here
"#,
    );
}

#[test]
fn sw0419_wesl_declaration() {
    refused(
        "brdf/grain/wesl.ron",
        "(\n    feature: {\"fine\": true},\n)\n",
        r#"
error[SW0419]: this declares no features
  --> brdf/grain/wesl.ron:2:5
  |
2 |     feature: {"fine": true},
  |     ^^^^^^^ Unexpected field named `feature` in `Declared`, expected `features` instead
  |
  = expected is `(features: {"name": true})`
"#,
    );
}

#[test]
fn sw0420_wesl_and_wgsl() {
    refused(
        "brdf/grain/grain.wgsl",
        "",
        r#"
error[SW0420]: `brdf/grain/grain.wgsl` and `brdf/grain/grain.wesl` are both there
 = a module's code is in one of them: remove the other
"#,
    );
}

#[test]
fn sw0707_wesl_panic() {
    let report = upstream::guarded_in("wesl", codes::WESL_PANIC, "resolving `a.wesl`", || panic!("planted")).map(|(): ()| ());
    let report = report.map_err(|diagnostic| Report::from(diagnostic).render());
    let expected = "\
error[SW0707]: wesl gave up while resolving `a.wesl`
 = planted
 = this is an error of wesl, which reads and writes shaders for us; a simpler formulation may avoid it
";
    assert_eq!(report.unwrap_err(), expected);
}
