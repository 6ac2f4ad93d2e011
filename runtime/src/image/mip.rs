//! Smaller levels of textures.

use crate::frame::Texture;

/// sRGB code value in [0, 1] to linear (IEC 61966-2-1).
pub fn srgb_to_linear(c: f32) -> f32 {
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// Linear value in [0, 1] to sRGB code value (IEC 61966-2-1).
pub fn linear_to_srgb(c: f32) -> f32 {
    if c <= 0.003_130_8 {
        c * 12.92
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    }
}

/// All levels of a texture, the given one first, down to one texel; each side is half of the one before, rounded down, as GPUs have it.
/// A texel is the mean of what it covers, with fractional weights where a side was odd. With `srgb`, red, green and blue are averaged as
/// light, not as code values.
pub fn mip_levels(texture: &Texture, srgb: bool) -> Vec<Texture> {
    let mut levels = vec![texture.clone()];
    if texture.width == 0 || texture.height == 0 || texture.rgba.len() as u64 != u64::from(texture.width) * u64::from(texture.height) * 4 {
        return levels;
    }
    let decode: Vec<f32> = (0..=255u8)
        .map(|c| {
            let c = f32::from(c) / 255.0;
            if srgb { srgb_to_linear(c) } else { c }
        })
        .collect();
    // Kept as floats from level to level, so that rounding doesn't add up.
    let (mut w, mut h) = (texture.width as usize, texture.height as usize);
    let mut texels: Vec<[f32; 4]> = texture
        .rgba
        .chunks_exact(4)
        .map(|t| {
            [
                decode[usize::from(t[0])],
                decode[usize::from(t[1])],
                decode[usize::from(t[2])],
                f32::from(t[3]) / 255.0,
            ]
        })
        .collect();
    while w > 1 || h > 1 {
        (w, h, texels) = halved(w, h, &texels);
        let code = |c: f32| (if srgb { linear_to_srgb(c) } else { c } * 255.0).round() as u8;
        levels.push(Texture {
            width: w as u32,
            height: h as u32,
            rgba: texels
                .iter()
                .flat_map(|t| [code(t[0]), code(t[1]), code(t[2]), (t[3] * 255.0).round() as u8])
                .collect(),
        });
    }
    levels
}

/// Width, height and texels of the next smaller level: sides halved and rounded down, a texel the mean of what it covers.
pub(crate) fn halved(w: usize, h: usize, texels: &[[f32; 4]]) -> (usize, usize, Vec<[f32; 4]>) {
    let (nw, nh) = ((w / 2).max(1), (h / 2).max(1));
    let (columns, rows) = (weights(w, nw), weights(h, nh));
    let mut smaller = Vec::with_capacity(nw * nh);
    for row in &rows {
        for column in &columns {
            let mut sum = [0.0f32; 4];
            for &(y, wy) in row {
                for &(x, wx) in column {
                    for (s, t) in sum.iter_mut().zip(texels[y * w + x]) {
                        *s += wx * wy * t;
                    }
                }
            }
            smaller.push(sum);
        }
    }
    (nw, nh, smaller)
}

/// For each of `to` new texels in a line, the old ones of `from` that it covers, and the share of each.
fn weights(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let width = from as f32 / to as f32;
    (0..to)
        .map(|i| {
            let (start, end) = (i as f32 * width, (i + 1) as f32 * width);
            (start as usize..(end.ceil() as usize).min(from))
                .map(|x| (x, ((x + 1) as f32).min(end) - (x as f32).max(start)))
                .filter(|&(_, share)| share > 0.0)
                .map(|(x, share)| (x, share / width))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(width: u32, height: u32, values: &[u8]) -> Texture {
        Texture {
            width,
            height,
            rgba: values.iter().flat_map(|&v| [v, v, v, v]).collect(),
        }
    }

    /// Catches averaging of code values, on either side of the curve: half black and half white is linear .5, code 188, not 128;
    /// codes 10 and 200 are .003035 and .577580, their mean is code 147. Alpha stays linear.
    #[test]
    fn averages_light() {
        let levels = mip_levels(&grey(2, 1, &[0, 255]), true);
        assert_eq!(levels.len(), 2);
        assert_eq!(levels[1].rgba, [188, 188, 188, 128]);
        assert_eq!(mip_levels(&grey(2, 1, &[10, 200]), true)[1].rgba, [147, 147, 147, 105]);
        let levels = mip_levels(&grey(2, 1, &[0, 255]), false);
        assert_eq!(levels[1].rgba, [128, 128, 128, 128]);
    }

    /// Catches a last column or row dropped where a side is odd, and a chain that stops early.
    #[test]
    fn odd_sides_keep_their_mean() {
        let levels = mip_levels(&grey(3, 5, &[0, 0, 90, 0, 0, 90, 0, 0, 90, 0, 0, 90, 0, 0, 90]), false);
        assert_eq!(
            levels.iter().map(|l| (l.width, l.height)).collect::<Vec<_>>(),
            [(3, 5), (1, 2), (1, 1)]
        );
        assert!(levels[1].rgba.iter().chain(&levels[2].rgba).all(|&c| c == 30));
        // A damaged texture is handed on for whoever uploads it to refuse.
        assert_eq!(
            mip_levels(
                &Texture {
                    width: 2,
                    height: 2,
                    rgba: vec![0; 3]
                },
                true
            )
            .len(),
            1
        );
    }

    /// Oracle values: code .5 is linear .214041140, linear .18 is code .461356130.
    #[test]
    fn srgb_curve() {
        assert!((srgb_to_linear(0.5) - 0.214_041_14).abs() < 1e-6);
        assert!((linear_to_srgb(0.18) - 0.461_356_13).abs() < 1e-6);
    }
}
