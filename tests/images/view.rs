//! From a scene to its HDR frame, and from a pixel back to the ray that it saw.

use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock};

use glam::DVec3;
use shadewright::compiler::Catalog;
use shadewright::runtime::frame::{Frame, Renderer, Targets};
use shadewright::runtime::gpu::Gpu;
use shadewright::runtime::scene::SceneFile;

pub static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::headless().unwrap_or_else(|e| panic!("{e}")));
pub static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| {
    let library = shadewright::modules::library();
    Arc::new(Catalog::load(library).unwrap_or_else(|e| panic!("{e}")))
});

/// An example scene's file.
pub fn example(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes").join(name)
}

/// An example scene.
pub fn read(name: &str) -> SceneFile {
    SceneFile::read(&example(name)).unwrap_or_else(|e| panic!("{e}"))
}

/// A scene from its text.
pub fn parse(text: &str) -> SceneFile {
    SceneFile::parse("test.scene.ron", text, Path::new("")).unwrap_or_else(|e| panic!("{e}"))
}

/// A scene with values changed.
pub fn set(file: &SceneFile, changes: &[(&str, &str)]) -> SceneFile {
    changes.iter().fold(file.clone(), |file, (path, value)| {
        file.set(path, value).unwrap_or_else(|e| panic!("{e}"))
    })
}

/// The frame that shows a scene.
pub fn frame(file: &SceneFile) -> Frame {
    file.frame(&CATALOG, None).unwrap_or_else(|e| panic!("{e}"))
}

/// Draws a frame.
pub fn draw(frame: &Frame) -> Targets {
    Renderer::new(&GPU, Arc::clone(&CATALOG))
        .render(frame)
        .unwrap_or_else(|e| panic!("{e}"))
}

/// An HDR frame with its size.
pub struct Picture {
    pub size: [u32; 2],
    pub texels: Vec<[f32; 4]>,
}

impl Picture {
    pub fn at(&self, column: u32, row: u32) -> [f32; 4] {
        self.texels[(row * self.size[0] + column) as usize]
    }

    /// Red of the texel, of scenes that are grey.
    pub fn grey(&self, column: u32, row: u32) -> f64 {
        let [r, g, b, _] = self.at(column, row);
        assert!(r == g && g == b, "{column} {row}: {:?} is not grey", self.at(column, row));
        f64::from(r)
    }

    /// All pixels, columns first.
    pub fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let [width, height] = self.size;
        (0..height).flat_map(move |row| (0..width).map(move |column| (column, row)))
    }

    /// Texels that hold a NaN or an infinite number.
    pub fn bad(&self) -> usize {
        self.texels.iter().filter(|t| t.iter().any(|v| !v.is_finite())).count()
    }

    /// The largest difference of a channel, relative to the larger of both.
    pub fn difference(&self, other: &Self) -> f64 {
        assert_eq!(self.size, other.size);
        let pairs = self.texels.iter().flatten().zip(other.texels.iter().flatten());
        pairs
            .map(|(a, b)| {
                let (a, b) = (f64::from(*a), f64::from(*b));
                if a == b { 0.0 } else { (a - b).abs() / a.abs().max(b.abs()) }
            })
            .fold(0.0, f64::max)
    }
}

/// Draws a frame and reads it back.
pub fn hdr(frame: &Frame) -> Picture {
    Picture {
        size: frame.size,
        texels: draw(frame).read_hdr(&GPU).unwrap_or_else(|e| panic!("{e}")),
    }
}

/// The scene's HDR frame, which has no NaN and no infinite number.
pub fn picture(file: &SceneFile) -> Picture {
    let picture = hdr(&frame(file));
    assert_eq!(picture.bad(), 0, "texels with NaN or infinity");
    picture
}

/// A pinhole camera, from the numbers that the scene has: no matrix, no runtime.
pub struct Pinhole {
    pub eye: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    size: [u32; 2],
}

pub fn vector(v: [f32; 3]) -> DVec3 {
    DVec3::from_array(v.map(f64::from))
}

impl Pinhole {
    pub fn of(file: &SceneFile) -> Self {
        let camera = file.scene().camera.expect("a camera");
        let size = file.scene().size;
        let eye = vector(camera.eye);
        let forward = (vector(camera.target) - eye).normalize();
        let right = forward.cross(vector(camera.up)).normalize();
        let half = (f64::from(camera.fov).to_radians() / 2.0).tan();
        Self {
            eye,
            forward,
            right: right * half * f64::from(size[0]) / f64::from(size[1]),
            up: right.cross(forward) * half,
            size,
        }
    }

    /// Direction of the ray through a pixel's centre, unit length.
    pub fn ray(&self, column: u32, row: u32) -> DVec3 {
        self.ray_at(f64::from(column) + 0.5, f64::from(row) + 0.5)
    }

    /// Direction of the ray through a place of the picture, in pixels from its upper left corner.
    pub fn ray_at(&self, x: f64, y: f64) -> DVec3 {
        let (x, y) = (2.0 * x / f64::from(self.size[0]) - 1.0, 1.0 - 2.0 * y / f64::from(self.size[1]));
        (self.forward + self.right * x + self.up * y).normalize()
    }
}
