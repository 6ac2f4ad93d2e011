//! Pictures as tables.

use proptest::prelude::*;

use super::*;
use crate::image::{Hdr, encode_exr, encode_png};

fn hdr(width: u32, height: u32, texels: Vec<[f32; 4]>) -> Vec<u8> {
    let picture = Hdr {
        width,
        height,
        texels,
        comment: String::new(),
    };
    encode_exr(&picture).unwrap()
}

/// Catches rows upside down, swapped channels, levels that are not where the header says, odd sides whose last texel has no weight, and a mean that is
/// not that of the picture.
#[test]
fn levels_are_means() {
    let texels: Vec<[f32; 4]> = (0..15).map(|i| [i as f32, 2.0 * i as f32, 1.0, 1.0]).collect();
    let table = decode(&hdr(5, 3, texels)).unwrap();
    let fours: Vec<&[f32]> = table.chunks(4).collect();
    assert_eq!(fours[0], [5.0, 3.0, 3.0, 0.0]);
    assert_eq!(fours[1..4], [[5.0, 3.0, 4.0, 0.0], [2.0, 1.0, 19.0, 0.0], [1.0, 1.0, 21.0, 0.0]]);
    assert_eq!(fours.len(), 22);
    assert_eq!(fours[4 + 7], [7.0, 14.0, 1.0, 0.0]);
    // Columns 0, 1 and half of 2, in all rows: the mean is 5 + 0.8.
    for (got, expected) in fours[19].iter().zip([5.8, 11.6, 1.0, 0.0]) {
        assert!((got - expected).abs() < 1e-5, "{got}, not {expected}");
    }
    for (got, expected) in fours[21].iter().zip([7.0, 14.0, 1.0, 0.0]) {
        assert!((got - expected).abs() < 1e-5, "{got}, not {expected}");
    }
}

/// Catches code values taken for light, transparent texels that shine, and light below 0.
#[test]
fn texels_are_light() {
    let table = decode(&encode_png(2, 1, &[255, 188, 0, 255, 255, 255, 255, 0]).unwrap()).unwrap();
    assert_eq!(table[12], 1.0);
    assert!((table[13] - 0.502_886).abs() < 1e-5, "{}", table[13]);
    assert_eq!(table[14..20], [0.0; 6]);
    let table = decode(&hdr(1, 1, vec![[-1.0, 1e6, 0.5, 0.0]])).unwrap();
    assert_eq!(table[8..], [0.0, 1e6, 0.5, 0.0]);
}

/// Catches pictures that a buffer cannot hold, and numbers that a light cannot have, refused without their place.
#[test]
fn bad_pictures_say_why() {
    let refused = |bytes: &[u8]| decode(bytes).unwrap_err();
    let mut texels = vec![[0.5; 4]; 6];
    texels[4][1] = f32::NAN;
    assert_eq!(
        refused(&hdr(3, 2, texels.clone())),
        "NaN in the texel 1 from the left and 1 from the top: at most 1000000 is taken"
    );
    texels[4][1] = 2e6;
    assert_eq!(
        refused(&hdr(3, 2, texels)),
        "2000000 in the texel 1 from the left and 1 from the top: at most 1000000 is taken"
    );
    assert_eq!(
        refused(&encode_png(4097, 1, &[9; 4 * 4097]).unwrap()),
        "4097 x 1 texels, more than 4096 a side or 4194304 in all"
    );
    assert_eq!(refused(b""), "cannot be decoded: neither PNG nor JPEG");
    assert_eq!(refused(b"GIF89a"), "cannot be decoded: neither PNG nor JPEG");
    assert!(refused(&EXR).starts_with("cannot be decoded: "));
}

/// What any bytes may do: be a table that a shader can rely on, or be refused.
fn survives(bytes: &[u8]) {
    let Ok(table) = decode(bytes) else { return };
    let (width, height, count) = (table[0], table[1], table[2] as usize);
    assert!(width >= 1.0 && height >= 1.0 && count >= 1);
    let mut next = 1 + count;
    for level in table[4..].chunks(4).take(count) {
        assert_eq!(level[2], next as f32);
        next += (level[0] * level[1]) as usize;
    }
    assert_eq!(table.len(), 4 * next);
    assert_eq!(table[4 * count..4 * count + 2], [1.0, 1.0]);
    assert!(table.iter().all(|number| (0.0..=1e7).contains(number)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Catches panics, and a header that is believed before it is bounded.
    #[test]
    fn damage_never_panics(
        is_exr in any::<bool>(), (width, height) in (1u32..9, 1u32..9), cut in 0usize..1000, at in 0usize..1000, byte in any::<u8>(),
    ) {
        let texels = (width * height) as usize;
        let base = if is_exr {
            hdr(width, height, vec![[0.5, 7.0, 1e-3, 1.0]; texels])
        } else {
            encode_png(width, height, &vec![77; 4 * texels]).unwrap()
        };
        survives(&base);
        survives(&base[..cut.min(base.len())]);
        let mut flipped = base;
        let index = at % flipped.len();
        flipped[index] = byte;
        survives(&flipped);
    }

    /// Catches bytes that nobody thought of.
    #[test]
    fn noise_never_panics(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        survives(&bytes);
        survives(&[EXR.as_slice(), &bytes].concat());
        survives(&[b"\x89PNG\r\n\x1a\n".as_slice(), &bytes].concat());
    }
}
