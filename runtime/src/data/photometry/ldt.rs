//! EULUMDAT: one value on each line, in a fixed order.

use super::text::{Text, increasing, intensities, wrong};
use super::{MAX_ANGLES, MAX_INTENSITIES, Photometry, PhotometryError, Planes, Pole};

/// Lines of the fields, counted from 1.
const SYMMETRY: usize = 3;
const PLANES: usize = 4;
const ANGLES: usize = 6;
const OPENING: [usize; 3] = [16, 17, 18];
const CONVERSION: usize = 24;
const LAMP_SETS: usize = 26;
/// Lines of a set of lamps, of which the first and the third are its number of lamps and their flux.
const SET: usize = 6;
/// Direct ratios of ten room indices stand between the lamps and the angles.
const RATIOS: usize = 10;

pub(super) fn read(text: &Text) -> Result<Photometry, PhotometryError> {
    let symmetry = text.number(SYMMETRY, "the symmetry")?.count("the symmetry", 0, 4)?;
    let planes = text.number(PLANES, "the number of C planes")?;
    let count = planes.count("the number of C planes", 1, MAX_ANGLES)?;
    let angles = text
        .number(ANGLES, "the number of intensities")?
        .count("the number of intensities", 2, MAX_ANGLES)?;
    if count * angles > MAX_INTENSITIES {
        return Err(planes.wrong(format!("{count} planes of {angles} intensities are more than {MAX_INTENSITIES}")));
    }
    // Which of the planes have intensities: all; the first, for all; the half from 0 to 180; that from 270 over 0 to 90; the quadrant from 0 to 90.
    let divided = |by: usize| {
        if count.is_multiple_of(by) {
            Ok(count / by)
        } else {
            Err(wrong(
                PLANES,
                format!("{count} C planes cannot have the symmetry {symmetry}: no multiple of {by}"),
            ))
        }
    };
    let given: Vec<usize> = match symmetry {
        0 => (0..count).collect(),
        1 => vec![0],
        2 => (0..=divided(2)?).collect(),
        3 => (3 * divided(4)?..=3 * divided(4)? + count / 2).collect(),
        _ => (0..=divided(4)?).collect(),
    };
    let conversion = text
        .number(CONVERSION, "the conversion factor")?
        .within("the conversion factor", 0.0, 1e12)?;
    let sets = text
        .number(LAMP_SETS, "the number of lamp sets")?
        .count("the number of lamp sets", 1, 20)?;
    // Further sets are alternatives to the first.
    let lamps = text.number(LAMP_SETS + 1, "the number of lamps")?;
    lamps.within("the number of lamps", -1e6, 1e6)?;
    let flux = text
        .number(LAMP_SETS + 3, "the lamps' flux")?
        .within("the lamps' flux", 0.0, 1e12)?;
    let mut opening = [0.0; 3];
    for (extent, (line, what)) in opening
        .iter_mut()
        .zip(OPENING.into_iter().zip(["the length", "the width", "the height"]))
    {
        // Millimetres; a width of 0 says that the opening is round.
        *extent = text.number(line, what)?.within(what, 0.0, 1e7)? / 1000.0;
    }

    let mut line = LAMP_SETS + SET * sets + RATIOS;
    let mut list = |count: usize, what: &str| -> Result<Vec<_>, PhotometryError> {
        let mut numbers = Vec::new();
        for index in 1..=count {
            line += 1;
            numbers.push(text.number(line, &format!("{what} {index} of {count}"))?);
        }
        Ok(numbers)
    };
    let all = list(count, "angle of a C plane")?;
    let polar = increasing(&list(angles, "angle")?, "an angle", 0.0, 180.0)?;
    let azimuth = increasing(&all, "the angle of a C plane", 0.0, 360.0)?;
    let factor = conversion * flux / 1000.0;
    let mut rows = Vec::new();
    for index in given {
        let turn = azimuth.get(index % count).copied().unwrap_or_default();
        let row = list(angles, &format!("in the C plane of {turn} degrees, intensity"))?;
        rows.push((turn, intensities(&row, factor)?));
    }
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mirrors: &[f64] = match symmetry {
        2 => &[0.0],
        3 => &[90.0],
        4 => &[90.0, 0.0],
        _ => &[],
    };
    let mut whole = Planes { polar, planes: rows };
    for at in mirrors {
        whole = whole.mirrored(*at);
    }
    let (polar, azimuth, candela) = whole.closed();
    Ok(Photometry {
        pole: Pole::Direction,
        polar,
        azimuth,
        candela,
        lamps: (lamps.value >= 0.0).then_some(flux),
        opening,
    })
}
