//! What is linked for a scene: a shader for each material and one for the display, and the rows that their modules stand in.

use std::sync::Arc;

use shadewright_compiler::manifest::Node;
use shadewright_runtime::frame::Frame;
use shadewright_runtime::scene::Scene;

use super::{Kind, Row};
use crate::document::step_path;

/// A recipe that a scene is drawn with.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Path of the row that it is made from; of a material's second recipe with `#2` behind it.
    pub key: String,
    /// What people call it.
    pub name: String,
    /// Path of the row that it is made from.
    pub root: String,
    /// The tree.
    pub recipe: Arc<Node>,
    /// By the recipe's list of lights: path of the first light of the kind.
    pub lights: Arc<[String]>,
}

/// The recipes of a scene, materials in the order of their first objects, the display last. Materials that no object has are not linked.
pub fn subjects(scene: &Scene, frame: &Frame) -> Vec<Subject> {
    let kinds = frame.lights.iter().map(|kind| {
        let is_of = |light: &&_| is_of(kind, light);
        let first = scene.lights.iter().position(|light| is_of(&light));
        first.map_or_else(|| "lights".to_owned(), |index| format!("lights[{index}]"))
    });
    let lights: Arc<[String]> = kinds.collect();
    let mut subjects: Vec<Subject> = Vec::new();
    let mut add = |root: String, name: String, recipe: &Arc<Node>| {
        let same = |known: &&Subject| known.root == root;
        let (count, known) = (
            subjects.iter().filter(same).count(),
            subjects.iter().filter(same).any(|s| Arc::ptr_eq(&s.recipe, recipe)),
        );
        if known {
            return;
        }
        let suffix = if count == 0 { String::new() } else { format!("#{}", count + 1) };
        subjects.push(Subject {
            key: format!("{root}{suffix}"),
            name: format!("{name}{}", suffix.replace('#', " ")),
            root,
            recipe: Arc::clone(recipe),
            lights: Arc::clone(&lights),
        });
    };
    // A frame has the scene's objects first, without those that neither are seen nor cast a shadow.
    let mut objects = scene.objects.iter().filter(|object| object.visible || object.casts_shadow);
    for draw in &frame.draws {
        let Some(material) = frame.materials.get(draw.material) else {
            continue;
        };
        match objects.next() {
            Some(object) => {
                let root = format!("materials{}", step_path(&object.material));
                add(root, object.material.clone(), &material.recipe);
            }
            None => {
                let name = scene.gltf.first().map_or("glTF", |gltf| gltf.file.as_str());
                add("gltf[0]".to_owned(), name.to_owned(), &material.recipe);
            }
        }
    }
    if let Some(display) = &frame.display {
        add("display".to_owned(), "display".to_owned(), &display.recipe);
    }
    subjects
}

/// Whether a light of the scene is of a kind.
fn is_of(kind: &shadewright_runtime::frame::Lights, light: &shadewright_runtime::scene::LightDecl) -> bool {
    kind.node.module == light.module && kind.instances.contains(&light.fields)
}

/// The row of a slot path (`main.brdf.ndf`) of a subject, or the nearest one above it.
pub fn row_of<'r>(rows: &'r [Row], subject: &Subject, place: &str) -> Option<&'r Row> {
    let mut steps = place.split('.').skip(1).peekable();
    let Some(first) = steps.peek() else {
        // The root is the pass itself.
        let pass = if subject.root == "display" { "display" } else { "pass" };
        return rows.iter().find(|row| row.path == pass);
    };
    let mut at = rows.iter().position(|row| row.path == subject.root)?;
    let (name, index) = split(first);
    if child(rows, at, name).is_none()
        && let Some(light) = index.and_then(|index| subject.lights.get(index))
    {
        // Lights are no material's own.
        at = rows.iter().position(|row| row.path == *light)?;
        steps.next();
    }
    for step in steps {
        let (name, index) = split(step);
        let Some(slot) = child(rows, at, name) else { break };
        at = slot;
        let is_element = |row: &Row| matches!(row.kind, Kind::Element { index: of, .. } if Some(of) == index);
        if let Some(element) = below(rows, at).find(|&row| is_element(&rows[row])) {
            at = element;
        }
    }
    rows.get(at)
}

/// `lights[1]` as its name and number.
fn split(step: &str) -> (&str, Option<usize>) {
    match step.split_once('[') {
        Some((name, rest)) => (name, rest.trim_end_matches(']').parse().ok()),
        None => (step, None),
    }
}

/// The rows directly below one.
fn below(rows: &[Row], at: usize) -> impl Iterator<Item = usize> {
    let depth = rows.get(at).map_or(0, |row| row.depth);
    let inside = (at + 1..rows.len()).take_while(move |&row| rows[row].depth > depth);
    inside.filter(move |&row| rows[row].depth == depth + 1)
}

fn child(rows: &[Row], at: usize, label: &str) -> Option<usize> {
    below(rows, at).find(|&row| rows[row].label == label)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use shadewright_compiler::{Catalog, Recipe};
    use shadewright_runtime::scene::SceneFile;

    use super::*;

    /// Catches a module of linked code that leads to another row than the one that chooses it, and a material or the display without its recipe.
    #[test]
    fn every_module_of_a_recipe_has_its_row() {
        let catalog = Catalog::load(shadewright_modules::library()).unwrap();
        for example in crate::scenes::ALL {
            let scene = SceneFile::parse(example.name, example.text, Path::new("../scenes")).unwrap();
            let frame = scene.frame(&catalog, Some([16, 16])).unwrap();
            let rows = crate::tree::rows(&scene, &catalog, &[]);
            let subjects = subjects(scene.scene(), &frame);
            assert!(subjects.len() >= 2, "{}", example.name);
            for subject in &subjects {
                let recipe = Recipe::from((*subject.recipe).clone());
                let program = catalog.compile(&recipe, "main").unwrap();
                for line in program.tree() {
                    let row = row_of(&rows, subject, &line.path).unwrap_or_else(|| panic!("{}", line.path));
                    let module = row.module.as_ref().map(|module| module.name.as_str());
                    if row.path != "display" {
                        assert_eq!(module, Some(line.module), "{} of {} at {}", line.path, subject.key, row.path);
                    }
                }
            }
        }
    }
}
