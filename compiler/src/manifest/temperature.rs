//! Colour of a black body.

/// Colour temperatures that are taken, in kelvin.
pub const KELVIN: std::ops::RangeInclusive<f64> = 1000.0..=40000.0;

/// Linear Rec.709 colour of a black body of this temperature in kelvin, scaled to luminance 1; `None` outside [`KELVIN`].
///
/// Planck's law is integrated from 360 to 830 nm in steps of 5 nm against the analytic fit of the CIE 1931 colour matching
/// functions by Wyman, Sloan and Shirley 2013 (multi-lobe form). Against the tabulated observer the fit moves the chromaticity
/// of 2856 K by (-1.2e-3, 1.1e-3) in (x, y), which is 1.0 %, 0.7 % and 0.5 % of its red, green and blue.
/// Below about 1900 K the colour lies outside the gamut: blue would be negative, is set to 0, and luminance is restored.
pub fn black_body(kelvin: f64) -> Option<[f64; 3]> {
    if !KELVIN.contains(&kelvin) {
        return None;
    }
    let mut xyz = [0.0; 3];
    for step in 0..=94 {
        let nanometres = 360.0 + 5.0 * f64::from(step);
        let power = planck(nanometres * 1e-9, kelvin);
        for (sum, matching) in xyz.iter_mut().zip(matching(nanometres)) {
            *sum += power * matching;
        }
    }
    // Rec. ITU-R BT.709 primaries, white D65.
    let rows = [
        [3.240_454_2, -1.537_138_5, -0.498_531_4],
        [-0.969_266_0, 1.876_010_8, 0.041_556_0],
        [0.055_643_4, -0.204_025_9, 1.057_225_2],
    ];
    let rgb = rows.map(|row| row.iter().zip(xyz).map(|(a, b)| a * b).sum::<f64>().max(0.0));
    let luminance = 0.212_672_9 * rgb[0] + 0.715_152_2 * rgb[1] + 0.072_175_0 * rgb[2];
    Some(rgb.map(|channel| channel / luminance))
}

/// Spectral radiance of a black body up to a constant factor (Planck's law), at a wavelength in metres.
fn planck(wavelength: f64, kelvin: f64) -> f64 {
    /// Second radiation constant h c / k, in metre kelvin.
    const C2: f64 = 1.438_776_877e-2;
    // Scaled by 1e-35 so that the sums stay near 1.
    1e-35 / (wavelength.powi(5) * (C2 / (wavelength * kelvin)).exp_m1())
}

/// The CIE 1931 colour matching functions as fitted by Wyman, Sloan and Shirley 2013, equation 4 and its kin.
fn matching(nanometres: f64) -> [f64; 3] {
    let lobe = |mean: f64, below: f64, above: f64| {
        let width = if nanometres < mean { below } else { above };
        (-0.5 * ((nanometres - mean) / width).powi(2)).exp()
    };
    [
        1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
        0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
        1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a wrong lobe, constant or matrix: illuminant A's colour from the tabulated observer, within the fit's error.
    #[test]
    fn illuminant_a() {
        let found = black_body(2856.0).unwrap();
        for (channel, (expected, error)) in [(1.8448, 0.0100), (0.8261, 0.0070), (0.2334, 0.0050)].into_iter().enumerate() {
            let relative = (found[channel] / expected - 1.0).abs();
            assert!(relative < error, "{channel}: {} is off by {relative}", found[channel]);
        }
    }

    /// Catches a colour that is not scaled to luminance 1, is negative, or does not turn from red to blue.
    #[test]
    fn whole_domain() {
        let mut before = f64::INFINITY;
        for kelvin in (1000..=40000).step_by(250) {
            let [r, g, b] = black_body(f64::from(kelvin)).unwrap();
            assert!((0.212_672_9 * r + 0.715_152_2 * g + 0.072_175_0 * b - 1.0).abs() < 1e-12);
            assert!(r > 0.0 && g > 0.0 && b >= 0.0);
            assert!(r / (b + 1e-9) < before || b == 0.0, "{kelvin}");
            before = r / (b + 1e-9);
        }
        assert_eq!(black_body(1000.0).unwrap()[2], 0.0);
        assert!(black_body(999.0).is_none() && black_body(40001.0).is_none() && black_body(f64::NAN).is_none());
    }

    /// Catches a white that is far from white: 6504 K lies on the locus near D65.
    #[test]
    fn daylight_is_nearly_white() {
        assert!(black_body(6504.0).unwrap().iter().all(|channel| (channel - 1.0).abs() < 0.06));
    }
}
