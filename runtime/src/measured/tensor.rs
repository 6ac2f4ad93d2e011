//! Tensor files, the container of `.bsdf`: named arrays of numbers.
//!
//! `tensor_file` and a zero byte, the version 1 and 0, the number of fields as `u32`; for each field the length of its name as `u16`, the name, the
//! number of its dimensions as `u16`, the numbers' type as a byte, the place of its data as `u64`, its sizes as `u64`, the last the fastest. All
//! little-endian.

use super::Damaged;

/// How such a file begins.
pub const MAGIC: &[u8] = b"tensor_file\0";
const VERSION: [u8; 2] = [1, 0];
/// Bytes of a field without name and sizes.
const FIELD: usize = 13;
/// Types in the order of their numbers, from 1 on, and their bytes.
const TYPES: [(&str, usize); 11] = [
    ("u8", 1),
    ("i8", 1),
    ("u16", 2),
    ("i16", 2),
    ("u32", 4),
    ("i32", 4),
    ("u64", 8),
    ("i64", 8),
    ("f16", 2),
    ("f32", 4),
    ("f64", 8),
];
const U8: u8 = 1;
const F32: u8 = 10;

/// Numbers of a field, of the types that a BRDF's file has.
#[derive(Clone, Debug, PartialEq)]
pub enum Numbers {
    /// Bytes: text, flags.
    Bytes(Vec<u8>),
    /// Floats.
    Floats(Vec<f32>),
}

/// A named array.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Sizes, the last the fastest.
    pub shape: Vec<usize>,
    /// Its numbers, as many as the sizes' product.
    pub numbers: Numbers,
}

/// Where a field is.
#[derive(Clone, Debug)]
pub(super) struct Entry<'a> {
    /// Where the file speaks of it.
    pub at: usize,
    pub name: String,
    pub shape: Vec<usize>,
    kind: u8,
    /// Where its data begin.
    pub offset: usize,
    data: &'a [u8],
}

impl Entry<'_> {
    /// Its floats, all finite.
    pub fn floats(&self) -> Result<Vec<f32>, Damaged> {
        self.is_of(F32)?;
        let mut floats = Vec::with_capacity(self.data.len() / 4);
        for (index, chunk) in self.data.chunks_exact(4).enumerate() {
            // Chunks of 4 are 4 bytes long.
            let x = f32::from_le_bytes(chunk.try_into().unwrap_or_default());
            if !x.is_finite() {
                let expected = format!("a finite number in `{}`", self.name);
                return Err(Damaged::new(self.offset + 4 * index, expected, x.to_string()));
            }
            floats.push(x);
        }
        Ok(floats)
    }

    /// Its bytes.
    pub fn bytes(&self) -> Result<&[u8], Damaged> {
        self.is_of(U8)?;
        Ok(self.data)
    }

    fn is_of(&self, kind: u8) -> Result<(), Damaged> {
        if self.kind == kind {
            return Ok(());
        }
        let name = |kind: u8| TYPES[usize::from(kind) - 1].0;
        Err(Damaged::new(
            self.at,
            format!("`{}` of type {}", self.name, name(kind)),
            format!("type {}", name(self.kind)),
        ))
    }
}

/// Takes bytes from the front.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize, what: &str) -> Result<&'a [u8], Damaged> {
        let left = self.bytes.len() - self.at;
        if count > left {
            let found = format!("the end of the file after {left}");
            return Err(Damaged::new(self.at, format!("{count} bytes of {what}"), found));
        }
        self.at += count;
        Ok(&self.bytes[self.at - count..self.at])
    }

    fn number(&mut self, bytes: usize, what: &str) -> Result<u64, Damaged> {
        let taken = self.take(bytes, what)?;
        Ok(taken.iter().rev().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }
}

/// The fields of a file, their data where they stand: nothing is copied.
///
/// # Errors
/// It is no tensor file of version 1.0, ends too early, or has a field that cannot be.
pub(super) fn fields(bytes: &[u8]) -> Result<Vec<Entry<'_>>, Damaged> {
    let mut reader = Reader { bytes, at: 0 };
    let magic = reader.take(MAGIC.len(), "the word tensor_file")?;
    if magic != MAGIC {
        return Err(Damaged::new(
            0,
            "the word tensor_file and a zero byte",
            format!("{:?}", String::from_utf8_lossy(magic)),
        ));
    }
    let version = reader.take(2, "a version")?;
    if version != VERSION {
        return Err(Damaged::new(12, "version 1.0", format!("{}.{}", version[0], version[1])));
    }
    let at = reader.at;
    let count = reader.number(4, "the number of fields")? as usize;
    if count > (bytes.len() - reader.at) / FIELD {
        let left = bytes.len() - reader.at;
        return Err(Damaged::new(
            at,
            format!("no more fields than {left} bytes hold"),
            format!("{count} fields"),
        ));
    }
    let mut fields: Vec<Entry<'_>> = Vec::with_capacity(count);
    for _ in 0..count {
        let field = field(&mut reader)?;
        if fields.iter().any(|other| other.name == field.name) {
            return Err(Damaged::new(
                field.at,
                "fields of different names",
                format!("a second `{}`", field.name),
            ));
        }
        fields.push(field);
    }
    Ok(fields)
}

fn field<'a>(reader: &mut Reader<'a>) -> Result<Entry<'a>, Damaged> {
    let at = reader.at;
    let length = reader.number(2, "a name's length")? as usize;
    let name = reader.take(length, "a field's name")?;
    let name = std::str::from_utf8(name)
        .map_err(|_| Damaged::new(at + 2, "a name in UTF-8", format!("{:?}", String::from_utf8_lossy(name))))?
        .to_owned();
    let dimensions = reader.number(2, "the number of dimensions")? as usize;
    let kind_at = reader.at;
    // A byte.
    let kind = reader.number(1, "a type")? as u8;
    let Some((_, size)) = usize::from(kind).checked_sub(1).and_then(|kind| TYPES.get(kind)) else {
        return Err(Damaged::new(
            kind_at,
            format!("a type from 1 to {} for `{name}`", TYPES.len()),
            kind.to_string(),
        ));
    };
    let offset_at = reader.at;
    let offset = reader.number(8, "the place of data")?;
    let sizes = reader.take(dimensions * 8, "sizes")?;
    let shape = sizes
        .chunks_exact(8)
        .map(|size| u64::from_le_bytes(size.try_into().unwrap_or_default()));
    let shape: Option<Vec<usize>> = shape.map(|size| usize::try_from(size).ok()).collect();
    let all = shape.iter().flatten().try_fold(*size, |all, size| all.checked_mul(*size));
    let place = usize::try_from(offset).ok().zip(all).zip(shape);
    let found = place.and_then(|((offset, all), shape)| {
        let data = reader.bytes.get(offset..offset.checked_add(all)?)?;
        Some((offset, data, shape))
    });
    let Some((offset, data, shape)) = found else {
        let expected = format!("data of `{name}` within the file's {} bytes", reader.bytes.len());
        let size = all.map_or("more bytes than can be".to_owned(), |all| format!("{all} bytes"));
        return Err(Damaged::new(offset_at, expected, format!("{size} at {offset}")));
    };
    Ok(Entry {
        at,
        name,
        shape,
        kind,
        offset,
        data,
    })
}

/// A file of fields. Data begin at multiples of 8 bytes.
pub fn write(fields: &[Field]) -> Vec<u8> {
    let head = |field: &Field| FIELD + field.name.len() + 8 * field.shape.len();
    let mut offset = MAGIC.len() + 2 + 4 + fields.iter().map(head).sum::<usize>();
    let (mut front, mut data) = (Vec::new(), Vec::new());
    front.extend(MAGIC);
    front.extend(VERSION);
    front.extend((fields.len() as u32).to_le_bytes());
    for field in fields {
        let bytes: Vec<u8> = match &field.numbers {
            Numbers::Bytes(bytes) => bytes.clone(),
            Numbers::Floats(floats) => floats.iter().flat_map(|x| x.to_le_bytes()).collect(),
        };
        let kind = match field.numbers {
            Numbers::Bytes(_) => U8,
            Numbers::Floats(_) => F32,
        };
        let gap = offset.next_multiple_of(8) - offset;
        data.extend(std::iter::repeat_n(0, gap));
        offset += gap;
        front.extend((field.name.len() as u16).to_le_bytes());
        front.extend(field.name.as_bytes());
        front.extend((field.shape.len() as u16).to_le_bytes());
        front.push(kind);
        front.extend((offset as u64).to_le_bytes());
        for size in &field.shape {
            front.extend((*size as u64).to_le_bytes());
        }
        offset += bytes.len();
        data.extend(bytes);
    }
    front.extend(data);
    front
}
