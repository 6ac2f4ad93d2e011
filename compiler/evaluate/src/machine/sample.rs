//! Reads of textures: a texel, the nearest, or the four or eight around weighted.
//!
//! How finely a GPU weighs texels is its own affair, so an interval covers all texels that the coordinate's interval touches.

use naga::{ImageDimension, SwizzleComponent};

use super::Machine;
use super::memory::Slot;
use crate::code::{At, ImageOp, ImageUse};
use crate::error::{EvaluateError, unsupported};
use crate::number::Number;
use crate::texture::{Sampler, Texture};
use crate::tree::Leaf;

/// A coordinate along one axis: what the evaluation has, and its bounds.
#[derive(Clone, Copy, Debug)]
struct Along {
    value: f64,
    low: f64,
    high: f64,
}

/// A number of a texture, with the range of the texels that it may be made of.
#[derive(Clone, Copy, Debug)]
struct Mixed {
    value: f64,
    low: f64,
    high: f64,
}

impl Mixed {
    fn of(x: f32) -> Self {
        let x = f64::from(x);
        Self { value: x, low: x, high: x }
    }

    /// A weighted sum of two.
    fn between(self, other: Self, weight: f64) -> Self {
        Self {
            value: if weight == 0.0 {
                self.value
            } else {
                self.value * (1.0 - weight) + other.value * weight
            },
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    fn or(self, other: Self) -> Self {
        Self {
            value: self.value,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }
}

/// A coordinate of a texel on an axis of this size.
fn wrap(i: i64, size: u32, repeat: bool) -> u32 {
    let size = i64::from(size.max(1));
    let i = if repeat { i.rem_euclid(size) } else { i.clamp(0, size - 1) };
    u32::try_from(i).unwrap_or(0)
}

impl<N: Number> Machine<'_, N> {
    pub(super) fn image(&mut self, used: &ImageUse, to: At) -> Result<(), EvaluateError> {
        let number = self.int(used.image) as usize;
        let Some(Some(texture)) = self.textures.get(number).cloned() else {
            return Err(unsupported("such a texture"));
        };
        match &used.op {
            ImageOp::Size { level } => {
                let [width, height] = texture.size(level.map_or(0, |at| self.int(at)));
                self.set(to, Slot::Uint(width));
                match used.dim {
                    ImageDimension::D1 => {}
                    ImageDimension::D2 | ImageDimension::Cube => self.set(to + 1, Slot::Uint(height)),
                    ImageDimension::D3 => {
                        self.set(to + 1, Slot::Uint(height));
                        self.set(to + 2, Slot::Uint(texture.layers()));
                    }
                }
            }
            ImageOp::Levels => self.set(to, Slot::Uint(texture.levels())),
            ImageOp::Layers => {
                let faces = if used.dim == ImageDimension::Cube { 6 } else { 1 };
                self.set(to, Slot::Uint(texture.layers() / faces));
            }
            ImageOp::Load { coordinate, layer, level } => {
                let y = if used.dim == ImageDimension::D1 {
                    0
                } else {
                    self.int(coordinate + 1)
                };
                let layer = match used.dim {
                    ImageDimension::D3 => self.int(coordinate + 2),
                    _ => layer.map_or(0, |at| self.int(at)),
                };
                let texel = texture.texel(self.int(*coordinate), y, layer, level.map_or(0, |at| self.int(at)));
                let channels = if used.is_depth { 1 } else { 4 };
                for (at, x) in (to..).zip(&texel[..channels]) {
                    self.set_texel(at, used.leaf, Mixed::of(*x));
                }
            }
            ImageOp::Sample { .. } => self.sample(used, &texture, to)?,
        }
        Ok(())
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // texels of integers hold integers
    fn set_texel(&mut self, at: At, leaf: Leaf, x: Mixed) {
        self.undecided |= leaf != Leaf::Float && x.low != x.high;
        let slot = match leaf {
            Leaf::Float => Slot::Float(N::filtered(x.value, x.low, x.high)),
            Leaf::Int => Slot::Int(x.value as i32),
            _ => Slot::Uint(x.value as u32),
        };
        self.set(at, slot);
    }

    fn along(&self, at: At) -> Along {
        let (low, high) = self.float(at).bounds();
        Along {
            value: self.float(at).to_f64(),
            low,
            high,
        }
    }

    fn sample(&mut self, used: &ImageUse, texture: &Texture, to: At) -> Result<(), EvaluateError> {
        let ImageOp::Sample {
            sampler,
            coordinate,
            layer,
            offset,
            level,
            depth,
            gather,
            clamp,
        } = used.op
        else {
            return Ok(());
        };
        let number = self.int(sampler) as usize;
        let mut sampler = self.samplers.get(number).copied().unwrap_or_default();
        if clamp {
            sampler.repeat = false;
        }
        let is_one_texel = texture.levels() == 1 && texture.size(0) == [1, 1] && is_uniform(texture);
        let place: [Along; 2] = match used.dim {
            ImageDimension::D2 => [self.along(coordinate), self.along(coordinate + 1)],
            // Wherever one looks into a texture of one colour.
            _ if is_one_texel => {
                [Along {
                    value: 0.5,
                    low: 0.5,
                    high: 0.5,
                }; 2]
            }
            ImageDimension::Cube => return Err(unsupported("a cube texture with more than one texel")),
            _ => return Err(unsupported("a sampled 1D or 3D texture with more than one texel")),
        };
        let layer = layer.map_or(0, |at| self.int(at).cast_signed().max(0).cast_unsigned());
        let offset = offset.map_or([0, 0], |at| [at, at + 1].map(|at| i64::from(self.int(at).cast_signed())));
        let level = match level {
            None => Along {
                value: 0.0,
                low: 0.0,
                high: 0.0,
            },
            Some(at) => match self.memory[at as usize] {
                Slot::Float(_) => self.along(at),
                _ => {
                    let level = f64::from(self.int(at).cast_signed());
                    Along {
                        value: level,
                        low: level,
                        high: level,
                    }
                }
            },
        };
        let look = Look {
            texture,
            sampler,
            place,
            layer,
            offset,
            spreads: N::SPREADS,
        };
        let reference = depth.map(|at| self.float(at));
        // Compared first, then weighted: less or equal passes.
        let compared = |texel: f32| match reference {
            None => Mixed::of(texel),
            Some(reference) => {
                let truth = reference.less_equal(N::from_f32(texel));
                let x = if truth.value { 1.0 } else { 0.0 };
                if truth.sure {
                    Mixed::of(x)
                } else {
                    Mixed {
                        value: f64::from(x),
                        low: 0.0,
                        high: 1.0,
                    }
                }
            }
        };
        if let Some(channel) = gather {
            let gathered = look.gathered(channel, compared);
            for (at, x) in (to..).zip(gathered) {
                self.set_texel(at, used.leaf, x);
            }
            return Ok(());
        }
        let channels = if used.is_depth { 1 } else { 4 };
        for channel in 0..channels {
            let x = look.at_level(level, channel, compared);
            self.set_texel(to + u32::try_from(channel).unwrap_or(0), used.leaf, x);
        }
        Ok(())
    }
}

/// Whether all layers have the same texel.
fn is_uniform(texture: &Texture) -> bool {
    (1..texture.layers()).all(|layer| texture.texel(0, 0, layer, 0) == texture.texel(0, 0, 0, 0))
}

/// Where one looks into which texture.
struct Look<'t> {
    texture: &'t Texture,
    sampler: Sampler,
    place: [Along; 2],
    layer: u32,
    offset: [i64; 2],
    /// Whether the range of what a driver may read is asked for.
    spreads: bool,
}

/// Most texels along an axis that an interval is spread over, beyond which it is spread over all.
const WIDEST: i64 = 64;

impl Look<'_> {
    fn texel(&self, x: i64, y: i64, level: u32, channel: usize) -> f32 {
        let [width, height] = self.texture.size(level);
        let x = wrap(x.saturating_add(self.offset[0]), width, self.sampler.repeat);
        let y = wrap(y.saturating_add(self.offset[1]), height, self.sampler.repeat);
        self.texture.texel(x, y, self.layer, level)[channel]
    }

    /// A level between two, the nearest where the sampler does not interpolate.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the level is clamped
    fn at_level(&self, level: Along, channel: usize, compared: impl Fn(f32) -> Mixed) -> Mixed {
        let last = f64::from(self.texture.last_level());
        let clamp = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, last) };
        let (value, low, high) = (clamp(level.value), clamp(level.low), clamp(level.high));
        let mut mixed = if self.sampler.linear {
            let below = value.floor();
            let first = self.in_level(below as u32, channel, &compared);
            let weight = value - below;
            if weight == 0.0 {
                first
            } else {
                first.between(self.in_level(below as u32 + 1, channel, &compared), weight)
            }
        } else {
            self.in_level((value + 0.5).floor() as u32, channel, &compared)
        };
        if low < high || self.sampler.linear && value.fract() != 0.0 {
            for level in low.floor() as u32..=high.ceil() as u32 {
                mixed = mixed.or(self.in_level(level, channel, &compared));
            }
        }
        mixed
    }

    /// One level.
    #[allow(clippy::cast_possible_truncation)] // saturates, and is wrapped
    fn in_level(&self, level: u32, channel: usize, compared: &impl Fn(f32) -> Mixed) -> Mixed {
        let size = self.texture.size(level).map(f64::from);
        let texel = |x: i64, y: i64| compared(self.texel(x, y, level, channel));
        // Centres of texels are at halves.
        let centre = |i: usize, x: f64| x * size[i] - 0.5;
        let [u, v] = [0, 1].map(|i| centre(i, self.place[i].value));
        let mut mixed = if self.sampler.linear {
            let (x, y) = (u.floor(), v.floor());
            let (along, down) = (u - x, v - y);
            let (x, y) = (x as i64, y as i64);
            let row = |y: i64| {
                if along == 0.0 {
                    texel(x, y)
                } else {
                    texel(x, y).between(texel(x.saturating_add(1), y), along)
                }
            };
            if down == 0.0 {
                row(y)
            } else {
                row(y).between(row(y.saturating_add(1)), down)
            }
        } else {
            texel((u + 0.5).floor() as i64, (v + 0.5).floor() as i64)
        };
        if !self.spreads {
            return mixed;
        }
        let range = |i: usize| self.touched(i, size[i], self.sampler.linear);
        let (columns, rows) = (range(0), range(1));
        for y in rows.0..=rows.1 {
            for x in columns.0..=columns.1 {
                mixed = mixed.or(texel(x, y));
            }
        }
        mixed
    }

    /// First and last texel along an axis that the coordinate's interval touches. A weight may be off by 2^-8, so a 256th of a texel
    /// more on either side.
    #[allow(clippy::cast_possible_truncation, clippy::cast_precision_loss)] // saturates, and is wrapped
    fn touched(&self, axis: usize, size: f64, linear: bool) -> (i64, i64) {
        let slack = 1.0 / 256.0;
        let half = if linear { 0.0 } else { 0.5 };
        let first = (self.place[axis].low * size - 0.5 - slack + half).floor();
        let last = self.place[axis].high * size - 0.5 + slack + half;
        let last = if linear { last.ceil() } else { last.floor() };
        // False of what is no number, too.
        if last - first <= WIDEST as f64 {
            (first as i64, last as i64)
        } else {
            (0, size as i64 - 1)
        }
    }

    /// The four texels around in the order of `textureGather`: lower left, lower right, upper right, upper left.
    #[allow(clippy::cast_possible_truncation)] // saturates, and is wrapped
    fn gathered(&self, channel: SwizzleComponent, compared: impl Fn(f32) -> Mixed) -> [Mixed; 4] {
        let size = self.texture.size(0).map(f64::from);
        let [x, y] = [0, 1].map(|i| (self.place[i].value * size[i] - 0.5).floor() as i64);
        let [right, lower] = [x.saturating_add(1), y.saturating_add(1)];
        let mut gathered = [(x, lower), (right, lower), (right, y), (x, y)].map(|(x, y)| compared(self.texel(x, y, 0, channel as usize)));
        let [columns, rows] = [0, 1].map(|i| self.touched(i, size[i], true));
        // Another cell than one's own may be hit: then any of the texels around is one of the four.
        if self.spreads && (columns.1 - columns.0 > 1 || rows.1 - rows.0 > 1) {
            for (y, x) in (rows.0..=rows.1).flat_map(|y| (columns.0..=columns.1).map(move |x| (y, x))) {
                let texel = compared(self.texel(x, y, 0, channel as usize));
                gathered = gathered.map(|mixed| mixed.or(texel));
            }
        }
        gathered
    }
}
