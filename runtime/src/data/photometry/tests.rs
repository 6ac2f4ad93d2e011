//! Tests of the module around: files made by formula, and files damaged.

use std::f64::consts::PI;
use std::fmt::Write as _;

use proptest::prelude::*;

use super::*;

/// An IES file of a formula of the angles in degrees.
fn ies(first_line: &str, kind: u32, vertical: &[f64], horizontal: &[f64], of: impl Fn(f64, f64) -> f64) -> String {
    let list = |angles: &[f64]| angles.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let mut text = format!(
        "{first_line}\n[TEST] made by formula\nTILT=NONE\n2 500 1 {} {} {kind} 2 0.1 0.2 0.3\n1 1 100\n{}\n{}\n",
        vertical.len(),
        horizontal.len(),
        list(vertical),
        list(horizontal)
    );
    for h in horizontal {
        let row: Vec<f64> = vertical.iter().map(|v| of(*v, *h)).collect();
        writeln!(text, "{}", list(&row)).unwrap();
    }
    text
}

/// An EULUMDAT file of so many planes and angles up to 90 degrees, with the intensities of these planes, in cd for each klm of 2000 lm.
fn ldt(symmetry: u32, planes: &[f64], angles: &[f64], given: &[f64], of: impl Fn(f64, f64) -> f64) -> String {
    let mut lines = vec![
        "Maker".to_owned(),
        "1".into(),
        symmetry.to_string(),
        planes.len().to_string(),
        "15".into(),
        angles.len().to_string(),
        "5".into(),
    ];
    lines.extend(["report", "name", "number", "file", "date"].map(str::to_owned));
    lines.extend(["200", "100", "50", "190", "90", "0", "0", "0", "0", "100", "100", "1,0", "0", "1"].map(str::to_owned));
    lines.extend(["1", "lamp", "2000", "830", "80", "25"].map(str::to_owned));
    lines.extend(vec!["0.5".to_owned(); 10]);
    lines.extend(planes.iter().chain(angles).map(f64::to_string));
    for plane in given {
        lines.extend(angles.iter().map(|angle| (of(*angle, *plane) / 2.0).to_string()));
    }
    lines.join("\r\n") + "\r\n"
}

fn steps(from: f64, to: f64, by: f64) -> Vec<f64> {
    let count = ((to - from) / by).round() as usize;
    (0..=count).map(|i| from + by * i as f64).collect()
}

fn near(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} is not {expected}");
}

fn cosine(degrees: f64) -> f64 {
    if degrees < 90.0 { 1000.0 * degrees.to_radians().cos() } else { 0.0 }
}

/// Catches a solid angle that is left out, a rule that is only good for fine steps, and factors that are dropped: a cosine's flux is known.
#[test]
fn flux_of_a_cosine() {
    let read = |text: &str| Photometry::read(text.as_bytes()).unwrap();
    let fine = ies("IESNA:LM-63-2002", 1, &steps(0.0, 90.0, 0.5), &[0.0], |v, _| cosine(v));
    near(read(&fine).flux(), 1000.0 * PI, 1e-4);
    let coarse = ies("IESNA:LM-63-2002", 1, &steps(0.0, 90.0, 5.0), &[0.0], |v, _| cosine(v));
    // Linear between steps of 5 degrees.
    near(read(&coarse).flux(), 3_139.597_4, 1e-7);
    assert_eq!(read(&coarse).lamps, Some(1000.0));
    let scaled = coarse.replace("2 500 1 ", "1 -1 3 ").replace("1 1 100\n", "0.5 2 100\n");
    near(read(&scaled).flux(), 1.5 * 3_139.597_4, 1e-7);
    assert_eq!(read(&scaled).lamps, None);
    // Behind a mark of UTF-8 the first line is still the first.
    near(read(&format!("\u{feff}{scaled}")).flux(), 1.5 * 3_139.597_4, 1e-7);
    // Before 1995 the second factor counts.
    near(read(&scaled.replace("IESNA:LM-63-2002", "IESNA91")).flux(), 3.0 * 3_139.597_4, 1e-7);
    near(read(&scaled.replace("IESNA:LM-63-2002\n", "")).flux(), 3.0 * 3_139.597_4, 1e-7);
    near(
        read(&scaled.replace("IESNA:LM-63-2002", "IES:LM-63-2019")).flux(),
        1.5 * 3_139.597_4,
        1e-7,
    );
}

/// The standard library's own example, read from its file: the flux of the formula that it was made by, to 0.1 %.
#[test]
fn flux_of_the_example() {
    let file = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/../modules/light/photometric/sample.ies")).unwrap();
    let read = Photometry::read(&file).unwrap();
    // 2 pi times the integral of 1000 cos^3 sin; what depends on C has the mean 0.
    near(read.flux(), 500.0 * PI, 1e-3);
    // The table's head has it for the shader.
    assert_eq!(read.table()[..4], [0.0, 37.0, 25.0, read.flux() as f32]);
}

/// The intensity in a direction of the grid, by azimuth and polar angle in degrees.
fn at(read: &Photometry, azimuth: f64, polar: f64) -> f64 {
    let index = |list: &[f64], degrees: f64| {
        list.iter()
            .position(|x| (x.to_degrees() - degrees).abs() < 1e-6)
            .unwrap_or_else(|| panic!("no {degrees} among {list:?}"))
    };
    read.candela[index(&read.azimuth, azimuth) * read.polar.len() + index(&read.polar, polar)]
}

/// Catches a symmetry that repeats the wrong planes: each file says the same light, with as much of it as it may leave out.
#[test]
fn symmetric_files_say_the_same() {
    // Even in C and in 180 - C; the third only in C, the fourth only about the plane of 90 degrees.
    let four = |v: f64, h: f64| cosine(v) * (1.0 + 0.3 * (2.0 * h.to_radians()).cos() * v.to_radians().sin());
    let half = |v: f64, h: f64| cosine(v) * (1.0 + 0.3 * h.to_radians().cos() * v.to_radians().sin());
    let other = |v: f64, h: f64| cosine(v) * (1.0 + 0.3 * h.to_radians().sin() * v.to_radians().sin());
    let vertical = steps(0.0, 90.0, 15.0);
    let turn = steps(0.0, 345.0, 15.0);
    let file = |horizontal: &[f64], of: &dyn Fn(f64, f64) -> f64| {
        Photometry::read(ies("IESNA:LM-63-1995", 1, &vertical, horizontal, of).as_bytes()).unwrap()
    };
    let data = |symmetry: u32, given: &[f64], of: &dyn Fn(f64, f64) -> f64| {
        Photometry::read(ldt(symmetry, &turn, &vertical, given, of).as_bytes()).unwrap()
    };
    let same = |one: &Photometry, of: &dyn Fn(f64, f64) -> f64| {
        let start = one.azimuth[0].to_degrees().round();
        assert_eq!((one.azimuth.len(), one.pole), (25, Pole::Direction));
        for azimuth in steps(start, start + 360.0, 15.0) {
            for polar in &vertical {
                assert!((at(one, azimuth, *polar) - of(*polar, azimuth)).abs() < 1e-9, "{azimuth} {polar}");
            }
        }
    };
    same(&file(&steps(0.0, 360.0, 15.0), &four), &four);
    same(&file(&turn, &four), &four);
    same(&file(&steps(0.0, 180.0, 15.0), &four), &four);
    same(&file(&steps(0.0, 90.0, 15.0), &four), &four);
    same(&file(&steps(0.0, 180.0, 15.0), &half), &half);
    same(&file(&steps(90.0, 270.0, 15.0), &other), &other);
    same(&data(0, &turn, &half), &half);
    same(&data(2, &steps(0.0, 180.0, 15.0), &half), &half);
    same(&data(4, &steps(0.0, 90.0, 15.0), &four), &four);
    let around: Vec<f64> = steps(270.0, 345.0, 15.0).into_iter().chain(steps(0.0, 90.0, 15.0)).collect();
    same(&data(3, &around, &other), &other);
    let round = data(1, &[0.0], &|v, _| cosine(v));
    assert_eq!((round.azimuth.len(), round.lamps), (2, Some(2000.0)));
    near(round.flux(), file(&[0.0], &|v, _| cosine(v)).flux(), 1e-12);
    assert_eq!(round.opening, [0.19, 0.09, 0.0]);
    assert_eq!(file(&[0.0], &|v, _| cosine(v)).opening, [0.1, 0.2, 0.3]);
}

/// Catches line ends of one system only: all three say the same.
#[test]
fn line_ends_of_all_systems() {
    let turn = steps(0.0, 270.0, 90.0);
    let data = ldt(0, &turn, &[0.0, 90.0], &turn, |v, h| v + h);
    let read = |text: &str| Photometry::read(text.as_bytes()).unwrap();
    for end in ["\n", "\r"] {
        assert_eq!(read(&data.replace("\r\n", end)), read(&data));
    }
    let file = ies("IESNA:LM-63-2002", 1, &[0.0, 90.0], &[0.0], |v, _| v);
    for end in ["\r\n", "\r"] {
        assert_eq!(read(&file.replace('\n', end)), read(&file));
    }
}

/// Catches types A and B mistaken for each other, or for C: a beam of 10 degrees beside the axis, and the flux of light that is equal everywhere.
#[test]
fn beams_of_types_a_and_b() {
    let grid = steps(-90.0, 90.0, 10.0);
    let one = |at: (f64, f64)| move |v: f64, h: f64| if (v, h) == at { 7.0 } else { 0.0 };
    let read = |kind: u32, horizontal: &[f64], of: &dyn Fn(f64, f64) -> f64| {
        Photometry::read(ies("IESNA:LM-63-2002", kind, &grid, horizontal, of).as_bytes()).unwrap()
    };
    // Vertical 20, horizontal 30.
    let a = read(3, &grid, &one((20.0, 30.0)));
    assert_eq!((a.pole, at(&a, 30.0, 110.0), a.candela.iter().sum::<f64>()), (Pole::Down, 7.0, 7.0));
    let b = read(2, &grid, &one((20.0, 30.0)));
    assert_eq!((b.pole, at(&b, 20.0, 120.0), b.candela.iter().sum::<f64>()), (Pole::Left, 7.0, 7.0));
    // What is given from 0 on is on both sides, horizontally.
    let right = steps(0.0, 90.0, 10.0);
    let a = read(3, &right, &one((20.0, 30.0)));
    assert_eq!(
        (at(&a, 30.0, 110.0), at(&a, -30.0, 110.0), a.candela.iter().sum::<f64>()),
        (7.0, 7.0, 14.0)
    );
    let b = read(2, &right, &one((20.0, 30.0)));
    assert_eq!(
        (at(&b, 20.0, 120.0), at(&b, 20.0, 60.0), b.candela.iter().sum::<f64>()),
        (7.0, 7.0, 14.0)
    );
    for kind in [2, 3] {
        near(read(kind, &right, &|_, _| 1.0).flux(), 2.0 * PI, 1e-12);
    }
}

/// Catches a seam where the file gives a plane twice, and poles where the planes do not meet.
#[test]
fn seams_and_poles_are_one() {
    let file = ies(
        "IESNA:LM-63-2002",
        1,
        &[0.0, 90.0, 180.0],
        &[0.0, 90.0, 180.0, 270.0, 360.0],
        |v, h| v + h + 1.0,
    );
    let read = Photometry::read(file.as_bytes()).unwrap();
    assert_eq!(at(&read, 0.0, 90.0), 271.0);
    assert_eq!(at(&read, 360.0, 90.0), 271.0);
    for azimuth in [0.0, 90.0, 180.0, 270.0, 360.0] {
        assert_eq!(at(&read, azimuth, 0.0), (181.0 + 91.0 + 181.0 + 271.0) / 4.0);
    }
}

/// Catches errors without a line, or with another one: one whole text for each.
#[test]
fn errors_name_the_line() {
    let good = ies("IESNA:LM-63-2002", 1, &[0.0, 45.0, 90.0], &[0.0, 90.0], |v, _| cosine(v).round());
    let said = |text: &str| Photometry::read(text.as_bytes()).map(|_| ()).unwrap_err().to_string();
    let changed = |from: &str, to: &str| {
        assert!(good.contains(from), "{from} is not in {good}");
        said(&good.replacen(from, to, 1))
    };
    for (found, expected) in [
        (said("IESNA:LM-63-2002\n"), "line 1: the file ends before a line `TILT=NONE`"),
        (
            changed("TILT=NONE", "TILT=INCLUDE"),
            "line 3: `TILT=INCLUDE`: only `TILT=NONE` is taken",
        ),
        (
            changed("TILT=NONE", "TILT=lamp.tlt"),
            "line 3: `TILT=lamp.tlt`: only `TILT=NONE` is taken",
        ),
        (changed("2 500", "0 500"), "line 4: the number of lamps is 0, not from 1 to 1000000"),
        (
            changed("2 500", "2 lots"),
            "line 4: the lumens of a lamp should be a number, not `lots`",
        ),
        (
            changed("2 500", "2 -3"),
            "line 4: the lumens of a lamp is -3, not from -1 to 1000000000000",
        ),
        (
            changed(" 3 2 1 2 ", " 3.5 2 1 2 "),
            "line 4: the number of vertical angles is 3.5, no whole number",
        ),
        (
            changed(" 3 2 1 2 ", " 1 2 1 2 "),
            "line 4: the number of vertical angles is 1, not from 2 to 4096",
        ),
        (
            changed(" 3 2 1 2 ", " 4096 4096 1 2 "),
            "line 4: 4096 times 4096 angles are more than 1048576",
        ),
        (
            changed(" 3 2 1 2 ", " 3 2 4 2 "),
            "line 4: the photometric type is 4, not from 1 to 3",
        ),
        (
            changed(" 3 2 1 2 ", " 3 2 1 0 "),
            "line 4: the unit of lengths is 0, not from 1 to 2",
        ),
        (
            changed("0 45 90", "0 45 30"),
            "line 6: a vertical angle is 30, but the one before is 45",
        ),
        (changed("0 45 90", "0 45 190"), "line 6: a vertical angle is 190, not from 0 to 180"),
        (
            changed("\n0 90\n", "\n0 80\n"),
            "line 7: the horizontal angles go from 0 to 80, not from 0 to 0, 90, 180 or beyond, or from 90 to 270",
        ),
        (changed("707 0\n", "-707 0\n"), "line 8: an intensity of -707 cd"),
        (changed("707 0\n", "1e99 0\n"), "line 8: an intensity of 1e99 cd"),
        (
            changed("707 0\n", "nan 0\n"),
            "line 8: in the plane of 0 degrees, intensity 2 of 3 should be a number, not `nan`",
        ),
        (
            said(good.trim_end().trim_end_matches(" 0")),
            "line 9: the file ends before in the plane of 90 degrees, intensity 3 of 3",
        ),
    ] {
        // 1e99 prints with all its digits.
        let found = found.replace(&format!("{}", 1e99), "1e99");
        assert_eq!(found, expected);
    }
    let good = ldt(4, &[0.0, 90.0, 180.0, 270.0], &[0.0, 45.0, 90.0], &[0.0, 90.0], |v, _| {
        cosine(v).round()
    });
    let line = |number: usize, to: &str| {
        let lines: Vec<&str> = good
            .lines()
            .enumerate()
            .map(|(i, line)| if i + 1 == number { to } else { line })
            .collect();
        said(&lines.join("\n"))
    };
    for (found, expected) in [
        (said(""), "line 1: the file ends before the symmetry"),
        (line(3, "5"), "line 3: the symmetry is 5, not from 0 to 4"),
        (line(4, "6"), "line 4: 6 C planes cannot have the symmetry 4: no multiple of 4"),
        (line(4, "many"), "line 4: the number of C planes should be a number, not `many`"),
        (line(24, "-1"), "line 24: the conversion factor is -1, not from 0 to 1000000000000"),
        (line(26, "0"), "line 26: the number of lamp sets is 0, not from 1 to 20"),
        (line(29, ""), "line 29: the lamps' flux should be a number, not ``"),
        (line(44, "0"), "line 44: the angle of a C plane is 0, but the one before is 0"),
        (line(48, "99"), "line 49: an angle is 90, but the one before is 99"),
        (
            line(51, "x"),
            "line 51: in the C plane of 0 degrees, intensity 2 of 3 should be a number, not `x`",
        ),
        (
            said(good.trim_end().trim_end_matches('0').trim_end()),
            "line 54: the file ends before in the C plane of 90 degrees, intensity 3 of 3",
        ),
    ] {
        assert_eq!(found, expected);
    }
}

/// What any bytes may do: be read, with a grid that a shader can rely on, or be refused with a line of the file.
fn survives(bytes: &[u8]) {
    match Photometry::read(bytes) {
        Ok(read) => {
            assert_eq!(read.candela.len(), read.polar.len() * read.azimuth.len());
            assert!(read.polar.len() >= 2 && read.azimuth.len() >= 2);
            assert!(read.polar.is_sorted() && read.azimuth.is_sorted());
            assert!(read.candela.iter().all(|candela| candela.is_finite() && *candela >= 0.0));
            assert!(read.flux().is_finite() && read.flux() >= 0.0);
            assert!(read.azimuth[read.azimuth.len() - 1] - read.azimuth[0] <= TAU + 1e-9);
        }
        Err(error) => {
            let lines = bytes.iter().filter(|byte| matches!(byte, b'\n' | b'\r')).count() + 1;
            assert!((1..=lines).contains(&error.line), "{error} in a file of {lines} lines");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Catches panics, endless loops, and a count that is believed before it is bounded.
    #[test]
    fn damage_never_panics(
        kind in 0usize..4, cut in 0usize..2000, at in 0usize..2000, byte in any::<u8>(),
        word in prop_oneof![Just("-1"), Just("0"), Just("1e308"), Just("4096"), Just("99999999999"), Just("nan"), Just("0.5"), Just("360")],
        place in 0usize..60,
    ) {
        let base = match kind {
            0 => ies("IESNA:LM-63-1995", 1, &[0.0, 45.0, 90.0], &[0.0, 90.0], |v, h| v + h),
            1 => ies("IESNA91", 2, &[-90.0, 0.0, 90.0], &[0.0, 90.0], |v, h| v.abs() + h),
            2 => ldt(3, &[0.0, 90.0, 180.0, 270.0], &[0.0, 90.0], &[270.0, 0.0, 90.0], |v, h| v + h),
            _ => ldt(0, &[0.0, 90.0, 180.0, 270.0], &[0.0, 90.0], &[0.0, 90.0, 180.0, 270.0], |v, h| v + h),
        };
        survives(base.as_bytes());
        survives(&base.as_bytes()[..cut.min(base.len())]);
        let mut flipped = base.clone().into_bytes();
        let index = at % flipped.len();
        flipped[index] = byte;
        survives(&flipped);
        let words: Vec<&str> = base.split_inclusive(char::is_whitespace).collect();
        let index = place % words.len();
        let end = if words[index].ends_with('\n') { "\n" } else { " " };
        let changed = [&words[..index].concat(), word, end, &words[index + 1..].concat()].concat();
        survives(changed.as_bytes());
    }

    /// Catches bytes that nobody thought of.
    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        survives(&bytes);
        survives(&[b"TILT=NONE\n".as_slice(), &bytes].concat());
    }
}
