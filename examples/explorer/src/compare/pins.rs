//! Permutations that are kept to go back to, and to compare with.

use std::collections::BTreeMap;

use eframe::egui::{ColorImage, TextureHandle};
use serde::{Deserialize, Serialize};
use shadewright_runtime::scene::SceneFile;

use crate::document::{State, step_path};
use crate::tree::Row;

/// Most differences that make a name.
const MOST_WORDS: usize = 3;

/// A permutation that is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pin {
    /// Its own, as long as there are pins.
    pub id: u64,
    /// What it is called.
    pub name: String,
    /// What an edit changes.
    pub state: State,
    /// What was chosen where, and what it was told.
    pub features: BTreeMap<String, String>,
}

/// The pins, oldest first.
#[derive(Default)]
pub struct Pins {
    /// All of them.
    pub all: Vec<Pin>,
    /// Small pictures, by the pin's id. None while it is being drawn.
    pub pictures: BTreeMap<u64, Thumbnail>,
}

/// A small picture on its way to the screen.
pub enum Thumbnail {
    /// Asked for.
    Asked,
    /// Drawn.
    Drawn(ColorImage),
    /// In the window's memory.
    Shown(TextureHandle),
    /// It cannot be drawn.
    Failed,
}

/// What is chosen in a scene and told to what is chosen, by path.
pub fn features(scene: &SceneFile, rows: &[Row]) -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    if let Some(camera) = scene.get("camera") {
        found.insert("camera".to_owned(), camera.to_owned());
    }
    for row in rows {
        let Some(module) = &row.module else { continue };
        found.insert(row.path.clone(), module.name.clone());
        let params = module.manifest.params.keys();
        let told = params.flat_map(|name| ["params", "freeze"].map(|part| (part, name)));
        let fields = module.manifest.instances.keys().map(|name| ("fields", name));
        for (part, name) in told.chain(fields) {
            let path = format!("{}.{part}{}", row.path, step_path(name));
            if let Some(value) = scene.get(&path) {
                found.insert(path, value.to_owned());
            }
        }
    }
    found
}

/// A name made of what is different from the pin that is most like it.
pub fn name_of(title: &str, now: &BTreeMap<String, String>, pins: &[Pin]) -> String {
    let differences = |pin: &Pin| {
        let paths = now.keys().chain(pin.features.keys().filter(|path| !now.contains_key(*path)));
        let changed = paths.filter(|path| now.get(*path) != pin.features.get(*path));
        changed.cloned().collect::<Vec<String>>()
    };
    let mut name = match pins.iter().map(differences).min_by_key(Vec::len) {
        None => title.to_owned(),
        Some(paths) if paths.is_empty() => format!("{title} again"),
        Some(paths) => words(now, &paths),
    };
    let taken = |name: &str| pins.iter().any(|pin| pin.name == name);
    if taken(&name) {
        let free = (2..).map(|n| format!("{name} ({n})")).find(|name| !taken(name));
        name = free.unwrap_or(name);
    }
    name
}

/// `brdf lambert, roughness 0.3`.
fn words(now: &BTreeMap<String, String>, paths: &[String]) -> String {
    // What is below something that changed changed with it.
    let outer = |path: &String| {
        let inside = |other: &String| other != path && path.strip_prefix(other.as_str()).is_some_and(|rest| rest.starts_with(['.', '[']));
        !paths.iter().any(inside)
    };
    let outer: Vec<&String> = paths.iter().filter(|path| outer(path)).collect();
    let word = |path: &&String| {
        let last = path.rsplit('.').next().unwrap_or(path.as_str());
        match now.get(*path) {
            _ if path.as_str() == "camera" => "camera".to_owned(),
            Some(value) if value.len() <= 24 => format!("{last} {}", value.trim_matches('"')),
            Some(_) => last.to_owned(),
            None => format!("no {last}"),
        }
    };
    let mut all: Vec<String> = outer.iter().take(MOST_WORDS).map(word).collect();
    if outer.len() > MOST_WORDS {
        all.push(format!("and {} more", outer.len() - MOST_WORDS));
    }
    all.join(", ")
}

impl Pins {
    /// Keeps a permutation.
    pub fn add(&mut self, title: &str, state: State, features: BTreeMap<String, String>) -> u64 {
        let id = self.all.iter().map(|pin| pin.id + 1).max().unwrap_or(1);
        let name = name_of(title, &features, &self.all);
        self.all.push(Pin { id, name, state, features });
        id
    }

    /// The pin with this id.
    pub fn get(&self, id: u64) -> Option<&Pin> {
        self.all.iter().find(|pin| pin.id == id)
    }

    /// Forgets a pin and its picture.
    pub fn remove(&mut self, id: u64) {
        self.all.retain(|pin| pin.id != id);
        self.pictures.remove(&id);
    }

    /// The first pin whose picture was not asked for.
    pub fn without_picture(&self) -> Option<&Pin> {
        self.all.iter().find(|pin| !self.pictures.contains_key(&pin.id))
    }
}
