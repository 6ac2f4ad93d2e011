//! Colours: few with a role, which the page changes in the dark, and a scale.

/// A colour by its role. The values are for white paper; each is another, so that the page can give the role other ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Colour {
    /// Behind everything.
    Paper,
    /// Text.
    Ink,
    /// Text that matters less.
    Faint,
    /// Lines of the grid.
    Grid,
    /// Axes.
    Axis,
    /// What nothing dominates.
    Frontier,
    /// What something dominates.
    Dominated,
    /// What has faults.
    Fault,
    /// Around a place in a heat map, the same in the dark.
    Light,
    /// Around that.
    Dark,
}

impl Colour {
    /// Those that the page changes.
    pub const THEMED: [Colour; 8] = [
        Colour::Paper,
        Colour::Ink,
        Colour::Faint,
        Colour::Grid,
        Colour::Axis,
        Colour::Frontier,
        Colour::Dominated,
        Colour::Fault,
    ];

    /// sRGB, 8 bits each.
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Colour::Paper => [0xff, 0xff, 0xff],
            Colour::Ink => [0x1c, 0x22, 0x2b],
            Colour::Faint => [0x5a, 0x65, 0x72],
            Colour::Grid => [0xe6, 0xe9, 0xed],
            Colour::Axis => [0xa8, 0xb0, 0xba],
            Colour::Frontier => [0x0b, 0x5f, 0xc1],
            Colour::Dominated => [0x93, 0x9c, 0xa7],
            Colour::Fault => [0xcf, 0x3a, 0x17],
            Colour::Light => [0xfe, 0xfe, 0xfe],
            Colour::Dark => [0x01, 0x01, 0x01],
        }
    }

    /// As the SVG has it: `#0B5FC1`.
    pub fn hex(self) -> String {
        let [r, g, b] = self.rgb();
        format!("#{r:02X}{g:02X}{b:02X}")
    }

    /// Name of the page's variable.
    pub fn variable(self) -> &'static str {
        match self {
            Colour::Paper => "paper",
            Colour::Ink => "ink",
            Colour::Faint => "faint",
            Colour::Grid => "grid",
            Colour::Axis => "axis",
            Colour::Frontier => "frontier",
            Colour::Dominated => "dominated",
            Colour::Fault => "fault",
            Colour::Light => "light",
            Colour::Dark => "dark",
        }
    }
}

/// Where an error is exactly 0: below the scale.
pub const ZERO: [u8; 3] = [0, 0, 0];
/// Where a value is not finite: in no scale.
pub const NOT_FINITE: [u8; 3] = [0xe0, 0x2d, 0x3c];

/// The scale viridis (Smith and van der Walt 2015, CC0): equal steps look equally far apart, and it is as good in grey and to the colour-blind.
/// By the polynomial that Zucker 2019 ("matplotlib colormaps", CC0) fitted to its table; within 4/255 of it. `at` is clamped to 0 to 1.
pub fn viridis(at: f64) -> [u8; 3] {
    // From the highest power down, red, green and blue.
    const COEFFICIENTS: [[f64; 3]; 7] = [
        [-5.435_455_855_934_631, 4.645_852_612_178_535, 26.312_435_249_583_2],
        [4.776_384_997_670_288, -13.745_145_377_746_01, -65.353_032_633_372_34],
        [6.228_269_936_347_081, 14.179_933_366_805_09, 56.690_552_600_681_05],
        [-4.634_230_498_983_486, -5.799_100_973_351_585, -19.332_440_956_279_87],
        [-0.330_861_828_725_556_3, 0.214_847_559_468_213, 0.095_095_163_028_236_59],
        [0.105_093_043_108_577_4, 1.404_613_529_898_575, 1.384_590_162_594_685],
        [0.277_727_327_223_417_7, 0.005_407_344_544_966_578, 0.334_099_805_335_306_1],
    ];
    let at = if at.is_nan() { 0.0 } else { at.clamp(0.0, 1.0) };
    std::array::from_fn(|channel| {
        let value = COEFFICIENTS.iter().fold(0.0, |sum, powers| sum * at + powers[channel]);
        // The cast saturates, and the value is in range but for the fit's error.
        (value * 255.0).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a mistyped coefficient. The expected values are the table's at eighths.
    #[test]
    fn viridis_is_viridis() {
        let table = [
            [68, 1, 84],
            [71, 44, 122],
            [59, 81, 139],
            [44, 113, 142],
            [33, 144, 141],
            [39, 173, 129],
            [92, 200, 99],
            [170, 220, 50],
            [253, 231, 37],
        ];
        for (index, expected) in table.into_iter().enumerate() {
            let found = viridis(index as f64 / 8.0);
            let off = (0..3).map(|channel| i32::from(found[channel]).abs_diff(expected[channel])).max();
            assert!(off <= Some(4), "{index}/8: {found:?}, not {expected:?}");
        }
        assert_eq!(viridis(-1.0), viridis(0.0));
        assert_eq!(viridis(2.0), viridis(1.0));
    }

    /// Catches a scale that is not brighter where the error is larger.
    #[test]
    fn brighter_is_more() {
        let luminance = |[r, g, b]: [u8; 3]| 0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b);
        let scale: Vec<f64> = (0..=100).map(|step| luminance(viridis(f64::from(step) / 100.0))).collect();
        assert!(scale.is_sorted(), "{scale:?}");
        assert!(luminance(ZERO) < scale[0]);
    }

    /// Catches two roles with one colour, which the page could not tell apart in the dark.
    #[test]
    fn roles_have_colours_of_their_own() {
        let hex: std::collections::BTreeSet<String> = Colour::THEMED.iter().map(|colour| colour.hex()).collect();
        assert_eq!(hex.len(), Colour::THEMED.len());
        assert!(!hex.contains(&Colour::Light.hex()) && !hex.contains(&Colour::Dark.hex()));
    }
}
