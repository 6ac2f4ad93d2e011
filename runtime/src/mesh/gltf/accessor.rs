//! Typed reading of buffers, with every range checked before it is read.

use gltf::accessor::{DataType, Dimensions};

use super::{GltfError, damaged, unsupported};
use crate::mesh::MAX_VERTICES;

/// The elements of an accessor, component by component.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

fn place(accessor: &gltf::Accessor) -> String {
    format!("accessors[{}]", accessor.index())
}

/// Checks that the accessor lies inside its view, the view inside its buffer.
fn elements<'a>(accessor: &gltf::Accessor, buffers: &'a [Vec<u8>]) -> Result<Elements<'a>, GltfError> {
    let place = place(accessor);
    if accessor.sparse().is_some() {
        return Err(unsupported(place, "a sparse accessor"));
    }
    let Some(view) = accessor.view() else {
        return Err(unsupported(place, "an accessor without a buffer view"));
    };
    let (size, count) = (accessor.size(), accessor.count());
    if count > 3 * MAX_VERTICES {
        return Err(unsupported(
            place,
            format!("an accessor of {count} elements, more than {},", 3 * MAX_VERTICES),
        ));
    }
    let outside = || damaged(place.clone(), "reaches past the end of its buffer");
    let buffer = buffers.get(view.buffer().index()).ok_or_else(outside)?;
    let view_end = view.offset().checked_add(view.length()).ok_or_else(outside)?;
    let view_bytes = buffer.get(view.offset()..view_end).ok_or_else(outside)?;
    let bytes = view_bytes.get(accessor.offset()..).ok_or_else(outside)?;
    let stride = view.stride().unwrap_or(size);
    if stride < size {
        return Err(damaged(place, format!("elements of {size} bytes every {stride} bytes")));
    }
    // Count is limited above and stride is at most 252 after validation, but 64 bits are not everywhere.
    let needed = count
        .checked_sub(1)
        .map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size));
    if needed.is_none_or(|needed| needed > bytes.len()) {
        return Err(outside());
    }
    Ok(Elements {
        bytes,
        stride,
        size,
        count,
    })
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let (bytes, stride, size) = (self.bytes, self.stride, self.size);
        (0..self.count).map(move |i| &bytes[i * stride..i * stride + size])
    }
}

/// Vectors of N floats. Integers are taken where they are normalised, as the specification allows for this attribute.
pub(super) fn floats<const N: usize>(accessor: &gltf::Accessor, buffers: &[Vec<u8>]) -> Result<Vec<[f32; N]>, GltfError> {
    let dimensions = match N {
        2 => Dimensions::Vec2,
        3 => Dimensions::Vec3,
        _ => Dimensions::Vec4,
    };
    if accessor.dimensions() != dimensions {
        return Err(damaged(
            place(accessor),
            format!("{:?} where {dimensions:?} is needed", accessor.dimensions()),
        ));
    }
    let ty = accessor.data_type();
    let read: fn(&[u8], usize) -> f32 = match (ty, accessor.normalized()) {
        (DataType::F32, _) => |b, i| f32::from_le_bytes([b[4 * i], b[4 * i + 1], b[4 * i + 2], b[4 * i + 3]]),
        (DataType::U8, true) => |b, i| f32::from(b[i]) / 255.0,
        (DataType::I8, true) => |b, i| (f32::from(b[i] as i8) / 127.0).max(-1.0),
        (DataType::U16, true) => |b, i| f32::from(u16::from_le_bytes([b[2 * i], b[2 * i + 1]])) / 65535.0,
        (DataType::I16, true) => |b, i| (f32::from(i16::from_le_bytes([b[2 * i], b[2 * i + 1]])) / 32767.0).max(-1.0),
        _ => {
            return Err(unsupported(
                place(accessor),
                format!("an attribute of {ty:?} that is not normalised"),
            ));
        }
    };
    let elements = elements(accessor, buffers)?;
    let mut out = Vec::with_capacity(elements.count);
    for element in elements.iter() {
        let vector: [f32; N] = std::array::from_fn(|i| read(element, i));
        if !vector.iter().all(|x| x.is_finite()) {
            return Err(damaged(place(accessor), "a number that is not finite"));
        }
        out.push(vector);
    }
    Ok(out)
}

/// Vertex indices.
pub(super) fn indices(accessor: &gltf::Accessor, buffers: &[Vec<u8>]) -> Result<Vec<u32>, GltfError> {
    if accessor.dimensions() != Dimensions::Scalar {
        return Err(damaged(place(accessor), "indices that are no scalars"));
    }
    let read: fn(&[u8]) -> u32 = match accessor.data_type() {
        DataType::U8 => |b| b[0].into(),
        DataType::U16 => |b| u16::from_le_bytes([b[0], b[1]]).into(),
        DataType::U32 => |b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        other => return Err(damaged(place(accessor), format!("indices of {other:?}"))),
    };
    Ok(elements(accessor, buffers)?.iter().map(read).collect())
}
