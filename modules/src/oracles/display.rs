//! From scene luminance to display values.

use glam::DVec3;

/// Luminance of linear Rec.709. ITU-R BT.709.
pub fn luminance(c: DVec3) -> f64 {
    c.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Exposure value at ISO 100 of an aperture number, a shutter time in s and a sensitivity.
pub fn ev100(aperture: f64, shutter: f64, iso: f64) -> f64 {
    (aperture * aperture / shutter * 100.0 / iso).log2()
}

/// Luminance that saturates the sensor, cd/m2. Lagarde and de Rousiers 2014, after ISO 12232.
pub fn saturation_luminance(ev100: f64) -> f64 {
    78.0 / (100.0 * 0.65) * 2f64.powf(ev100)
}

/// Reinhard et al. 2002, eq. 4.
pub fn reinhard_extended(l: f64, white: f64) -> f64 {
    l * (1.0 + l / (white * white)) / (1.0 + l)
}

/// Reinhard's operator on the luminance of a colour, the colour scaled along.
pub fn reinhard_color(c: DVec3, white: f64) -> DVec3 {
    let c = c.max(DVec3::ZERO);
    let l = luminance(c);
    if l == 0.0 {
        DVec3::ZERO
    } else {
        c * (reinhard_extended(l, white) / l)
    }
}

/// IEC 61966-2-1:1999, linear to encoded.
pub fn srgb_encode(c: f64) -> f64 {
    if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

/// IEC 61966-2-1:1999, encoded to linear.
pub fn srgb_decode(c: f64) -> f64 {
    if c <= 0.040_45 {
        c / 12.92
    } else {
        ((c + 0.055) / 1.055).powf(2.4)
    }
}

/// Logarithmic mean of luminances. Reinhard et al. 2002, eq. 1, with the division inside the exponential.
pub fn log_average(luminances: &[f64], delta: f64) -> f64 {
    let sum: f64 = luminances.iter().map(|l| (delta + l).ln()).sum();
    (sum / luminances.len() as f64).exp()
}
