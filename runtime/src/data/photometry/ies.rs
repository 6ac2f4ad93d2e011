//! IES LM-63 of 1986, 1991, 1995, 2002 and 2019.

use super::text::{Text, increasing, intensities, wrong};
use super::{MAX_ANGLES, MAX_INTENSITIES, Photometry, PhotometryError, Planes, Pole};

/// Metres of a foot.
const FOOT: f64 = 0.3048;

pub(super) fn read(text: &Text) -> Result<Photometry, PhotometryError> {
    let Some((tilt_line, tilt)) = text.tilt() else {
        return Err(wrong(text.end(), "the file ends before a line `TILT=NONE`"));
    };
    if tilt != "NONE" {
        let message = format!("`TILT={}`: only `TILT=NONE` is taken", tilt.chars().take(24).collect::<String>());
        return Err(wrong(tilt_line, message));
    }
    // LM-63 of 1986 has no first line of its own, that of 1991 says IESNA91.
    let first = text.line(1).unwrap_or_default();
    let early = !first.starts_with("IES") || first.starts_with("IESNA91");

    let mut numbers = text.numbers_after(tilt_line);
    let lamps = numbers.next("the number of lamps")?.count("the number of lamps", 1, 1_000_000)?;
    let lumens = numbers.next("the lumens of a lamp")?;
    // -1 says that the intensities are absolute.
    lumens.within("the lumens of a lamp", -1.0, 1e12)?;
    let multiplier = numbers.next("the multiplier")?.within("the multiplier", 0.0, 1e12)?;
    let vertical = numbers
        .next("the number of vertical angles")?
        .count("the number of vertical angles", 2, MAX_ANGLES)?;
    let count = numbers.next("the number of horizontal angles")?;
    let horizontal = count.count("the number of horizontal angles", 1, MAX_ANGLES)?;
    if vertical * horizontal > MAX_INTENSITIES {
        return Err(count.wrong(format!("{vertical} times {horizontal} angles are more than {MAX_INTENSITIES}")));
    }
    let kind = numbers.next("the photometric type")?;
    let pole = match kind.count("the photometric type", 1, 3)? {
        1 => Pole::Direction,
        2 => Pole::Left,
        _ => Pole::Down,
    };
    let unit = match numbers.next("the unit of lengths")?.count("the unit of lengths", 1, 2)? {
        1 => FOOT,
        _ => 1.0,
    };
    let mut opening = [0.0; 3];
    for (extent, what) in opening.iter_mut().zip(["the width", "the length", "the height"]) {
        // A negative extent says that the opening is round.
        *extent = numbers.next(what)?.within(what, -1e4, 1e4)?.abs() * unit;
    }
    let ballast = numbers.next("the ballast factor")?.within("the ballast factor", 0.0, 1e6)?;
    let second = numbers.next("the ballast-lamp photometric factor")?;
    numbers.next("the input watts")?;
    // Since 1995 this number is reserved, and since 2019 it says how the file was made.
    let second = if early {
        second.within("the ballast-lamp photometric factor", 0.0, 1e6)?
    } else {
        1.0
    };
    let factor = multiplier * ballast * second;

    let vertical = numbers.list(vertical, "vertical angle")?;
    let horizontal = numbers.list(horizontal, "horizontal angle")?;
    let mut rows = Vec::with_capacity(horizontal.len());
    for at in &horizontal {
        let row = numbers.list(vertical.len(), &format!("in the plane of {} degrees, intensity", at.value))?;
        rows.push(intensities(&row, factor)?);
    }
    let (polar, azimuth, candela) = if pole == Pole::Direction {
        type_c(&increasing(&vertical, "a vertical angle", 0.0, 180.0)?, &horizontal, rows)?
    } else {
        let vertical = increasing(&vertical, "a vertical angle", -90.0, 90.0)?;
        type_a_or_b(pole, vertical, &horizontal, rows)?
    };
    Ok(Photometry {
        pole,
        polar,
        azimuth,
        candela,
        lamps: (lumens.value >= 0.0).then_some(lumens.value * lamps as f64),
        opening,
    })
}

type Grid = (Vec<f64>, Vec<f64>, Vec<f64>);

/// Planes through the vertical axis. Where they end says which of them are repeated: at 0 the one is for all, at 90 a quadrant for all four, at 180 a
/// half for both; from 90 to 270 the half that has no plane of 0. Beyond, nothing is repeated.
fn type_c(polar: &[f64], horizontal: &[super::text::Number], rows: Vec<Vec<f64>>) -> Result<Grid, PhotometryError> {
    let angles = increasing(horizontal, "a horizontal angle", 0.0, 360.0)?;
    let (first, last) = (angles[0], angles[angles.len() - 1]);
    let planes = Planes {
        polar: polar.to_vec(),
        planes: angles.iter().copied().zip(rows).collect(),
    };
    let ends = |a: f64, b: f64| first == a && last == b;
    let whole = if ends(0.0, 0.0) {
        planes
    } else if ends(0.0, 90.0) {
        planes.mirrored(90.0).mirrored(0.0)
    } else if ends(0.0, 180.0) {
        planes.mirrored(0.0)
    } else if ends(90.0, 270.0) {
        planes.mirrored(90.0)
    } else if first == 0.0 && last > 180.0 {
        planes
    } else {
        let found = format!("the horizontal angles go from {first} to {last}");
        return Err(horizontal[0].wrong(format!("{found}, not from 0 to 0, 90, 180 or beyond, or from 90 to 270")));
    };
    Ok(whole.closed())
}

/// Angles around the direction of the beam. Horizontal ones from 0 on are for both sides.
fn type_a_or_b(
    pole: Pole,
    vertical: Vec<f64>,
    horizontal: &[super::text::Number],
    mut rows: Vec<Vec<f64>>,
) -> Result<Grid, PhotometryError> {
    let mut angles = increasing(horizontal, "a horizontal angle", -90.0, 90.0)?;
    if angles[0] == 0.0 {
        for index in 1..rows.len() {
            // The images before what is there, the farthest first.
            let image = rows[2 * index - 1].clone();
            angles.insert(0, -angles[2 * index - 1]);
            rows.insert(0, image);
        }
    }
    if angles.len() < 2 {
        return Err(horizontal[0].wrong("types A and B need two horizontal angles at least"));
    }
    let raised = |angles: Vec<f64>| angles.into_iter().map(|angle| angle + 90.0).collect();
    let planes = if pole == Pole::Down {
        Planes {
            polar: raised(vertical),
            planes: angles.into_iter().zip(rows).collect(),
        }
    } else {
        // Here the vertical angles go around the pole.
        let column = |index: usize| rows.iter().map(|row| row[index]).collect();
        Planes {
            planes: vertical.iter().enumerate().map(|(index, angle)| (*angle, column(index))).collect(),
            polar: raised(angles),
        }
    };
    Ok(planes.open())
}
