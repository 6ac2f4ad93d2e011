use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;

use super::warp::{Warp, bilinear};
use super::*;

/// Something with a lobe, by channel.
fn glossy(v: DVec3, l: DVec3) -> [f64; 3] {
    let h = (v + l).normalize();
    let lobe = h.z.powi(40);
    [0.1 + lobe, 0.05 + 2.0 * lobe, 0.3]
}

fn small() -> Merl {
    Merl::tabulate([4, 5, 6], glossy)
}

/// A table over one azimuth, three elevations and a 5 x 4 square, whose values say where they stand.
fn fields() -> Vec<Field> {
    let floats = |name: &str, shape: &[usize], of: &dyn Fn(usize) -> f32| Field {
        name: name.to_owned(),
        shape: shape.to_vec(),
        numbers: Numbers::Floats((0..shape.iter().product()).map(of).collect()),
    };
    vec![
        Field {
            name: "description".into(),
            shape: vec![4],
            numbers: Numbers::Bytes(b"test".to_vec()),
        },
        floats("phi_i", &[1], &|_| 0.0),
        floats("theta_i", &[3], &|i| i as f32 * 0.5),
        floats("ndf", &[2, 3], &|_| 0.5),
        floats("sigma", &[2, 3], &|_| 0.25),
        floats("vndf", &[1, 3, 4, 5], &|i| 1.0 + (i % 5) as f32),
        floats("rgb", &[1, 3, 3, 4, 5], &|i| i as f32),
        Field {
            name: "jacobian".into(),
            shape: vec![1],
            numbers: Numbers::Bytes(vec![1]),
        },
    ]
}

fn tensors() -> Vec<u8> {
    write_tensors(&fields())
}

/// The file with one of its fields replaced.
fn with(name: &str, shape: &[usize], numbers: Numbers) -> Vec<u8> {
    let mut fields = fields();
    let field = fields.iter_mut().find(|field| field.name == name).expect("a field");
    (field.shape, field.numbers) = (shape.to_vec(), numbers);
    write_tensors(&fields)
}

#[track_caller]
fn assert_damaged(bytes: &[u8], expected: &str) {
    match Measured::read(bytes) {
        Ok(_) => panic!("it is read"),
        Err(error) => assert_eq!(error.to_string(), expected),
    }
}

/// Catches planes, scales or an order of the cells that are not the format's, and a value that stands elsewhere than its directions say.
#[test]
fn merl_is_read_as_it_was_written() {
    let table = small();
    let bytes = table.write();
    assert_eq!(bytes.len(), 12 + 4 * 5 * 6 * 24);
    assert_eq!(bytes[..12], [4, 0, 0, 0, 5, 0, 0, 0, 6, 0, 0, 0]);
    let read = Merl::read(&bytes).expect("a table");
    assert_eq!(read.sizes(), [4, 5, 6]);
    let number = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().expect("8 bytes"));
    // theta_h 1, theta_d 2, phi_d 3: phi_d is the fastest.
    let index = (5 + 2) * 6 + 3;
    for (plane, scale) in [1.0, 1.15, 1.66].into_iter().enumerate() {
        let stands = number(12 + (plane * 120 + index) * 8) * scale / 1500.0;
        let value = f64::from(read.value([1, 2, 3]).expect("above the horizon")[plane]);
        assert!((stands / value - 1.0).abs() < 1e-6, "{stands} {value}");
    }
    // Independently: half and difference angles of the middle of that cell, after Rusinkiewicz 1998.
    let (theta_h, theta_d, phi_d) = ((1.5f64 / 4.0).powi(2) * FRAC_PI_2, 2.5 / 5.0 * FRAC_PI_2, 3.5 / 6.0 * PI);
    let samples = read.samples(usize::MAX >> 8, FRAC_PI_2);
    let found = samples.iter().filter(|sample| {
        let h = (sample.v + sample.l).normalize();
        // The light in the frame of the half vector: first the azimuth of h, then its elevation is turned away.
        let turned = glam::DQuat::from_rotation_y(-h.z.acos()) * (glam::DQuat::from_rotation_z(-h.y.atan2(h.x)) * sample.l);
        let phi = turned.y.atan2(turned.x).rem_euclid(PI);
        (h.z.acos() - theta_h).abs() < 1e-6 && (h.dot(sample.l).acos() - theta_d).abs() < 1e-6 && (phi - phi_d).abs() < 1e-6
    });
    let found: Vec<_> = found.collect();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].value, read.value([1, 2, 3]).expect("a value").map(f64::from));
    for sample in &samples {
        for (got, expected) in sample.value.iter().zip(glossy(sample.v, sample.l)) {
            assert!((got / expected - 1.0).abs() < 1e-6);
        }
    }
}

/// Catches a cell that was not measured and is taken for black or for a value below 0.
#[test]
fn what_was_not_measured_is_the_horizons() {
    let table = small();
    let cells = || (0..4).flat_map(|h| (0..5).flat_map(move |d| (0..6).map(move |p| [h, d, p])));
    let invalid: Vec<_> = cells().filter(|cell| table.value(*cell).is_none()).collect();
    // theta_h and theta_d add up to more than a right angle.
    assert!(invalid.contains(&[3, 4, 0]) && !invalid.contains(&[0, 0, 0]), "{invalid:?}");
    let floats = table.floats();
    assert_eq!((floats.len(), &floats[..3]), (3 + 5 * 6 * 6 * 3, &[4.0, 5.0, 6.0][..]));
    let at = |[h, d, p]: [usize; 3]| &floats[3 + ((h * 6 + d) * 6 + p) * 3..][..3];
    let filled = |cell: [usize; 3]| {
        let valid = (0..=cell[1]).rev().find_map(|d| table.value([cell[0], d, cell[2]]));
        valid.unwrap_or_default()
    };
    for cell in cells() {
        assert_eq!(at([cell[0] + 1, cell[1] + 1, cell[2]]), filled(cell), "{cell:?}");
    }
    // At an angle of 0 the mean over phi_d.
    for p in 0..6 {
        let mean = (0..6).map(|p| f64::from(filled([2, 0, p])[1])).sum::<f64>() / 6.0;
        assert!((f64::from(at([3, 0, p])[1]) - mean).abs() < 1e-6);
        let mean = (0..6).map(|p| f64::from(filled([0, 3, p])[0])).sum::<f64>() / 6.0;
        assert!((f64::from(at([0, 4, p])[0]) - mean).abs() < 1e-6);
    }
    assert!(table.samples(500, FRAC_PI_2).len() == 120 - invalid.len());
    assert!(table.samples(500, 1.0).iter().all(|s| s.v.z >= 1f64.cos() && s.l.z >= 1f64.cos()));
}

/// Catches a damaged file that is taken, that allocates before it is checked, or an error that does not say where and what.
#[test]
fn damaged_merl_files_say_where() {
    let bytes = small().write();
    let edited = |at: usize, with: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        bytes
    };
    assert_damaged(
        &[],
        "byte 0: expected 12 bytes of dimensions, found the end of the file after 0 bytes",
    );
    assert_damaged(
        &bytes[..7],
        "byte 7: expected 12 bytes of dimensions, found the end of the file after 7 bytes",
    );
    assert_damaged(
        &edited(4, &(-3i32).to_le_bytes()),
        "byte 4: expected a size of theta_d from 2 to 1024, found -3",
    );
    assert_damaged(
        &[[0xff, 0xff, 0xff, 0x7f]; 3].concat(),
        "byte 0: expected a size of theta_h from 2 to 1024, found 2147483647",
    );
    assert_damaged(
        &[[0, 4, 0, 0]; 3].concat(),
        "byte 12: expected 25769803788 bytes for 1024 x 1024 x 1024 cells of three channels, found 12 bytes",
    );
    assert_damaged(
        &bytes[..bytes.len() - 1],
        "byte 2891: expected 2892 bytes for 4 x 5 x 6 cells of three channels, found 2891 bytes",
    );
    assert_damaged(
        &[&bytes[..], &[0]].concat(),
        "byte 2892: expected 2892 bytes for 4 x 5 x 6 cells of three channels, found 2893 bytes",
    );
    assert_damaged(
        &edited(12 + 121 * 8, &f64::NAN.to_le_bytes()),
        "byte 980: expected a number that f32 can hold, green of cell 1, found NaN",
    );
    assert_damaged(
        &edited(12, &1e300f64.to_le_bytes()),
        "byte 12: expected a number that f32 can hold, red of cell 0, found 1e300",
    );
    let black = [&bytes[..12], &(-1.0f64).to_le_bytes().repeat(360)].concat();
    assert_damaged(&black, "byte 12: expected at least one cell without negative numbers, found none");
}

/// Catches fields read from other places than the file names, and a warp or a value that is another slice's.
#[test]
fn tensors_are_read_as_they_were_written() {
    let table = Rgl::read(&tensors()).expect("a table");
    assert_eq!((table.sizes(), table.is_isotropic()), ([1, 3, 5, 4], true));
    let samples = table.samples(1000, FRAC_PI_2);
    assert!(!samples.is_empty() && samples.len() <= 3 * 2 * 3);
    // ndf / (4 sigma) is a half; values of red below 60 are those of the first elevation, then the two other channels stand 20 further each.
    for sample in &samples {
        let rgb = sample.value.map(|x| x * sample.l.z * 2.0);
        assert!(
            (rgb[1] - rgb[0] - 20.0).abs() < 1e-4 && (rgb[2] - rgb[0] - 40.0).abs() < 1e-4,
            "{rgb:?}"
        );
        let slice = (sample.v.z.acos() / 0.5).round() * 60.0;
        assert!(rgb[0] > slice - 1e-3 && rgb[0] < slice + 20.0, "{rgb:?} {slice}");
    }
    let floats = table.floats();
    assert_eq!(
        floats[..16],
        [1.0, 3.0, 3.0, 2.0, 3.0, 2.0, 5.0, 4.0, 5.0, 4.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0]
    );
    assert_eq!(floats.len(), 16 + 4 + 6 + 6 + (60 + 60 + 12) + 180);
    assert_eq!(floats[floats.len() - 1], 179.0);
}

/// Catches a damaged file that is taken, or an error that does not say where and what.
#[test]
fn damaged_tensor_files_say_where() {
    let bytes = tensors();
    let edited = |at: usize, with: &[u8]| {
        let mut bytes = bytes.clone();
        bytes[at..at + with.len()].copy_from_slice(with);
        bytes
    };
    assert_damaged(
        &bytes[..13],
        "byte 12: expected 2 bytes of a version, found the end of the file after 1",
    );
    assert_damaged(&edited(12, &[2]), "byte 12: expected version 1.0, found 2.0");
    assert_damaged(
        &edited(14, &[0xff; 4]),
        &format!(
            "byte 14: expected no more fields than {} bytes hold, found 4294967295 fields",
            bytes.len() - 18
        ),
    );
    assert_damaged(&bytes[..20], "byte 14: expected no more fields than 2 bytes hold, found 8 fields");
    // The first field: length of its name, `description`, one dimension, type, offset, size.
    assert_damaged(
        &edited(20, &[0xff]),
        "byte 18: expected a name in UTF-8, found \"\u{fffd}escription\""
            .replace("byte 18", "byte 20")
            .as_str(),
    );
    assert_damaged(
        &edited(33, &[12]),
        "byte 33: expected a type from 1 to 11 for `description`, found 12",
    );
    assert_damaged(
        &edited(34, &[0xff; 8]),
        &format!(
            "byte 34: expected data of `description` within the file's {} bytes, found 4 bytes at 18446744073709551615",
            bytes.len()
        ),
    );
    assert_damaged(
        &edited(42, &[0xff; 8]),
        &format!(
            "byte 34: expected data of `description` within the file's {} bytes, found 18446744073709551615 bytes at {}",
            bytes.len(),
            u64::from(bytes[34]) + 256 * u64::from(bytes[35])
        ),
    );
    assert_damaged(&bytes[..bytes.len() - 1], &{
        let place = bytes.len() - 1;
        let entry = place_of(&bytes, "jacobian");
        format!(
            "byte {entry}: expected data of `jacobian` within the file's {} bytes, found 1 bytes at {place}",
            bytes.len() - 1
        )
    });
    let floats = |name: &str, shape: &[usize], values: &[f32]| with(name, shape, Numbers::Floats(values.to_vec()));
    let starts = |file: &[u8], expected: &str| {
        let error = Measured::read(file).expect_err("an error").to_string();
        assert_eq!(error.split_once(": ").expect("a place").1, expected);
    };
    starts(
        &floats("theta_i", &[3], &[0.0, 0.5, 0.5]),
        "expected `theta_i` ascending, from 0.0000 to 1.5709, found 0.5",
    );
    starts(&floats("phi_i", &[0], &[]), "expected `phi_i` of one dimension, found 0");
    starts(
        &floats("theta_i", &[3], &[0.0, f32::NAN, 1.0]),
        "expected a finite number in `theta_i`, found NaN",
    );
    starts(&floats("ndf", &[6], &[1.0; 6]), "expected `ndf` of two dimensions, found 6");
    starts(
        &floats("ndf", &[1, 6], &[1.0; 6]),
        "expected a grid of `ndf` with 2 to 4096 points along each side, found 1 x 6",
    );
    starts(
        &floats("sigma", &[2, 2], &[1.0, 1.0, -1.0, 1.0]),
        "expected a number from 0 on in `sigma`, found -1",
    );
    starts(
        &floats("vndf", &[3, 1, 4, 5], &[1.0; 60]),
        "expected `vndf` of 1 x 3 x height x width, as `phi_i` and `theta_i` are, found 3 x 1 x 4 x 5",
    );
    let mut zeros = [1.0; 60];
    zeros[20..40].fill(0.0);
    starts(
        &floats("vndf", &[1, 3, 4, 5], &zeros),
        "expected a distribution in slice 1 of `vndf`, found nothing but zeros, or sums too small to divide by",
    );
    starts(
        &floats("rgb", &[3, 1, 3, 4, 5], &[1.0; 180]),
        "expected `rgb` of 1 x 3 x 3 x height x width, as `phi_i` and `theta_i` are, found 3 x 1 x 3 x 4 x 5",
    );
    starts(
        &with("ndf", &[1], Numbers::Bytes(vec![1])),
        "expected `ndf` of two dimensions, found 1",
    );
    starts(
        &with("rgb", &[1, 3, 3, 4, 5], Numbers::Bytes(vec![1; 180])),
        "expected `rgb` of type f32, found type u8",
    );
    let mut spectral = super::tests::fields();
    spectral.iter_mut().find(|field| field.name == "rgb").expect("a field").name = "spectra".into();
    starts(
        &write_tensors(&spectral),
        "expected a field `rgb`: the collection has every material in this form too, found `spectra`, a table by wavelength",
    );
    let mut twice = super::tests::fields();
    twice[1].name = "theta_i".into();
    starts(
        &write_tensors(&twice),
        "expected fields of different names, found a second `theta_i`",
    );
    twice.truncate(2);
    starts(&write_tensors(&twice), "expected a field `phi_i`, found `description`, `theta_i`");
}

/// Where a field's place stands.
fn place_of(bytes: &[u8], name: &str) -> usize {
    let at = bytes
        .windows(name.len())
        .position(|window| window == name.as_bytes())
        .expect("a name");
    at + name.len() + 3
}

/// Catches azimuths that go neither round nor a half or a quarter round, and an anisotropic table that is read as an isotropic one.
#[test]
fn azimuths_go_round() {
    let table = |azimuths: &[f32]| {
        let n = azimuths.len();
        let mut fields = fields();
        for field in &mut fields {
            match field.name.as_str() {
                "phi_i" => (field.shape, field.numbers) = (vec![n], Numbers::Floats(azimuths.to_vec())),
                "vndf" | "rgb" => {
                    field.shape[0] = n;
                    let Numbers::Floats(floats) = &mut field.numbers else {
                        panic!("floats")
                    };
                    *floats = floats.repeat(n);
                }
                _ => {}
            }
        }
        Rgl::read(&write_tensors(&fields))
    };
    let pi = std::f32::consts::PI;
    let symmetry = |azimuths: &[f32]| table(azimuths).map(|table| (table.is_isotropic(), table.floats()[11]));
    assert_eq!(symmetry(&[0.0, pi]), Ok((true, 1.0)));
    assert_eq!(symmetry(&[-pi, 0.0, pi]), Ok((false, 1.0)));
    assert_eq!(symmetry(&[-pi, -1.0, 0.0]), Ok((false, 2.0)));
    assert_eq!(symmetry(&[-pi, -2.0, -pi / 2.0]), Ok((false, 4.0)));
    let error = symmetry(&[0.0, 1.0, 2.0]).expect_err("an error").to_string();
    assert!(
        error.ends_with("expected azimuths all round, or a half or a quarter round from -pi, found 0 to 2"),
        "{error}"
    );
}

/// Catches a warp that does not spread points as its function says: the share that lands in a part is the function's integral there.
#[test]
fn the_warp_spreads_as_its_function_says() {
    let values: Vec<f32> = (0..2 * 4 * 5).map(|i| ((i * 7 % 11) as f32).max(0.5)).collect();
    let warp = Warp::new(5, 4, values.clone()).expect("a warp");
    for slice in 0..2 {
        let own = &values[slice * 20..][..20];
        let n = 200;
        let (mut all, mut part, mut landed) = (0.0, 0.0, 0);
        for y in 0..n {
            for x in 0..n {
                let at = DVec2::new((f64::from(x) + 0.5) / f64::from(n), (f64::from(y) + 0.5) / f64::from(n));
                let is_in = |at: DVec2| at.x < 0.4 && at.y < 0.7;
                let density = bilinear(own, 5, 4, at);
                all += density;
                part += if is_in(at) { density } else { 0.0 };
                landed += i32::from(is_in(warp.sample(slice, at)));
            }
        }
        let share = f64::from(landed) / f64::from(n * n);
        assert!((share - part / all).abs() < 5e-3, "{share} instead of {}", part / all);
    }
    assert_eq!(Warp::new(2, 2, vec![1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0]), Err(1));
}

/// Catches a step of the recurrence that visits a cell twice, or leaves a part of a large table out.
#[test]
fn samples_are_spread() {
    let mut seen = std::collections::BTreeMap::new();
    spread([90, 90, 180], 2000, |at| {
        *seen.entry(at.map(|i| i / 45)).or_insert(0) += 1;
        true
    });
    assert_eq!(seen.values().sum::<i32>(), 2000);
    assert_eq!(seen.len(), 2 * 2 * 4);
    assert!(seen.values().all(|count| (100..150).contains(count)), "{seen:?}");
}

/// Catches bytes that make a reader panic, or read what is not there: a small generator damages whole files in many ways.
#[test]
fn no_bytes_make_a_reader_panic() {
    let mut state = 1u64;
    let mut random = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize
    };
    let mut read = 0;
    for file in [small().write(), tensors()] {
        for _ in 0..20_000 {
            let mut bytes = file.clone();
            for _ in 0..1 + random() % 4 {
                if bytes.is_empty() {
                    break;
                }
                // The front says what follows: most damage goes there.
                let end = if random() % 4 > 0 { bytes.len().min(420) } else { bytes.len() };
                let at = random() % end;
                match random() % 6 {
                    0 => bytes[at] = random() as u8,
                    1 => bytes[at] = 0xff,
                    2 => bytes.truncate(at.max(1)),
                    3 => bytes.insert(at, random() as u8),
                    4 => drop(bytes.remove(at)),
                    _ => bytes[at] ^= 1 << (random() % 8),
                }
            }
            if let Ok(table) = Measured::read(&bytes) {
                read += 1;
                let floats = table.floats();
                assert!(floats.len() * 4 <= 4 * bytes.len() + 4096 && floats.iter().all(|x| x.is_finite()));
                assert!(
                    table
                        .samples(50, 1.4)
                        .iter()
                        .all(|s| s.value.iter().all(|x| x.is_finite() && *x >= 0.0))
                );
            }
        }
    }
    assert!(read > 100, "{read}");
}
