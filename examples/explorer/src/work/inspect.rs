//! Linked code, looked at: one pass of one recipe of the scene, in one language.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::manifest::PassDecl;
use shadewright_compiler::reflect::Pass;
use shadewright_compiler::{Program, Recipe, Report, Target, emit};
use shadewright_evaluate::cost::{Analysis, cost_of};
use shadewright_runtime::frame::Frame;

use super::listing::Listing;
use super::{Bench, Job, News, Shot, Step};
use crate::tree::{Subject, subjects};

/// A language that code is shown in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Language {
    /// WGSL as the authors wrote it, linked.
    #[default]
    Source,
    /// What naga writes.
    Written(Target),
}

impl Language {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::Source,
        Self::Written(Target::WgslFromIr),
        Self::Written(Target::SpirV),
        Self::Written(Target::Glsl),
        Self::Written(Target::Hlsl),
        Self::Written(Target::Msl),
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Source => "WGSL, linked source",
            Self::Written(Target::WgslFromIr) => "WGSL from IR",
            Self::Written(target) => target.name(),
        }
    }

    /// How files of it end.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Source | Self::Written(Target::WgslFromIr) => "wgsl",
            Self::Written(Target::SpirV) => "spv",
            Self::Written(Target::Glsl) => "glsl",
            Self::Written(Target::Hlsl) => "hlsl",
            Self::Written(Target::Msl) => "metal",
        }
    }

    /// Whether it may be asked for one entry point at a time.
    pub fn takes_entry(self) -> bool {
        matches!(self, Self::Written(Target::Glsl))
    }
}

/// What is looked at. What does not exist (any more) stands for the first that does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct View {
    /// [`Subject::key`].
    pub subject: String,
    /// `main`, or `<instance>.<pass>`.
    pub pass: String,
    /// The language.
    pub language: Language,
    /// The entry point, of a language that wants one.
    pub entry: String,
}

/// Links and writes what is looked at.
pub struct Inspect {
    /// The scene.
    pub shot: Shot,
    /// Its frame, where that is there already.
    pub frame: Option<Arc<Frame>>,
    /// What of it.
    pub view: View,
}

/// What was looked at.
#[derive(Debug)]
pub struct Inspected {
    /// Of which shot.
    pub version: u64,
    /// As it was asked for.
    pub asked: View,
    /// What was found.
    pub made: Result<Made, Report>,
}

/// One pass of a recipe, from all sides.
#[derive(Debug)]
pub struct Made {
    /// As it is: with what stands for what does not exist.
    pub view: View,
    /// All recipes.
    pub subjects: Vec<Subject>,
    /// Which of them.
    pub subject: usize,
    /// Names of the recipe's passes.
    pub passes: Vec<String>,
    /// What the pass is, where a module declares it.
    pub pass: Option<Pass>,
    /// Where that module stands in the recipe: the row of all that is in a tree of the pass's own.
    pub declared_at: String,
    /// It, linked.
    pub program: Arc<Program>,
    /// What its entry points hold.
    pub costs: Vec<(String, Analysis)>,
    /// Its text.
    pub listing: Result<Listing, Report>,
}

impl Made {
    /// The recipe.
    pub fn subject(&self) -> &Subject {
        &self.subjects[self.subject]
    }

    /// A slot path of the program as one of the subject's recipe: a pass with a tree of its own has what it inherits in common with that.
    pub fn place<'p>(&'p self, place: &'p str) -> &'p str {
        let Some(PassDecl::Draw { inherit, .. }) = self.pass.as_ref().map(|pass| &pass.declared) else {
            return place;
        };
        let slot = place.split(['.', '[']).nth(1).unwrap_or_default();
        if inherit.iter().any(|inherited| inherited == slot) {
            place
        } else {
            &self.declared_at
        }
    }
}

impl Job for Inspect {
    fn kind(&self) -> &'static str {
        "code"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        tell(News::Inspected(Box::new(Inspected {
            version: self.shot.version,
            asked: self.view.clone(),
            made: inspect(&self.shot, self.frame.as_deref(), &self.view),
        })));
        Step::Break(())
    }
}

/// Links and writes.
///
/// # Errors
/// The scene is wrong, or draws nothing.
pub fn inspect(shot: &Shot, frame: Option<&Frame>, view: &View) -> Result<Made, Report> {
    let derived;
    let frame = match frame {
        Some(frame) => frame,
        None => {
            derived = shot.scene.frame(&shot.catalog, Some([16, 16]))?;
            &derived
        }
    };
    let subjects = subjects(shot.scene.scene(), frame);
    let subject = subjects.iter().position(|subject| subject.key == view.subject).unwrap_or_default();
    let Some(chosen) = subjects.get(subject) else {
        return Err(shadewright_compiler::Diagnostic::new(
            shadewright_compiler::diagnostics::codes::SCENE_INVALID,
            "the scene draws nothing",
        )
        .into());
    };
    let recipe = Recipe::from((*chosen.recipe).clone());
    let main = shot.catalog.compile(&recipe, "main")?;
    let name = |pass: &Pass| format!("{}.{}", pass.instance, pass.name);
    let mut passes = vec!["main".to_owned()];
    passes.extend(main.reflection().passes.iter().map(name));
    let pass = main.reflection().passes.iter().find(|pass| name(pass) == view.pass).cloned();
    let declares = pass
        .as_ref()
        .and_then(|pass| main.reflection().instances.iter().find(|i| i.name == pass.instance));
    let declared_at = declares.and_then(|instance| instance.paths.first()).cloned().unwrap_or_default();
    let program = match &pass {
        Some(_) => shot.catalog.compile(&recipe, &view.pass)?,
        None => main,
    };
    let entries = &program.reflection().entry_points;
    let entry = entries.iter().find(|entry| entry.name == view.entry).or(entries.first());
    let entry = entry.map(|entry| entry.name.clone()).unwrap_or_default();
    let listing = match view.language {
        Language::Source => Ok(Listing::new(program.wgsl(), program.origins())),
        Language::Written(target) => {
            let one = view.language.takes_entry().then_some(entry.as_str());
            emit(program.validated(), target, one).map(|bytes| match target {
                Target::SpirV => Listing::of_words(bytes),
                _ => Listing::new(&String::from_utf8_lossy(&bytes), Vec::new()),
            })
        }
    };
    let validated = program.validated();
    let cost = |name: &String| Some((name.clone(), cost_of(validated.module(), validated.info(), name)?));
    let costs = entries.iter().filter_map(|entry| cost(&entry.name)).collect();
    Ok(Made {
        view: View {
            subject: chosen.key.clone(),
            pass: if pass.is_some() { view.pass.clone() } else { "main".to_owned() },
            language: view.language,
            entry,
        },
        subject,
        passes,
        pass,
        declared_at,
        costs,
        listing,
        program: Arc::new(program),
        subjects,
    })
}
