//! Pictures and texts of the present scene, as files.

use std::sync::atomic::AtomicBool;

use shadewright_compiler::Recipe;
use shadewright_compiler::manifest::Node;
use shadewright_runtime::gpu::RuntimeError;
use shadewright_runtime::image::{Hdr, encode_exr, encode_png};

use super::{Purpose, save};
use crate::work::{Bench, Job, News, Shot, Step, wrong};

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
            Ok(Ok(bytes)) => match save(&self.path, &bytes) {
                Ok(path) => News::Said(format!("wrote {path}")),
                Err(message) => failed(message),
            },
        });
        Step::Break(())
    }
}

impl Export {
    /// What goes into the file; within, why there is nothing to put there.
    fn bytes(&self, bench: &mut Bench) -> Result<Result<Vec<u8>, String>, RuntimeError> {
        match (self.purpose, &self.recipe) {
            (Purpose::Png | Purpose::Exr, _) => self.picture(bench),
            (Purpose::Recipe, Some(recipe)) => {
                let config = ron::ser::PrettyConfig::new();
                Ok(ron::ser::to_string_pretty(recipe, config)
                    .map(String::into_bytes)
                    .map_err(|error| error.to_string()))
            }
            (Purpose::Wgsl, Some(recipe)) => {
                let program = self.shot.catalog.compile(&Recipe::from(recipe.clone()), "main")?;
                Ok(Ok(program.wgsl().as_bytes().to_vec()))
            }
            _ => Ok(Err("nothing is selected that has a recipe".to_owned())),
        }
    }

    fn picture(&self, bench: &mut Bench) -> Result<Result<Vec<u8>, String>, RuntimeError> {
        let mut frame = self.shot.scene.frame(&self.shot.catalog, Some(self.size))?;
        let [width, height] = self.size;
        if self.purpose == Purpose::Exr {
            frame.display = None;
        }
        let renderer = bench.renderer(&self.shot.catalog);
        let targets = renderer.render(&frame)?;
        let gpu = renderer.gpu();
        let picture = match targets.read_display(gpu)? {
            Some(pixels) => encode_png(width, height, &pixels),
            None if self.purpose == Purpose::Png => return Ok(Err("the scene has no `display` pass: export an EXR".to_owned())),
            None => encode_exr(&Hdr {
                width,
                height,
                texels: targets.read_hdr(gpu)?,
                comment: "linear Rec.709, cd/m2".to_owned(),
            }),
        };
        Ok(picture.map_err(|error| error.to_string()))
    }
}
