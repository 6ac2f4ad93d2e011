//! Tests of the module around.

use proptest::prelude::*;

use super::*;
use crate::diagnostics::Report;

fn param(ty: ParamType, unit: &str, range: Option<(f64, f64)>) -> Param {
    Param {
        ty,
        unit: unit.to_owned(),
        also: [("klm".to_owned(), 1000.0), ("mlm".to_owned(), 1e-3)]
            .into_iter()
            .filter(|_| unit == "lm")
            .collect(),
        default: Value::Number(0.0),
        range,
        doc: String::new(),
        mode: crate::manifest::ParamMode::default(),
        role: None,
    }
}

fn text(text: &str) -> Value {
    Value::Text(text.to_owned())
}

fn rendered(param: &Param, written: &str) -> String {
    let file = SourceFile::new("r", written);
    let value: Value = ron::from_str(written).unwrap();
    let error = typed(param, &value).expect_err(written);
    Report::from(error.diagnostic("p", &file, 0..written.len())).render()
}

/// Catches a type that takes another's values, or refuses its own.
#[test]
fn types() {
    let plain = |ty| param(ty, "", None);
    assert_eq!(typed(&plain(ParamType::F32), &Value::Number(0.1)), Ok(Typed::F32(0.1)));
    assert_eq!(
        typed(&plain(ParamType::U32), &Value::Number(4294967295.0)),
        Ok(Typed::U32(u32::MAX))
    );
    assert_eq!(
        typed(&plain(ParamType::I32), &Value::Number(-2147483648.0)),
        Ok(Typed::I32(i32::MIN))
    );
    assert_eq!(typed(&plain(ParamType::Bool), &Value::Bool(true)), Ok(Typed::Bool(true)));
    assert_eq!(
        typed(&plain(ParamType::Vec2), &Value::List(vec![1.0, 2.0])),
        Ok(Typed::Vec2([1.0, 2.0]))
    );
    assert_eq!(
        typed(&plain(ParamType::Color), &Value::List(vec![1.0; 3])),
        Ok(Typed::Vec3([1.0; 3]))
    );
    assert_eq!(
        typed(&plain(ParamType::Vec4), &Value::List(vec![1.0; 4])),
        Ok(Typed::Vec4([1.0; 4]))
    );
    for (ty, value) in [
        (ParamType::F32, Value::Bool(true)),
        (ParamType::F32, Value::List(vec![1.0])),
        (ParamType::F32, text("1")),
        (ParamType::F32, text("x lm")),
        (ParamType::U32, Value::Number(0.5)),
        (ParamType::I32, Value::Number(-0.5)),
        (ParamType::Bool, Value::Number(1.0)),
        (ParamType::Vec3, Value::List(vec![1.0, 2.0])),
        (ParamType::Vec3, Value::Number(1.0)),
        (ParamType::Vec3, text("2700 K")),
        (ParamType::Color, text("warm")),
    ] {
        let error = typed(&plain(ty), &value).unwrap_err();
        assert!(
            matches!(error, ValueError::WrongType { .. }) && error.code() == codes::PARAM_WRONG_TYPE,
            "{ty:?} {value:?}"
        );
    }
    assert_eq!(
        typed(&plain(ParamType::U32), &Value::Number(-1.0)).unwrap_err().code(),
        codes::PARAM_OUT_OF_RANGE
    );
    assert_eq!(
        typed(&plain(ParamType::U32), &Value::Number(4294967296.0)).unwrap_err().code(),
        codes::PARAM_OUT_OF_RANGE
    );
}

/// Catches a unit that is ignored, or converted the wrong way round.
#[test]
fn units() {
    let flux = param(ParamType::F32, "lm", None);
    assert_eq!(typed(&flux, &text("800 lm")), Ok(Typed::F32(800.0)));
    assert_eq!(typed(&flux, &text(" 1.5e1  klm ")), Ok(Typed::F32(15000.0)));
    assert_eq!(typed(&flux, &text("500 mlm")), Ok(Typed::F32(0.5)));
}

/// Catches watts that are taken for lumens, an efficacy that is ignored or dropped, one that no lamp has, and watts where no light is meant.
#[test]
fn watts() {
    let flux = param(ParamType::F32, "lm", None);
    assert_eq!(typed(&flux, &text("60 W at 15 lm/W")), Ok(Typed::F32(900.0)));
    let candela = Param {
        also: [("lm".to_owned(), 0.25)].into_iter().collect(),
        ..param(ParamType::F32, "cd", None)
    };
    assert_eq!(typed(&candela, &text(" 8 W at 100 lm/W ")), Ok(Typed::F32(200.0)));
    for (written, expected) in [
        (
            "\"60 W\"",
            "\
error[SW0304]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"60 W\"
  | ^^^^^^ the unit `W` is not taken here
  |
  = how much light a watt gives is the lamp's efficacy: write it as `60 W at 15 lm/W`
",
        ),
        (
            "\"60 W at 700 lm/W\"",
            "\
error[SW0302]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"60 W at 700 lm/W\"
  | ^^^^^^^^^^^^^^^^^^ an efficacy of 700 lm/W is outside 0 to 683 lm/W
",
        ),
    ] {
        assert_eq!(rendered(&flux, written).trim_end(), expected.trim_end());
    }
    for unknown in ["60 W at 15 lm", "60 W at", "60 W at x lm/W", "60 W 15 lm/W"] {
        assert_eq!(typed(&flux, &text(unknown)).unwrap_err().code(), codes::UNKNOWN_UNIT, "{unknown}");
    }
    let length = param(ParamType::F32, "m", None);
    assert_eq!(typed(&length, &text("60 W at 15 lm/W")).unwrap_err().code(), codes::UNKNOWN_UNIT);
}

/// Catches a number that becomes infinite or NaN on its way.
#[test]
fn not_finite() {
    let plain = param(ParamType::F32, "lm", None);
    for value in [
        Value::Number(f64::NAN),
        Value::Number(f64::INFINITY),
        Value::Number(1e39),
        text("1e308 klm"),
    ] {
        assert_eq!(typed(&plain, &value).unwrap_err().code(), codes::PARAM_NOT_FINITE, "{value:?}");
    }
    let vector = param(ParamType::Vec2, "", Some((0.0, 1.0)));
    assert_eq!(
        typed(&vector, &Value::List(vec![0.0, f64::NAN])).unwrap_err().code(),
        codes::PARAM_NOT_FINITE
    );
}

/// Catches a colour temperature that is read as a colour, or not scaled.
#[test]
fn temperature() {
    let Ok(Typed::Vec3([r, g, b])) = typed(&param(ParamType::Color, "", None), &text("2856 K")) else {
        panic!("no colour");
    };
    assert!((r - 1.8448).abs() < 1e-4 && (g - 0.8261).abs() < 1e-4 && (b - 0.2334).abs() < 1e-4);
    let Ok(Typed::Vec3(white)) = typed(&param(ParamType::Color, "", None), &text("6504 K daylight")) else {
        panic!("no colour");
    };
    assert!(white.iter().all(|channel| (channel - 1.0).abs() < 1e-3), "{white:?}");
    let expected = "\
error[SW0306]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"3000 K daylight\"
  | ^^^^^^^^^^^^^^^^^ daylight of 3000 K is outside 4000 to 25000 K
";
    assert_eq!(
        rendered(&param(ParamType::Color, "", None), "\"3000 K daylight\"").trim_end(),
        expected.trim_end()
    );
}

/// Catches a message without the value, its bounds or what to write instead. One whole text for each code.
#[test]
fn messages() {
    let expected = "\
error[SW0302]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 klm\"
  | ^^^^^^^ 2000 lm is outside 0 to 1000 lm
";
    assert_eq!(rendered(&param(ParamType::F32, "lm", Some((0.0, 1000.0))), "\"2 klm\""), expected);
    let expected = "\
error[SW0303]: the value of `p` does not fit
  --> r:1:1
  |
1 | (1, 2)
  | ^^^^^^ expected three numbers in parentheses, linear Rec.709, or a temperature such as \"2700 K\", found 2 numbers
";
    assert_eq!(rendered(&param(ParamType::Color, "", None), "(1, 2)"), expected);
    let expected = "\
error[SW0304]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 kml\"
  | ^^^^^^^ the unit `kml` is not taken here
  |
  = did you mean `klm`?
  = units: lm, klm, mlm
";
    assert_eq!(rendered(&param(ParamType::F32, "lm", None), "\"2 kml\""), expected);
    let expected = "\
error[SW0304]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"2 m\"
  | ^^^^^ the unit `m` is not taken here
  |
  = it is a pure number: write it without a unit
";
    assert_eq!(rendered(&param(ParamType::F32, "1", None), "\"2 m\""), expected);
    let expected = "\
error[SW0305]: the value of `p` does not fit
  --> r:1:1
  |
1 | inf
  | ^^^ inf is not a finite number of 32 bits
";
    assert_eq!(rendered(&param(ParamType::F32, "1", Some((0.0, 1.0))), "inf"), expected);
    let expected = "\
error[SW0306]: the value of `p` does not fit
  --> r:1:1
  |
1 | \"27 K\"
  | ^^^^^^ a colour temperature of 27 K is outside 1000 to 40000 K
";
    assert_eq!(rendered(&param(ParamType::Color, "", None), "\"27 K\""), expected);
}

fn through_naga(value: Typed) -> Vec<u8> {
    let source = format!("const c = {};", value.wgsl());
    let module = naga::front::wgsl::parse_str(&source).unwrap_or_else(|e| panic!("{source}: {e}"));
    let constant = module.constants.iter().next().unwrap().1;
    fn bytes(module: &naga::Module, at: naga::Handle<naga::Expression>) -> Vec<u8> {
        match &module.global_expressions[at] {
            naga::Expression::Literal(naga::Literal::F32(x)) => x.to_le_bytes().to_vec(),
            naga::Expression::Literal(naga::Literal::U32(n)) => n.to_le_bytes().to_vec(),
            naga::Expression::Literal(naga::Literal::I32(n)) => n.to_le_bytes().to_vec(),
            naga::Expression::Literal(naga::Literal::Bool(b)) => u32::from(*b).to_le_bytes().to_vec(),
            naga::Expression::Compose { components, .. } => components.iter().flat_map(|c| bytes(module, *c)).collect(),
            other => panic!("{other:?}"),
        }
    }
    bytes(&module, constant.init)
}

proptest! {
    /// Catches a literal that loses a bit, its type or its sign on the way through naga, or bytes that differ from it.
    #[test]
    fn wgsl_and_bytes_round_trip(bits: [u32; 4], small: bool) {
        let f = bits.map(|b| if small { (b as f32) / 4096.0 - 5e5 } else { f32::from_bits(b) }).map(|x| if x.is_finite() { x } else { -0.0 });
        for value in [
            Typed::F32(f[0]), Typed::U32(bits[0]), Typed::I32(bits[1] as i32), Typed::Bool(small),
            Typed::Vec2([f[0], f[1]]), Typed::Vec3([f[0], f[1], f[2]]), Typed::Vec4(f),
        ] {
            prop_assert_eq!(through_naga(value), value.bytes(), "{}", value.wgsl());
        }
        let json = serde_json::to_string(&Typed::F32(f[0]).json()).unwrap();
        prop_assert_eq!(serde_json::from_str::<f64>(&json).unwrap() as f32, f[0]);
    }
}

/// Catches the extremes that random bits rarely hit, and a JSON number with a tail of digits.
#[test]
fn extremes() {
    for x in [0.0, -0.0, f32::MIN_POSITIVE, 1e-45, f32::MAX, f32::MIN, 1.0, 16777216.0] {
        assert_eq!(through_naga(Typed::F32(x)), x.to_le_bytes());
    }
    for n in [i32::MIN, -1, 0, i32::MAX] {
        assert_eq!(through_naga(Typed::I32(n)), n.to_le_bytes());
    }
    assert_eq!(Typed::Vec2([0.1, 3.0]).json().to_string(), "[0.1,3.0]");
}
