//! Which rows of the tree a problem is about.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use shadewright_compiler::diagnostics::Label;
use shadewright_compiler::manifest::Locator;
use shadewright_compiler::{Recipe, Report};

use super::{Bench, Job, News, Shot, Step};
use crate::tree::{Row, Subject, row_of, subjects};

/// Finds the rows that problems are about.
pub struct Places {
    /// The scene.
    pub shot: Shot,
    /// Its rows.
    pub rows: Vec<Row>,
    /// What is wrong with it.
    pub reports: Vec<Report>,
}

/// What problems are about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Concerned {
    /// The problems.
    pub reports: Vec<Report>,
    /// Paths of rows, by the problems' diagnostics one after the other.
    pub rows: Vec<Vec<String>>,
}

impl Concerned {
    /// Whether a row is one of those.
    pub fn has(&self, path: &str) -> bool {
        self.rows.iter().flatten().any(|row| row == path)
    }
}

impl Job for Places {
    fn kind(&self) -> &'static str {
        "places"
    }

    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let scene = &self.shot.scene;
        // A scene that derives nothing has problems of its own text, which need no recipes.
        let frame = scene.frame(&self.shot.catalog, Some([16, 16])).ok();
        let subjects = frame.map_or_else(Vec::new, |frame| subjects(scene.scene(), &frame));
        let diagnostics = self.reports.iter().flat_map(|report| &report.diagnostics);
        let rows = diagnostics.map(|diagnostic| {
            let found: BTreeSet<String> = diagnostic.labels.iter().flat_map(|label| self.about(label, &subjects)).collect();
            found.into_iter().collect()
        });
        let rows = rows.collect();
        tell(News::Concerned(Concerned {
            rows,
            reports: std::mem::take(&mut self.reports),
        }));
        Step::Break(())
    }
}

impl Places {
    /// The rows that a place in a text is about.
    fn about(&self, label: &Label, subjects: &[Subject]) -> Vec<String> {
        let source = self.shot.scene.source();
        if label.file.text == source.text && label.file.name == source.name {
            let path = Locator::new(&source.text).path_at(label.span.start);
            return nearest(&self.rows, &path).into_iter().collect();
        }
        let of_recipe: Vec<String> = subjects
            .iter()
            .filter(|subject| Recipe::from((*subject.recipe).clone()).source == label.file)
            .filter_map(|subject| {
                let place = slot_path(&Locator::new(&label.file.text).path_at(label.span.start));
                row_of(&self.rows, subject, &place).map(|row| row.path.clone())
            })
            .collect();
        if !of_recipe.is_empty() {
            return of_recipe;
        }
        // A file of a module: every place where it stands.
        let Some((folder, _)) = label.file.name.rsplit_once('/') else {
            return Vec::new();
        };
        let is_of = |row: &&Row| {
            let module = row.module.as_ref();
            module.is_some_and(|module| folder == format!("{}/{}", module.category, module.name))
        };
        self.rows.iter().filter(is_of).map(|row| row.path.clone()).collect()
    }
}

/// Path of the row that holds a path of the scene, the innermost one.
fn nearest(rows: &[Row], path: &str) -> Option<String> {
    let path = plain(path);
    let holds = |row: &&Row| {
        let rest = path.strip_prefix(&plain(&row.path));
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    rows.iter()
        .filter(holds)
        .max_by_key(|row| row.path.len())
        .map(|row| row.path.clone())
}

/// A path with all its names behind dots: `materials.two words` for `materials[two words]`.
fn plain(path: &str) -> String {
    let mut plain = String::new();
    let mut rest = path;
    while let Some((before, inside)) = rest.split_once('[') {
        let (step, after) = inside.split_once(']').unwrap_or((inside, ""));
        let is_index = step.bytes().all(|byte| byte.is_ascii_digit());
        plain += before;
        plain += &if is_index { format!("[{step}]") } else { format!(".{step}") };
        rest = after;
    }
    plain + rest
}

/// A path in a recipe's text as a slot path: `main.brdf.ndf` for `fill.brdf.fill.ndf.module`.
fn slot_path(path: &str) -> String {
    let mut place = "main".to_owned();
    let mut steps = path.split('.');
    while let (Some("fill"), Some(slot)) = (steps.next(), steps.next()) {
        place = format!("{place}.{slot}");
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches names with spaces that are not found, an index taken for a name, and a slot called like another's beginning.
    #[test]
    fn paths_are_told_in_the_trees_way() {
        assert_eq!(plain("materials[two words].brdf"), "materials.two words.brdf");
        assert_eq!(plain("lights[0].fill.a[1]"), "lights[0].fill.a[1]");
        assert_eq!(slot_path("fill.light[1].fill.visibility.module"), "main.light[1].visibility");
        assert_eq!(slot_path("freeze.x"), "main");
        let row = |path: &str| Row {
            path: path.into(),
            depth: 1,
            kind: crate::tree::Kind::Material,
            label: String::new(),
            module: None,
            is_stated: true,
            above: Vec::new(),
            through: Vec::new(),
        };
        let rows = [
            row("materials"),
            row("materials.a"),
            row("materials[a b]"),
            row("materials[a b].brdf"),
        ];
        assert_eq!(nearest(&rows, "materials.a b.brdf.module").as_deref(), Some("materials[a b].brdf"));
        assert_eq!(nearest(&rows, "materials.ax.brdf").as_deref(), Some("materials"));
        assert_eq!(nearest(&rows, "lights[0]"), None);
    }
}
