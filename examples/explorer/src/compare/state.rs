//! What comparing remembers, and what its jobs tell.

use std::sync::Arc;

use eframe::egui::{ColorImage, TextureHandle, TextureId};
use eframe::egui_wgpu::{RenderState, wgpu};
use shadewright_compiler::Catalog;
use shadewright_runtime::frame::Targets;

use super::{Errors, Left, Pins, Replaced, Truths, Values};
use crate::work::Alternative;

/// What the viewport shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// The present scene.
    #[default]
    Alone,
    /// The present scene to the left of a line, another one to its right.
    Split,
    /// How far the present scene is from the other one.
    Difference,
    /// How far the present scene is from its truth.
    Error,
}

impl Mode {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Alone, Self::Split, Self::Difference, Self::Error];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Alone => "Picture",
            Self::Split => "Split",
            Self::Difference => "Difference",
            Self::Error => "Error",
        }
    }

    /// What it shows.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Alone => "The present scene alone",
            Self::Split => "The present scene to the left of the line, the other one to its right",
            Self::Difference => "The present scene against the other one: red is too bright, blue too dark",
            Self::Error => "The present scene against its truth: red is too bright, blue too dark",
        }
    }
}

/// With what the present scene is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Other {
    /// The same scene with what is true in each place.
    #[default]
    Reference,
    /// A pin, by its id.
    Pin(u64),
}

/// What jobs of comparing tell.
#[derive(Debug)]
pub enum Told {
    /// What the library's experiments call true.
    Truths(Arc<Catalog>, Result<Arc<Truths>, String>),
    /// The second picture, or numbers of the first.
    Beside(Box<Beside>),
    /// How a scene's truth was made.
    Reference {
        /// Of which shot.
        version: u64,
        /// What stands for what.
        replaced: Vec<Replaced>,
        /// What stays.
        left: Vec<Left>,
    },
    /// The truth's picture, better than before.
    Refined(Box<Refined>),
    /// A heat map.
    Heat(ColorImage),
    /// A pin's small picture, or why there is none.
    Thumbnail(u64, Result<ColorImage, String>),
    /// Alternatives of a slot will follow.
    Sweep(SweepView),
    /// One of them.
    Alternative(Box<Alternative>),
    /// A sheet was written, or not.
    Sheet(Result<String, String>),
    /// A job could not be done.
    Failed(&'static str, String),
}

/// What a second picture is drawn of: equal ones give equal pictures.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// The pin.
    pub pin: u64,
    /// From where it is seen; none where a file says so.
    pub camera: Option<String>,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The library's version.
    pub library: usize,
}

/// The second picture, and numbers of both.
#[derive(Debug)]
pub struct Beside {
    /// The first picture: its version and size.
    pub first: (u64, [u32; 2]),
    /// The second one, where there is one.
    pub second: Option<(Drawn, Targets)>,
    /// Values of the first.
    pub first_values: Option<Values>,
    /// Values of the second.
    pub second_values: Option<Values>,
    /// The first against the second.
    pub errors: Option<Arc<Errors>>,
}

/// The truth's picture.
#[derive(Debug)]
pub struct Refined {
    /// Of which shot.
    pub version: u64,
    /// How many of the viewport's pixels one of its is wide.
    pub divisor: u32,
    /// As it is shown, on the GPU.
    pub display: wgpu::Texture,
    /// Its numbers.
    pub values: Values,
    /// The present scene, drawn in the same size, against it.
    pub errors: Arc<Errors>,
}

/// Alternatives of a slot, as far as they are known.
#[derive(Clone, Debug)]
pub struct SweepView {
    /// Of which shot.
    pub version: u64,
    /// The slot.
    pub path: String,
    /// The module that stands there.
    pub present: String,
    /// What errors are against.
    pub against: String,
    /// Width and height of the pictures.
    pub size: [u32; 2],
    /// How many there will be.
    pub of: usize,
    /// How many there are more than are drawn; none where that was not counted.
    pub cut: u128,
    /// Those that are known.
    pub alternatives: Vec<Arc<Alternative>>,
}

/// A picture of the GPU on the screen.
#[derive(Default)]
pub struct Screen {
    id: Option<TextureId>,
}

impl Screen {
    /// Shows a picture of the GPU in the place of the one before.
    pub fn show(&mut self, render: &RenderState, texture: &wgpu::Texture) {
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut renderer = render.renderer.write();
        match self.id {
            Some(id) => renderer.update_egui_texture_from_wgpu_texture(&render.device, &view, wgpu::FilterMode::Linear, id),
            None => self.id = Some(renderer.register_native_texture(&render.device, &view, wgpu::FilterMode::Linear)),
        }
    }

    /// For egui.
    pub fn id(&self) -> Option<TextureId> {
        self.id
    }

    /// Shows nothing any more.
    pub fn clear(&mut self, render: &RenderState) {
        if let Some(id) = self.id.take() {
            render.renderer.write().free_texture(&id);
        }
    }
}

/// What comparing remembers.
pub struct Compare {
    /// What the viewport shows.
    pub mode: Mode,
    /// With what.
    pub other: Other,
    /// Where the line stands, as a share of the width.
    pub split: f32,
    /// The error that has the full colour.
    pub full: f64,
    /// Whether values under the mouse are shown.
    pub probe: bool,
    /// What is kept.
    pub pins: Pins,
    /// What is true, for a library.
    pub truths: Option<(Arc<Catalog>, Arc<Truths>)>,
    /// Whether the truth is drawn in the background.
    pub is_refining: bool,
    /// How the truth was made, for a version.
    pub made: Option<(u64, Vec<Replaced>, Vec<Left>)>,
    /// The truth's picture.
    pub refined: Option<Box<Refined>>,
    /// The other picture.
    pub beside: Option<Box<Beside>>,
    /// The heat map.
    pub heat: Option<TextureHandle>,
    /// The heat map on its way to the window's memory.
    pub new_heat: Option<ColorImage>,
    /// Alternatives of a slot.
    pub sweep: Option<SweepView>,
    /// Their pictures in the window's memory, by number.
    pub tiles: Vec<TextureHandle>,
    /// Path of a space whose permutations the sheet shows instead of a slot's modules.
    pub space: String,
    /// Where the sheet is written.
    pub sheet_path: String,
    /// What went wrong last.
    pub problem: String,
    /// The truth on the screen.
    pub truth_screen: Screen,
    /// The pin on the screen.
    pub pin_screen: Screen,
    pub(crate) asked: Asked,
}

/// What was asked for last, so that it is asked for once.
#[derive(Default)]
pub(crate) struct Asked {
    pub truths: Option<Arc<Catalog>>,
    pub refine: Option<(u64, [u32; 2])>,
    pub beside: Option<BesideKey>,
    pub heat: Option<(Arc<Errors>, f64)>,
    pub sweep: Option<(u64, String, String)>,
}

/// The first picture, the second one, and whether numbers are wanted.
pub(crate) type BesideKey = ((u64, [u32; 2]), Option<Drawn>, bool);

impl Default for Compare {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            other: Other::default(),
            split: 0.5,
            full: shadewright_report::write::FULL,
            probe: false,
            pins: Pins::default(),
            truths: None,
            is_refining: false,
            made: None,
            refined: None,
            beside: None,
            heat: None,
            new_heat: None,
            sweep: None,
            tiles: Vec::new(),
            space: String::new(),
            sheet_path: String::new(),
            problem: String::new(),
            truth_screen: Screen::default(),
            pin_screen: Screen::default(),
            asked: Asked::default(),
        }
    }
}

impl Compare {
    /// Everything of the scene that was edited so far is forgotten.
    pub fn forget(&mut self, render: &RenderState) {
        self.truth_screen.clear(render);
        self.pin_screen.clear(render);
        *self = Self {
            mode: Mode::Alone,
            full: self.full,
            probe: self.probe,
            truths: self.truths.take(),
            is_refining: self.is_refining,
            sheet_path: std::mem::take(&mut self.sheet_path),
            ..Self::default()
        };
    }

    /// Errors that the heat map shows in the present mode.
    pub fn errors(&self) -> Option<&Arc<Errors>> {
        let of_truth = || self.refined.as_ref().map(|refined| &refined.errors);
        match (self.mode, self.other) {
            (Mode::Alone, _) => None,
            (Mode::Error, _) | (_, Other::Reference) => of_truth(),
            (_, Other::Pin(_)) => self.beside.as_ref()?.errors.as_ref(),
        }
    }

    /// What the other picture is called.
    pub fn other_name(&self) -> String {
        match self.other {
            _ if self.mode == Mode::Error => "reference".to_owned(),
            Other::Reference => "reference".to_owned(),
            Other::Pin(id) => self.pins.get(id).map(|pin| pin.name.clone()).unwrap_or_default(),
        }
    }
}
