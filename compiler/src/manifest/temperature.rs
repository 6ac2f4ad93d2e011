//! Colours of black bodies and of daylight.

use super::observer::{FIRST, MATCHING, STEP};

/// Colour temperatures of a black body that are taken, in kelvin.
pub const KELVIN: std::ops::RangeInclusive<f64> = 1000.0..=40000.0;

/// Correlated colour temperatures of daylight that are taken, in kelvin: those for which the CIE defines it.
pub const DAYLIGHT: std::ops::RangeInclusive<f64> = 4000.0..=25000.0;

/// Linear Rec.709 colour of a black body of this temperature in kelvin, scaled to luminance 1; `None` outside [`KELVIN`].
///
/// Planck's law is summed over the tabulated CIE 1931 observer from 360 to 830 nm in steps of 5 nm, which is the sum over the table of 1 nm to 2.3e-5 of
/// the largest channel at any temperature. Below about 1900 K the colour lies outside the gamut: blue would be negative, is set to 0, and luminance is restored.
pub fn black_body(kelvin: f64) -> Option<[f64; 3]> {
    if !KELVIN.contains(&kelvin) {
        return None;
    }
    let mut xyz = [0.0; 3];
    for (row, matching) in MATCHING.iter().enumerate() {
        let power = planck((FIRST + STEP * row as f64) * 1e-9, kelvin);
        for (sum, matching) in xyz.iter_mut().zip(matching) {
            *sum += power * matching;
        }
    }
    Some(linear_of(xyz))
}

/// Linear Rec.709 colour of daylight of this correlated colour temperature in kelvin, scaled to luminance 1; `None` outside [`DAYLIGHT`].
///
/// The chromaticity is that of the CIE's daylight locus (CIE 15:2004, eqs. 3.3 and 3.4; Judd, MacAdam and Wyszecki 1964), a little greener than the black
/// body's: 6504 K is D65, the white of Rec.709. It lies in the gamut at all temperatures.
pub fn daylight(kelvin: f64) -> Option<[f64; 3]> {
    if !DAYLIGHT.contains(&kelvin) {
        return None;
    }
    let t = 1000.0 / kelvin;
    let x = if kelvin <= 7000.0 {
        0.244_063 + t * (0.099_11 + t * (2.967_8 - t * 4.607_0))
    } else {
        0.237_040 + t * (0.247_48 + t * (1.901_8 - t * 2.006_4))
    };
    let y = -0.275 + x * (2.870 - x * 3.000);
    Some(linear_of([x, y, 1.0 - x - y]))
}

/// Linear Rec.709 of a CIE XYZ colour, at luminance 1. What is negative, outside the gamut, is 0.
fn linear_of(xyz: [f64; 3]) -> [f64; 3] {
    // Rec. ITU-R BT.709 primaries, white D65.
    let rows = [
        [3.240_454_2, -1.537_138_5, -0.498_531_4],
        [-0.969_266_0, 1.876_010_8, 0.041_556_0],
        [0.055_643_4, -0.204_025_9, 1.057_225_2],
    ];
    let rgb = rows.map(|row| row.iter().zip(xyz).map(|(a, b)| a * b).sum::<f64>().max(0.0));
    let luminance = 0.212_672_9 * rgb[0] + 0.715_152_2 * rgb[1] + 0.072_175_0 * rgb[2];
    rgb.map(|channel| channel / luminance)
}

/// Spectral radiance of a black body up to a constant factor (Planck's law), at a wavelength in metres.
fn planck(wavelength: f64, kelvin: f64) -> f64 {
    /// Second radiation constant h c / k, in metre kelvin.
    const C2: f64 = 1.438_776_877e-2;
    // Scaled by 1e-35 so that the sums stay near 1.
    1e-35 / (wavelength.powi(5) * (C2 / (wavelength * kelvin)).exp_m1())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f64; 3], expected: [f64; 3], error: f64) {
        let largest = expected.iter().copied().fold(0.0, f64::max);
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < error * largest, "{found} is not {expected}");
        }
    }

    /// Catches a wrong row, constant or matrix: colours from the observer's table at every nanometre, computed elsewhere.
    #[test]
    fn black_bodies() {
        near(black_body(2856.0).unwrap(), [1.844_835_2, 0.826_124_2, 0.233_446_61], 5e-5);
        near(black_body(1000.0).unwrap(), [4.569_754_93, 0.039_344_03, 0.0], 5e-5);
        near(black_body(2000.0).unwrap(), [2.519_870_15, 0.646_879_69, 0.020_429_18], 5e-5);
        near(black_body(6500.0).unwrap(), [1.043_217_36, 0.983_593_24, 1.035_220_95], 5e-5);
        near(black_body(40000.0).unwrap(), [0.701_164_79, 0.983_187_62, 2.047_141_84], 5e-5);
    }

    /// Catches a colour that is not scaled to luminance 1, is negative, or does not turn from red to blue.
    #[test]
    fn whole_domain() {
        for (locus, domain) in [(black_body as fn(f64) -> _, KELVIN), (daylight, DAYLIGHT)] {
            let mut before = f64::INFINITY;
            let mut kelvin = *domain.start();
            while kelvin <= *domain.end() {
                let [r, g, b]: [f64; 3] = locus(kelvin).unwrap();
                assert!((0.212_672_9 * r + 0.715_152_2 * g + 0.072_175_0 * b - 1.0).abs() < 1e-12);
                assert!(r > 0.0 && g > 0.0 && b >= 0.0);
                assert!(r / (b + 1e-9) < before || b == 0.0, "{kelvin}");
                before = r / (b + 1e-9);
                kelvin += 250.0;
            }
            assert!(locus(domain.start() - 1.0).is_none() && locus(domain.end() + 1.0).is_none() && locus(f64::NAN).is_none());
        }
        assert_eq!(black_body(1000.0).unwrap()[2], 0.0);
    }

    /// Catches swapped branches or a wrong coefficient: the CIE's own chromaticities of its illuminants, and where the branches meet.
    #[test]
    fn daylight_illuminants() {
        let of = |x: f64, y: f64| linear_of([x, y, 1.0 - x - y]);
        near(daylight(6504.0).unwrap(), [1.0; 3], 1e-3);
        near(daylight(5003.0).unwrap(), of(0.345_67, 0.358_50), 1e-3);
        near(daylight(7504.0).unwrap(), of(0.299_02, 0.314_85), 1e-3);
        near(daylight(7000.0).unwrap(), daylight(7_000.000_1).unwrap(), 5e-4);
    }
}
