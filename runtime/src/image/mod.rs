//! Images: writing finished frames, reading pictures for textures and comparisons, smaller levels of textures.

mod exr;
mod mip;
mod png;
#[cfg(not(target_arch = "wasm32"))]
mod write;

pub(crate) use self::exr::exr_sizes;
pub use self::exr::{decode_exr, encode_exr};
pub(crate) use mip::halved;
pub use mip::{linear_to_srgb, mip_levels, srgb_to_linear};
pub(crate) use png::texture_size;
pub use png::{decode_texture, encode_png};
#[cfg(not(target_arch = "wasm32"))]
pub use write::write_atomically;

/// Most texels along one side of a picture that is read.
pub const MAX_SIDE: u32 = 16_384;
/// Most texels of a picture that is read: 64 Mi texels are 256 MiB in memory.
pub const MAX_TEXELS: u64 = 64 << 20;

/// A linear HDR picture in physical units: RGBA, rows from the top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hdr {
    /// Texels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear Rec.709 radiance in cd/m2 per channel, and coverage in [0, 1]; `width * height` of them.
    pub texels: Vec<[f32; 4]>,
    /// Said about the picture; the file's `comments`.
    pub comment: String,
}

/// Why a picture cannot be read or written.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// The number of texels is not width times height, or one of these is 0.
    #[error("a picture of {width} x {height} cannot have {texels} texels")]
    Size {
        /// Texels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// How many there were.
        texels: usize,
    },
    /// The picture is larger than the declared limits.
    #[error("the picture is larger than {MAX_SIDE} texels a side or {MAX_TEXELS} texels in all")]
    TooLarge,
    /// The bytes are no picture of a known kind.
    #[error("cannot be decoded: {0}")]
    Decode(String),
    /// The picture cannot be encoded.
    #[error("cannot be encoded: {0}")]
    Encode(String),
    /// The file cannot be written.
    #[error("cannot write {path}: {error}")]
    Write {
        /// Where to.
        path: std::path::PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
}

/// Checks that there are as many texels as the size says.
fn check_size(width: u32, height: u32, texels: usize) -> Result<(), ImageError> {
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) != texels as u64 {
        return Err(ImageError::Size { width, height, texels });
    }
    Ok(())
}

/// Checks the limits of what is read.
fn check_limits(width: u64, height: u64) -> Result<(), ImageError> {
    let side = u64::from(MAX_SIDE);
    // Both factors are at most 2^32: the product fits.
    if width == 0 || height == 0 || width > side || height > side || width * height > MAX_TEXELS {
        return Err(ImageError::TooLarge);
    }
    Ok(())
}
