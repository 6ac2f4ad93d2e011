//! Pictures and texts of the present scene, as files.

use std::sync::atomic::AtomicBool;

use shadewright_compiler::Recipe;
use shadewright_compiler::manifest::Node;
use shadewright_runtime::frame::{DisplayReading, HdrReading};
use shadewright_runtime::gpu::RuntimeError;
use shadewright_runtime::image::{Hdr, encode_exr, encode_png};

use super::{Purpose, save};
use crate::work::{Bench, Job, News, Progress, Shot, Step, wrong};

/// Makes a file of the present scene.
pub struct Export {
    /// The scene.
    pub shot: Shot,
    /// What is made of it.
    pub purpose: Purpose,
    /// The recipe that a text is made of.
    pub recipe: Option<Node>,
    /// Width and height of a picture, pixels.
    pub size: [u32; 2],
    /// Where it goes.
    pub path: String,
    /// The picture on its way from the GPU: `None` at first.
    pub reading: Option<Picture>,
}

/// A picture on its way from the GPU.
#[derive(Debug)]
pub enum Picture {
    /// As it is displayed.
    Display(DisplayReading),
    /// cd/m2.
    Linear(HdrReading),
}

impl Job for Export {
    fn kind(&self) -> &'static str {
        "export"
    }

    fn step(&mut self, bench: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let failed = |message: String| News::Failed {
            what: "exporting",
            message,
        };
        tell(match self.bytes(bench) {
            Err(error) => wrong(error, self.shot.version, self.kind()),
            Ok(Err(message)) => failed(message),
            Ok(Ok(None)) => {
                return Step::Continue(Progress {
                    what: "exporting".into(),
                    done: 1,
                    of: 2,
                });
            }
            Ok(Ok(Some(bytes))) => match save(&self.path, &bytes) {
                Ok(path) => News::Said(format!("wrote {path}")),
                Err(message) => failed(message),
            },
        });
        Step::Break(())
    }
}

impl Export {
    /// What goes into the file, once it is there; within, why there is nothing to put there.
    fn bytes(&mut self, bench: &mut Bench) -> Result<Result<Option<Vec<u8>>, String>, RuntimeError> {
        match (self.purpose, &self.recipe) {
            (Purpose::Png | Purpose::Exr, _) => self.picture(bench),
            (Purpose::Recipe, Some(recipe)) => {
                let config = ron::ser::PrettyConfig::new();
                Ok(ron::ser::to_string_pretty(recipe, config)
                    .map(|text| Some(text.into_bytes()))
                    .map_err(|error| error.to_string()))
            }
            (Purpose::Wgsl, Some(recipe)) => {
                let program = self.shot.catalog.compile(&Recipe::from(recipe.clone()), "main")?;
                Ok(Ok(Some(program.wgsl().as_bytes().to_vec())))
            }
            _ => Ok(Err("nothing is selected that has a recipe".to_owned())),
        }
    }

    fn picture(&mut self, bench: &mut Bench) -> Result<Result<Option<Vec<u8>>, String>, RuntimeError> {
        let [width, height] = self.size;
        let taken = match &mut self.reading {
            None => return Ok(self.start(bench)?.map(|()| None)),
            Some(Picture::Display(reading)) => match reading.take(bench.gpu()) {
                None => return Ok(Ok(None)),
                Some(pixels) => encode_png(width, height, &pixels?),
            },
            Some(Picture::Linear(reading)) => match reading.take(bench.gpu()) {
                None => return Ok(Ok(None)),
                Some(texels) => encode_exr(&Hdr {
                    width,
                    height,
                    texels: texels?,
                    comment: "linear Rec.709, cd/m2".to_owned(),
                }),
            },
        };
        Ok(taken.map(Some).map_err(|error| error.to_string()))
    }

    /// Draws the picture and has it sent to the host.
    fn start(&mut self, bench: &mut Bench) -> Result<Result<(), String>, RuntimeError> {
        let mut frame = self.shot.scene.frame(&self.shot.catalog, Some(self.size))?;
        if self.purpose == Purpose::Exr {
            frame.display = None;
        }
        let renderer = bench.renderer(&self.shot.catalog);
        let targets = renderer.render(&frame)?;
        let gpu = renderer.gpu();
        self.reading = Some(match targets.start_read_display(gpu)? {
            Some(reading) => Picture::Display(reading),
            None if self.purpose == Purpose::Png => return Ok(Err("the scene has no `display` pass: export an EXR".to_owned())),
            None => Picture::Linear(targets.start_read_hdr(gpu)?),
        });
        // A page waits for nothing, and asks again in its next frame.
        gpu.wait()?;
        Ok(Ok(()))
    }
}
