//! Reads of textures.

use naga::{Expression, Handle, ImageClass, ImageQuery, SampleLevel, TypeInner};

use super::Place;
use super::function::Body;
use crate::code::{ImageOp, ImageUse, Op};
use crate::error::{EvaluateError, unsupported};
use crate::tree::Leaf;

impl Body<'_, '_> {
    /// `textureSampleLevel`, `textureLoad`, `textureDimensions` and their kind.
    pub fn image(&mut self, handle: Handle<Expression>) -> Result<Place, EvaluateError> {
        let expressions = self.expressions;
        let (image, op) = match &expressions[handle] {
            Expression::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => {
                let level = match *level {
                    SampleLevel::Zero => None,
                    SampleLevel::Exact(level) => Some(self.value(level)?),
                    SampleLevel::Gradient { .. } => return Err(unsupported("a texture sampled by gradients")),
                    // A gather has no level in the source, and reads the first.
                    SampleLevel::Auto if gather.is_some() => None,
                    SampleLevel::Auto | SampleLevel::Bias(_) => return Err(unsupported("a texture sampled by implicit derivatives")),
                };
                let op = ImageOp::Sample {
                    sampler: self.value(*sampler)?,
                    coordinate: self.value(*coordinate)?,
                    layer: array_index.map(|h| self.value(h)).transpose()?,
                    offset: offset.map(|h| self.value(h)).transpose()?,
                    level,
                    depth: depth_ref.map(|h| self.value(h)).transpose()?,
                    gather: *gather,
                    clamp: *clamp_to_edge,
                };
                (*image, op)
            }
            Expression::ImageLoad {
                image,
                coordinate,
                array_index,
                sample,
                level,
            } => {
                if sample.is_some() {
                    return Err(unsupported("a multisampled texture"));
                }
                let op = ImageOp::Load {
                    coordinate: self.value(*coordinate)?,
                    layer: array_index.map(|h| self.value(h)).transpose()?,
                    level: level.map(|h| self.value(h)).transpose()?,
                };
                (*image, op)
            }
            Expression::ImageQuery { image, query } => {
                let op = match *query {
                    ImageQuery::Size { level } => ImageOp::Size {
                        level: level.map(|h| self.value(h)).transpose()?,
                    },
                    ImageQuery::NumLevels => ImageOp::Levels,
                    ImageQuery::NumLayers => ImageOp::Layers,
                    ImageQuery::NumSamples => return Err(unsupported("a multisampled texture")),
                };
                (*image, op)
            }
            _ => return Err(unsupported("such a texture read")),
        };
        let TypeInner::Image { dim, class, .. } = *self.type_of(image) else {
            return Err(unsupported("such a texture"));
        };
        let (leaf, is_depth) = match class {
            ImageClass::Sampled { multi: true, .. } | ImageClass::Depth { multi: true } => {
                return Err(unsupported("a multisampled texture"));
            }
            ImageClass::Sampled { kind, .. } => (Leaf::of(naga::Scalar { kind, width: 4 })?, false),
            ImageClass::Depth { .. } => (Leaf::Float, true),
            ImageClass::Storage { .. } => return Err(unsupported("a storage texture")),
            ImageClass::External => return Err(unsupported("an external texture")),
        };
        let at = self.value(image)?;
        let (to, _) = self.result(handle)?;
        let number = u32::try_from(self.compiler.images.len()).unwrap_or(u32::MAX);
        self.compiler.images.push(ImageUse {
            image: at,
            dim,
            is_depth,
            leaf,
            op,
        });
        self.compiler.code.push(Op::Image { image: number, to });
        Ok(Place::Value(to))
    }
}
