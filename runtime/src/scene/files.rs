//! Where the files that a scene names come from, and what has been made of them.
//!
//! A host that draws a scene again after each change of it would decode the same pictures and build the same meshes each time, and a renderer would
//! upload them again, as it knows them by their allocation. So what is made is kept as long as frames ask for it, and as long as the files that it was
//! made from are as they were: on disk their time of modification and their size say so.

mod shelf;

use std::convert::Infallible;
use std::fmt;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime};

use indexmap::IndexMap;

use self::shelf::Shelf;
use crate::data::{DecodeError, MAX_DATA, decode, decoder, read_bytes};
use crate::frame::{Mesh, Texture};
use crate::gpu::lock;
use crate::image::decode_texture;
use crate::mesh::gltf::{self, Asset, GltfError, MAX_FILE};
use crate::mesh::{MeshError, Shape};

/// Largest picture file, bytes.
pub const MAX_PICTURE: u64 = 256 << 20;

/// A file that was modified so short a time ago may be modified again without another time of modification: clocks of file systems tick as slowly as
/// once in 2 s (FAT).
const TICK: Duration = Duration::from_secs(2);

/// The files that a scene may name, and what was made of them for earlier frames. Clones share that.
#[derive(Clone, Default)]
pub struct Files {
    source: Source,
    kept: Arc<Mutex<Kept>>,
}

#[derive(Clone)]
struct Source {
    memory: Arc<IndexMap<String, Arc<[u8]>>>,
    /// Asked for what is not in memory.
    disk: bool,
}

impl Default for Source {
    fn default() -> Self {
        Self {
            memory: Arc::default(),
            disk: true,
        }
    }
}

/// What was made, for how long it holds.
#[derive(Default)]
struct Kept {
    /// Counts frames.
    round: u64,
    textures: Shelf<PathBuf, Arc<Texture>>,
    data: Shelf<(PathBuf, String), Arc<[f32]>>,
    gltf: Shelf<PathBuf, Arc<Asset>>,
    /// By the shape as text, and the address of the file's contents.
    meshes: Shelf<(String, usize), Made<Option<Arc<Asset>>>>,
    /// By the address of the mesh that was mirrored.
    mirrored: Shelf<usize, Made<Arc<Mesh>>>,
}

/// A mesh, and what it was made from: held, so that nothing else can have its address.
type Made<From> = (From, Arc<Mesh>);

/// What tells two states of a file on disk apart.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Stamp {
    modified: SystemTime,
    size: u64,
}

/// Files that something is made from, with their states before they were read. `None`: it will not be known whether one has changed.
type Origins = Option<Vec<(PathBuf, Stamp)>>;

impl fmt::Debug for Files {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let names: Vec<_> = self.source.memory.keys().collect();
        let mut shown = f.debug_struct("Files");
        shown
            .field("memory", &names)
            .field("or_disk", &self.source.disk)
            .finish_non_exhaustive()
    }
}

impl Files {
    /// These files and no others, for hosts without a file system. Names are paths with `/` between their parts, as they come out when what a scene
    /// names is put behind the scene's folder: a scene of the folder `scenes` that names `../brick.png` has `brick.png`. A file whose name has no `/`
    /// stands for those of its name in all folders that have no file themselves: of files that people give to a page no folder is known.
    pub fn memory(files: IndexMap<String, Arc<[u8]>>) -> Self {
        Self {
            source: Source {
                memory: Arc::new(files),
                disk: false,
            },
            kept: Arc::default(),
        }
    }

    /// These files, and for all others the disk.
    #[must_use]
    pub fn or_disk(mut self) -> Self {
        self.source.disk = true;
        self
    }

    /// The same with a file more, or another in the place of one of this name. What was made so far is not shared.
    #[must_use]
    pub fn with(&self, name: impl Into<String>, bytes: impl Into<Arc<[u8]>>) -> Self {
        let mut memory = IndexMap::clone(&self.source.memory);
        memory.insert(name.into(), bytes.into());
        Self {
            source: Source {
                memory: Arc::new(memory),
                disk: self.source.disk,
            },
            kept: Arc::default(),
        }
    }

    /// The bytes of a file, at most `most` of them.
    ///
    /// # Errors
    /// Says why the file cannot be read, or that it has more.
    pub fn bytes(&self, path: &Path, most: u64) -> Result<Vec<u8>, String> {
        self.read(path, most, &mut None)
    }

    /// A frame begins: forgets what the latest frames have not asked for.
    pub(super) fn begin(&self) {
        let mut kept = lock(&self.kept);
        kept.round += 1;
        let round = kept.round;
        kept.textures.sweep(round);
        kept.data.sweep(round);
        kept.gltf.sweep(round);
        kept.meshes.sweep(round);
        kept.mirrored.sweep(round);
    }

    /// A picture.
    ///
    /// # Errors
    /// Says why the file cannot be read.
    pub(super) fn texture(&self, path: &Path) -> Result<Arc<Texture>, String> {
        self.made(
            |kept| &mut kept.textures,
            path.to_owned(),
            |origins| {
                let bytes = self.read(path, MAX_PICTURE, origins)?;
                decode_texture(&bytes).map(Arc::new).map_err(|error| error.to_string())
            },
        )
    }

    /// Numbers in a file of this format.
    ///
    /// # Errors
    /// There is no such format, or the file cannot be read or is not of it.
    pub(super) fn data(&self, path: &Path, format: &str) -> Result<Arc<[f32]>, DecodeError> {
        // Said before the file is looked for: what is wrong is the module, whatever the file.
        decoder(format)?;
        self.made(
            |kept| &mut kept.data,
            (path.to_owned(), format.to_owned()),
            |origins| {
                let bytes = self.read(path, MAX_DATA, origins).map_err(DecodeError::Damaged)?;
                Ok(decode(format, &bytes)?.into())
            },
        )
    }

    /// A glTF file with what it refers to.
    ///
    /// # Errors
    /// As for [`gltf::load`].
    pub(super) fn gltf(&self, path: &Path) -> Result<Arc<Asset>, GltfError> {
        self.made(
            |kept| &mut kept.gltf,
            path.to_owned(),
            |origins| {
                let asset = gltf::load_with(path, &mut |path| self.read(path, MAX_FILE, origins))?;
                Ok(Arc::new(asset))
            },
        )
    }

    /// The mesh of a shape; `asset` is the file of a shape that names one, and what `load` gives for it.
    ///
    /// # Errors
    /// As for [`Shape::build`].
    pub(super) fn mesh(
        &self,
        shape: &Shape,
        asset: Option<Arc<Asset>>,
        load: impl FnOnce(&str) -> Result<Arc<Asset>, GltfError>,
    ) -> Result<Arc<Mesh>, MeshError> {
        let address = asset.as_ref().map_or(0, |asset| Arc::as_ptr(asset).addr());
        let make = |_: &mut Origins| Ok::<_, MeshError>((asset, Arc::new(shape.build(load)?)));
        let (_, mesh) = self.made(|kept| &mut kept.meshes, (format!("{shape:?}"), address), make)?;
        Ok(mesh)
    }

    /// The mesh for a model matrix that mirrors.
    pub(super) fn mirrored(&self, mesh: &Arc<Mesh>) -> Arc<Mesh> {
        let make = |_: &mut Origins| Ok::<_, Infallible>((Arc::clone(mesh), Arc::new(mesh.mirrored())));
        let Ok((_, mirror)) = self.made(|kept| &mut kept.mirrored, Arc::as_ptr(mesh).addr(), make);
        mirror
    }

    /// What is kept under this key, where what it was made from is still the same; else what `make` gives. Nothing is locked while it makes: of two
    /// threads that make the same, both keep what the first one has put there.
    fn made<K: Clone + Eq + std::hash::Hash, V: Clone, E>(
        &self,
        shelf: impl Fn(&mut Kept) -> &mut Shelf<K, V>,
        key: K,
        make: impl FnOnce(&mut Origins) -> Result<V, E>,
    ) -> Result<V, E> {
        let known = {
            let mut kept = lock(&self.kept);
            let round = kept.round;
            shelf(&mut kept).get(&key, round)
        };
        if let Some((value, origins)) = known
            && origins.iter().all(|(path, stamp)| self.stamp(path).as_ref() == Some(stamp))
        {
            return Ok(value);
        }
        let mut origins = Some(Vec::new());
        let value = make(&mut origins)?;
        let Some(origins) = origins else { return Ok(value) };
        let mut kept = lock(&self.kept);
        let round = kept.round;
        Ok(shelf(&mut kept).put(key, value, origins, round))
    }

    /// The bytes of a file, which is noted among the origins of what is made from it.
    fn read(&self, path: &Path, most: u64, origins: &mut Origins) -> Result<Vec<u8>, String> {
        if let Some(bytes) = self.in_memory(path) {
            if bytes.len() as u64 > most {
                return Err(format!("longer than the {most} bytes that a file may have"));
            }
            return Ok(bytes.to_vec());
        }
        if !self.source.disk {
            return Err("there is no such file".to_owned());
        }
        // Before it is read: a change that comes between is seen the next time.
        let lasting = self.stamp(path).filter(Stamp::is_settled);
        match (lasting, &mut *origins) {
            (Some(stamp), Some(origins)) => origins.push((path.to_owned(), stamp)),
            _ => *origins = None,
        }
        read_bytes(path, most)
    }

    fn in_memory(&self, path: &Path) -> Option<&Arc<[u8]>> {
        let name = name_of(path)?;
        let memory = &self.source.memory;
        let anywhere = || memory.get(name.rsplit('/').next()?);
        memory.get(&name).or_else(|| if self.source.disk { None } else { anywhere() })
    }

    /// The state of a file on disk, where the system tells.
    fn stamp(&self, path: &Path) -> Option<Stamp> {
        let about = std::fs::metadata(path).ok()?;
        Some(Stamp {
            modified: about.modified().ok()?,
            size: about.len(),
        })
    }
}

impl Stamp {
    /// Whether any change from now on shows.
    fn is_settled(&self) -> bool {
        self.modified.elapsed().is_ok_and(|age| age > TICK)
    }
}

/// The name of a path in memory, without `.` and `..`; `None` where it leads out of what is there.
fn name_of(path: &Path) -> Option<String> {
    let mut parts = Vec::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => drop(parts.pop()?),
            Component::Normal(part) => parts.push(part.to_str()?),
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(parts.join("/"))
}

#[cfg(test)]
mod tests;
