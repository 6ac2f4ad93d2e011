//! Textures in memory: what a shader can read of them without derivatives.

use crate::error::EvaluateError;

/// A texture of 32-bit floats: 2D, layered, or a cube with six layers each. A texture of integers or depth has its numbers as floats.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    width: u32,
    height: u32,
    layers: u32,
    channels: u32,
    levels: Vec<Vec<f32>>,
}

/// How a texture is read between its texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sampler {
    /// Interpolates; else the nearest texel, and the nearest level.
    pub linear: bool,
    /// Repeats outside; else its edge goes on.
    pub repeat: bool,
}

impl Texture {
    /// A texture with its levels, each half as large as the one before: layers after one another, rows from the top, texels with as
    /// many channels (1 to 4). Absent channels read 0, an absent alpha 1.
    ///
    /// # Errors
    /// A level has another count of numbers than its size takes.
    pub fn new(width: u32, height: u32, layers: u32, channels: u32, levels: Vec<Vec<f32>>) -> Result<Self, EvaluateError> {
        let size = |level: u32, of: u32| u64::from((of >> level).max(1));
        let numbers = |level: u32| [u64::from(layers), u64::from(channels), size(level, width), size(level, height)];
        let product = |factors: [u64; 4]| factors.iter().fold(1_u64, |a, b| a.saturating_mul(*b));
        let count = u32::try_from(levels.len()).unwrap_or(u32::MAX).min(32);
        let needed = (0..count).fold(0_u64, |sum, level| sum.saturating_add(product(numbers(level))));
        let fits = (0..count)
            .zip(&levels)
            .all(|(level, texels)| texels.len() as u64 == product(numbers(level)));
        let is_texture = width > 0 && height > 0 && layers > 0 && (1..=4).contains(&channels) && (1..=31).contains(&levels.len());
        if !fits || !is_texture {
            return Err(EvaluateError::TextureSize {
                width,
                height,
                layers,
                needed: needed.max(1),
                found: levels.iter().map(|level| level.len() as u64).sum(),
            });
        }
        Ok(Self {
            width,
            height,
            layers,
            channels,
            levels,
        })
    }

    /// What stands in where nothing is bound: one texel, white; of a depth texture the far plane.
    pub(crate) fn stand_in(is_depth: bool, white: f32, layers: u32) -> Self {
        let channels = if is_depth { 1 } else { 4 };
        Self {
            width: 1,
            height: 1,
            layers,
            channels,
            levels: vec![vec![white; (layers * channels) as usize]],
        }
    }

    /// Width and height of a level; the last one's where there is no such level.
    pub(crate) fn size(&self, level: u32) -> [u32; 2] {
        let level = level.min(self.last_level());
        [(self.width >> level).max(1), (self.height >> level).max(1)]
    }

    /// Layers; those of cubes are their faces.
    pub(crate) fn layers(&self) -> u32 {
        self.layers
    }

    /// Levels.
    #[allow(clippy::cast_possible_truncation)] // 31 at most
    pub(crate) fn levels(&self) -> u32 {
        self.levels.len() as u32
    }

    /// The last level.
    pub(crate) fn last_level(&self) -> u32 {
        self.levels().saturating_sub(1)
    }

    /// A texel; coordinates, layer and level beyond the end are the last.
    pub(crate) fn texel(&self, x: u32, y: u32, layer: u32, level: u32) -> [f32; 4] {
        let level = level.min(self.last_level());
        let [width, height] = self.size(level);
        let (x, y, layer) = (x.min(width - 1), y.min(height - 1), layer.min(self.layers - 1));
        let at = ((layer as usize * height as usize + y as usize) * width as usize + x as usize) * self.channels as usize;
        let texels = &self.levels[level as usize];
        let mut texel = [0.0, 0.0, 0.0, 1.0];
        for (to, channel) in texel.iter_mut().zip(at..at + self.channels as usize) {
            *to = texels.get(channel).copied().unwrap_or(0.0);
        }
        texel
    }
}
