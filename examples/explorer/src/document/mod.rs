//! What is edited: a scene's text and its history.

mod edit;
mod list;

use std::path::PathBuf;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use shadewright_compiler::Report;
use shadewright_runtime::scene::{Files, SceneFile};

pub use edit::{Ancestor, quoted, ron_of, step_path};

/// Most steps that can be undone: a history of texts of a few kilobytes each.
const MOST_STEPS: usize = 500;

/// Everything that an edit changes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// What errors call the text: the file's path, or the example's name.
    pub name: String,
    /// The folder that files are named from.
    pub folder: PathBuf,
    /// RON of a scene that can be read.
    pub text: Arc<str>,
    /// Elements of lists that are switched off, by the list's path.
    pub parked: Vec<Parked>,
}

/// An element of a list that is switched off.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parked {
    /// Path of the list in the scene.
    pub list: String,
    /// Where it stood.
    pub index: usize,
    /// Its RON.
    pub text: String,
}

/// A scene that is being edited.
#[derive(Clone, Debug)]
pub struct Document {
    state: State,
    scene: SceneFile,
    undo: Vec<(String, State)>,
    redo: Vec<(String, State)>,
    /// The last edit may take the next one of the same name: a slider that is being moved.
    open: bool,
    /// The text that is on disk.
    saved: Arc<str>,
    /// Grows with every change.
    version: u64,
}

impl State {
    /// The state of a scene that was just read.
    pub fn of(scene: &SceneFile) -> Self {
        Self {
            name: scene.source().name.clone(),
            folder: scene.folder().to_owned(),
            text: scene.source().text.as_str().into(),
            parked: Vec::new(),
        }
    }

    /// Reads the text; files that it names are those.
    ///
    /// # Errors
    /// It is no scene.
    pub fn parse(&self, files: &Files) -> Result<SceneFile, Report> {
        Ok(SceneFile::parse(&self.name, &self.text, &self.folder)?.with_files(files.clone()))
    }
}

impl Document {
    /// A document without a history.
    pub fn new(scene: SceneFile) -> Self {
        let state = State::of(&scene);
        Self {
            saved: Arc::clone(&state.text),
            state,
            scene,
            undo: Vec::new(),
            redo: Vec::new(),
            open: false,
            version: 0,
        }
    }

    /// As it was left; it counts as changed where it is not what the disk has.
    ///
    /// # Errors
    /// The text is no scene.
    pub fn restored(state: State, saved: Arc<str>, files: &Files) -> Result<Self, Report> {
        let scene = state.parse(files)?;
        Ok(Self { saved, ..Self::new(scene) }.with(state))
    }

    fn with(mut self, state: State) -> Self {
        self.state = state;
        self
    }

    /// The scene.
    pub fn scene(&self) -> &SceneFile {
        &self.scene
    }

    /// Its files come from there from now on.
    pub fn use_files(&mut self, files: Files) {
        self.scene = self.scene.clone().with_files(files);
        self.version += 1;
    }

    /// What an edit changes.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Grows with every change.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Whether there is something that is not on disk.
    pub fn is_changed(&self) -> bool {
        self.state.text != self.saved
    }

    /// The text that is on disk.
    pub fn saved_text(&self) -> &Arc<str> {
        &self.saved
    }

    /// It is on disk now, under this name.
    pub fn saved(&mut self, name: String, folder: PathBuf) {
        self.state.name = name;
        self.state.folder = folder;
        self.saved = Arc::clone(&self.state.text);
        if let Ok(scene) = self.state.parse(self.scene.files()) {
            self.scene = scene;
        }
    }

    /// Changes it. `what` names the edit for people; nothing changes where `change` fails, or changes nothing.
    ///
    /// # Errors
    /// Those of `change`.
    pub fn edit(&mut self, what: &str, change: impl FnOnce(&mut Draft) -> Result<(), Report>) -> Result<(), Report> {
        self.open = false;
        self.continued(what, change)?;
        self.open = false;
        Ok(())
    }

    /// The same, but edits of one name in a row become one step: a slider that is moved, a camera that is turned. [`Document::close`] ends the step.
    ///
    /// # Errors
    /// Those of `change`.
    pub fn continued(&mut self, what: &str, change: impl FnOnce(&mut Draft) -> Result<(), Report>) -> Result<(), Report> {
        let mut draft = Draft {
            scene: self.scene.clone(),
            parked: self.state.parked.clone(),
        };
        change(&mut draft)?;
        let after = State {
            parked: draft.parked,
            ..State::of(&draft.scene)
        };
        if after == self.state {
            return Ok(());
        }
        let goes_on = self.open && self.undo.last().is_some_and(|(last, _)| last == what);
        let before = std::mem::replace(&mut self.state, after);
        if !goes_on {
            self.undo.push((what.to_owned(), before));
            if self.undo.len() > MOST_STEPS {
                self.undo.remove(0);
            }
        }
        self.redo.clear();
        self.open = true;
        self.scene = draft.scene;
        self.version += 1;
        Ok(())
    }

    /// Puts another text there with what is switched off in it, as one step. Name and folder stay.
    ///
    /// # Errors
    /// The text is no scene.
    pub fn replace(&mut self, what: &str, state: &State) -> Result<(), Report> {
        let files = self.scene.files().clone();
        let scene = SceneFile::parse(&self.state.name, &state.text, &self.state.folder)?.with_files(files);
        let parked = state.parked.clone();
        self.edit(what, |draft| {
            *draft = Draft { scene, parked };
            Ok(())
        })
    }

    /// Takes what is on disk by now, as one step.
    ///
    /// # Errors
    /// The text is no scene.
    pub fn take_over(&mut self, what: &str, text: Arc<str>) -> Result<(), Report> {
        let state = State {
            text: Arc::clone(&text),
            ..self.state.clone()
        };
        self.replace(what, &state)?;
        self.saved = text;
        Ok(())
    }

    /// The next edit is a step of its own.
    pub fn close(&mut self) {
        self.open = false;
    }

    /// Whether a step goes on: a slider is being moved.
    pub fn is_open(&self) -> bool {
        self.open
    }

    /// What would be undone.
    pub fn can_undo(&self) -> Option<&str> {
        self.undo.last().map(|(what, _)| what.as_str())
    }

    /// What would be done again.
    pub fn can_redo(&self) -> Option<&str> {
        self.redo.last().map(|(what, _)| what.as_str())
    }

    /// Takes back the last step, if there is one.
    pub fn undo(&mut self) {
        if let Some((what, state)) = self.undo.pop() {
            let after = self.go_to(state);
            self.redo.push((what, after));
        }
    }

    /// Does again what was taken back, if something was.
    pub fn redo(&mut self) {
        if let Some((what, state)) = self.redo.pop() {
            let before = self.go_to(state);
            self.undo.push((what, before));
        }
    }

    /// Puts a state there and gives back the one before. The file's name is no part of the history.
    fn go_to(&mut self, mut state: State) -> State {
        self.open = false;
        state.name.clone_from(&self.state.name);
        state.folder.clone_from(&self.state.folder);
        // Every state in the history was read before.
        if let Ok(scene) = state.parse(self.scene.files()) {
            self.scene = scene;
            self.version += 1;
            return std::mem::replace(&mut self.state, state);
        }
        self.state.clone()
    }
}

/// A scene in the middle of an edit.
#[derive(Clone, Debug)]
pub struct Draft {
    /// As it is so far.
    pub scene: SceneFile,
    /// Elements that are switched off.
    pub parked: Vec<Parked>,
}

#[cfg(test)]
mod tests;
