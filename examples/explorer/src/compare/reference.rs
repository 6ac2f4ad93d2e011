//! A scene's truth: the same scene with what is true in each place.

use std::collections::BTreeSet;

use shadewright_compiler::{Catalog, Report};
use shadewright_runtime::scene::SceneFile;

use super::Truths;
use crate::document::Draft;
use crate::tree::{Row, choose, rows};
use crate::work::{links, reason};

/// A scene's truth, and how it was made.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The scene.
    pub scene: SceneFile,
    /// What stands for what.
    pub replaced: Vec<Replaced>,
    /// What should have been replaced and could not.
    pub left: Vec<Left>,
}

/// A place where something else stands in the truth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Replaced {
    /// The place.
    pub path: String,
    /// The module that stands there in the scene.
    pub from: String,
    /// The true one.
    pub to: String,
    /// The experiment that calls it true.
    pub experiment: String,
}

/// A place that stays as it is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Left {
    /// The place.
    pub path: String,
    /// The module that stands there.
    pub module: String,
    /// The true one.
    pub truth: String,
    /// Why that cannot stand there.
    pub reason: String,
}

/// The truth of a scene. Outer places come first: what is true there may have no inner ones.
pub fn reference(scene: &SceneFile, catalog: &Catalog, truths: &Truths) -> Reference {
    let mut draft = Draft {
        scene: scene.clone(),
        parked: Vec::new(),
    };
    let (mut replaced, mut left) = (Vec::new(), Vec::new());
    let mut decided = BTreeSet::new();
    loop {
        let rows = rows(&draft.scene, catalog, &[]);
        let next = rows
            .iter()
            .filter(|row| row.is_choice() && !decided.contains(&row.path))
            .find_map(|row| {
                let module = row.module.as_ref()?;
                Some((row, module, truths.of(module)?))
            });
        let Some((row, module, truth)) = next else {
            break;
        };
        decided.insert(row.path.clone());
        match put(&draft, catalog, row, truth) {
            Ok(after) => {
                draft = after;
                replaced.push(Replaced {
                    path: row.path.clone(),
                    from: module.name.clone(),
                    to: truth.module.name.clone(),
                    experiment: truth.experiment.clone(),
                });
            }
            Err(report) => left.push(Left {
                path: row.path.clone(),
                module: module.name.clone(),
                truth: truth.module.name.clone(),
                reason: reason(&report),
            }),
        }
    }
    Reference {
        scene: draft.scene,
        replaced,
        left,
    }
}

/// The draft with the truth in a place, if that is legal.
fn put(draft: &Draft, catalog: &Catalog, row: &Row, truth: &super::Truth) -> Result<Draft, Report> {
    let mut after = draft.clone();
    choose(&mut after, catalog, row, Some(&truth.module))?;
    links(catalog, &after.scene)?;
    Ok(after)
}

/// A scene seen from where another one is seen.
///
/// # Errors
/// The camera cannot be put there.
pub fn with_camera_of(scene: &SceneFile, present: Option<&str>) -> Result<SceneFile, Report> {
    match present {
        Some(camera) => scene.set("camera", camera),
        None if scene.get("camera").is_some() => scene.unset("camera"),
        None => Ok(scene.clone()),
    }
}
