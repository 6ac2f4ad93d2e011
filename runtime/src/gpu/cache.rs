//! Compiled pipelines on disk, for drivers that keep none themselves: wgpu's pipeline cache, which Vulkan has.
//!
//! This crate has no `unsafe`, and to give a [`wgpu::PipelineCache`] its data is: a driver may believe whatever stands in it. wgpu and the driver
//! check its header only. So the caller makes the cache, and answers for the folder; what is here sees to it that the data is whole and this
//! driver's own.
//!
//! ```text
//! let data = cache::load(&folder, gpu.info());
//! // SAFETY: `load` gives what `store` has written for this driver, and nobody else writes into the folder.
//! let made = unsafe { gpu.device().create_pipeline_cache(&wgpu::PipelineCacheDescriptor { label: None, data: data.as_deref(), fallback: true }) };
//! let renderer = Renderer::with_cache(&gpu, catalog, Some(made.clone()));
//! // ... draw, then:
//! cache::store(&folder, gpu.info(), &made)?;
//! ```
//!
//! The device needs [`wgpu::Features::PIPELINE_CACHE`]; [`Gpu::headless`](super::Gpu::headless) asks for it where it is there.

use std::hash::Hasher;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use siphasher::sip128::{Hasher128, SipHasher};

/// What a file begins with; the digit is the format's version.
const MAGIC: &[u8; 8] = b"SWPIPES1";
/// Magic, checksum.
const HEADER: usize = 8 + 16;
/// Larger files are not read, bytes.
const MOST: u64 = 1 << 30;

/// The file of this adapter's driver; `None` where there is no pipeline cache for its API.
fn path(folder: &Path, info: &wgpu::AdapterInfo) -> Option<PathBuf> {
    wgpu::util::pipeline_cache_key(info).map(|key| folder.join(key))
}

/// Checksum of the data and of the driver that it belongs to.
fn checksum(info: &wgpu::AdapterInfo, data: &[u8]) -> [u8; 16] {
    let mut hasher = SipHasher::new();
    let driver = format!(
        "{:?} {} {} {} {} {}",
        info.backend, info.vendor, info.device, info.name, info.driver, info.driver_info
    );
    hasher.write_usize(driver.len());
    hasher.write(driver.as_bytes());
    hasher.write(data);
    hasher.finish128().as_u128().to_le_bytes()
}

/// What [`store`] has written into the folder for this adapter. A file that is damaged, cut short, or of another driver or version is passed
/// over with a line in the log.
pub fn load(folder: &Path, info: &wgpu::AdapterInfo) -> Option<Vec<u8>> {
    let path = path(folder, info)?;
    let ignored = |why: &str| log::warn!("{}: ignored: {why}", path.display());
    let file = match std::fs::File::open(&path) {
        Ok(file) => file,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
        Err(error) => {
            ignored(&error.to_string());
            return None;
        }
    };
    let mut bytes = Vec::new();
    if let Err(error) = file.take(MOST + 1).read_to_end(&mut bytes) {
        ignored(&error.to_string());
        return None;
    }
    if bytes.len() as u64 > MOST {
        ignored("too large");
        return None;
    }
    let Some((header, data)) = bytes.split_at_checked(HEADER).filter(|(header, _)| header.starts_with(MAGIC)) else {
        ignored("no pipeline cache of this version");
        return None;
    };
    if header[MAGIC.len()..] != checksum(info, data) {
        ignored("damaged, or of another driver");
        return None;
    }
    bytes.drain(..HEADER);
    Some(bytes)
}

/// Writes what the driver has compiled so far, under a temporary name first. `false`: the driver gives nothing that could be kept.
///
/// # Errors
/// The folder cannot be made or written to.
pub fn store(folder: &Path, info: &wgpu::AdapterInfo, cache: &wgpu::PipelineCache) -> std::io::Result<bool> {
    match cache.get_data() {
        Some(data) => store_data(folder, info, &data),
        None => Ok(false),
    }
}

fn store_data(folder: &Path, info: &wgpu::AdapterInfo, data: &[u8]) -> std::io::Result<bool> {
    let Some(path) = path(folder, info) else { return Ok(false) };
    std::fs::create_dir_all(folder)?;
    let mut file = tempfile::Builder::new().prefix(".shadewright-").tempfile_in(folder)?;
    file.write_all(MAGIC)?;
    file.write_all(&checksum(info, data))?;
    file.write_all(data)?;
    file.as_file().sync_all()?;
    file.persist(path).map_err(|error| error.error)?;
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::testing::gpu;

    fn vulkan() -> wgpu::AdapterInfo {
        wgpu::AdapterInfo {
            backend: wgpu::Backend::Vulkan,
            ..gpu().info().clone()
        }
    }

    /// Catches data that comes back otherwise, a file that is left half, and temporary names that stay.
    #[test]
    fn what_is_stored_comes_back() {
        let folder = tempfile::tempdir().unwrap();
        let below = folder.path().join("not/there/yet");
        assert_eq!(load(&below, &vulkan()), None);
        for data in [&b"first"[..], b"", &[7; 5000]] {
            assert!(store_data(&below, &vulkan(), data).unwrap());
            assert_eq!(load(&below, &vulkan()).as_deref(), Some(data));
        }
        assert_eq!(std::fs::read_dir(&below).unwrap().count(), 1);
        let metal = wgpu::AdapterInfo {
            backend: wgpu::Backend::Metal,
            ..vulkan()
        };
        assert!(!store_data(&below, &metal, b"data").unwrap());
        assert_eq!(load(&below, &metal), None);
        let file = path(&below, &vulkan()).unwrap();
        assert!(store_data(&file, &vulkan(), b"data").is_err(), "a file is no folder");
    }

    /// Catches data of another driver, or with any bit turned or byte missing, that is handed to a driver all the same.
    #[test]
    fn what_is_not_whole_or_not_ours_is_passed_over() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        store_data(folder, &vulkan(), b"compiled").unwrap();
        let file = path(folder, &vulkan()).unwrap();
        let good = std::fs::read(&file).unwrap();
        assert_eq!(good.len(), HEADER + 8);
        for bit in 0..good.len() * 8 {
            let mut bad = good.clone();
            bad[bit / 8] ^= 1 << (bit % 8);
            std::fs::write(&file, &bad).unwrap();
            assert_eq!(load(folder, &vulkan()), None, "bit {bit}");
        }
        for length in 0..good.len() {
            std::fs::write(&file, &good[..length]).unwrap();
            assert_eq!(load(folder, &vulkan()), None, "{length} bytes");
        }
        std::fs::write(&file, [&good[..], b"more"].concat()).unwrap();
        assert_eq!(load(folder, &vulkan()), None);
        std::fs::write(&file, &good).unwrap();
        let other = wgpu::AdapterInfo {
            driver_info: "another version".into(),
            ..vulkan()
        };
        assert_eq!(load(folder, &other), None);
        assert_eq!(load(folder, &vulkan()).as_deref(), Some(&b"compiled"[..]));
        std::fs::remove_file(&file).unwrap();
        std::fs::create_dir(&file).unwrap();
        assert_eq!(load(folder, &vulkan()), None, "a folder is no file");
    }
}
