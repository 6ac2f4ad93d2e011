//! Asks for a path: a field to type it, and the files of its folder to click.

use std::path::{Path, PathBuf};

use eframe::egui::{self, Key, Modal, ScrollArea, TextEdit};

/// What the path is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// A scene, glTF, or whatever can be dropped on the window.
    Open,
    /// The scene, under another name.
    SaveAs,
    /// The picture as it is displayed.
    Png,
    /// The linear frame, cd/m2.
    Exr,
    /// The shader of what is selected.
    Wgsl,
    /// The recipe of what is selected.
    Recipe,
    /// The code that is shown.
    Code,
    /// The user's folder of modules.
    Modules,
}

impl Purpose {
    /// Of the dialog and of its button in the menu.
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "Open...",
            Self::SaveAs => "Save as...",
            Self::Png => "Export PNG...",
            Self::Exr => "Export EXR...",
            Self::Wgsl => "Export WGSL...",
            Self::Recipe => "Export recipe...",
            Self::Code => "Save code...",
            Self::Modules => "Modules folder...",
        }
    }

    /// The end of the name of such a file.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Open | Self::SaveAs => ".scene.ron",
            Self::Png => ".png",
            Self::Exr => ".exr",
            Self::Wgsl => ".wgsl",
            Self::Recipe => ".recipe.ron",
            Self::Code | Self::Modules => "",
        }
    }

    fn makes_a_file(self) -> bool {
        !matches!(self, Self::Open | Self::Modules)
    }
}

/// The dialog while it is open.
#[derive(Clone, Debug)]
pub struct Dialog {
    /// What for.
    pub purpose: Purpose,
    /// What is typed.
    pub path: String,
    /// The folder that is listed, and what is in it.
    listed: Option<(PathBuf, Vec<Entry>)>,
    /// The field takes the keyboard.
    focus: bool,
    /// The file is there; a second click replaces it.
    warned: Option<String>,
}

#[derive(Clone, Debug)]
struct Entry {
    name: String,
    is_folder: bool,
}

/// How a dialog ended.
pub enum Answer {
    /// It is still open.
    Open,
    /// Nothing was chosen.
    Cancelled,
    /// This path was.
    Chosen(String),
}

impl Dialog {
    /// Asks, beginning with a path.
    pub fn new(purpose: Purpose, path: String) -> Self {
        Self {
            purpose,
            path,
            listed: None,
            focus: true,
            warned: None,
        }
    }

    /// Shows it.
    pub fn show(&mut self, context: &egui::Context) -> Answer {
        let mut answer = Answer::Open;
        let title = self.purpose.name().trim_end_matches("...").to_owned();
        let modal = Modal::new(egui::Id::unique("path")).show(context, |ui| {
            ui.set_width(520.0);
            ui.heading(&title);
            let field = ui.add(TextEdit::singleline(&mut self.path).hint_text("Path").desired_width(f32::INFINITY));
            if std::mem::take(&mut self.focus) {
                field.request_focus();
            }
            if field.changed() {
                self.warned = None;
            }
            self.entries(ui);
            if let Some(warned) = &self.warned {
                ui.colored_label(ui.visuals().warn_fg_color, warned);
            }
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            ui.horizontal(|ui| {
                if (ui.button("OK").clicked() || entered) && !self.path.trim().is_empty() && self.may_replace() {
                    answer = Answer::Chosen(self.path.trim().to_owned());
                }
                if ui.button("Cancel").clicked() {
                    answer = Answer::Cancelled;
                }
            });
        });
        if modal.should_close() && matches!(answer, Answer::Open) {
            answer = Answer::Cancelled;
        }
        answer
    }

    /// Whether nothing is lost, or somebody has said that it may.
    fn may_replace(&mut self) -> bool {
        let is_there = self.purpose.makes_a_file() && Path::new(self.path.trim()).exists();
        if !is_there || self.warned.is_some() {
            return true;
        }
        self.warned = Some(format!("{} is there already: OK replaces it", self.path.trim()));
        false
    }

    /// The files and folders beside what is typed.
    fn entries(&mut self, ui: &mut egui::Ui) {
        let typed = Path::new(&self.path);
        let folder = if self.path.ends_with(['/', '\\']) || typed.is_dir() {
            typed
        } else {
            typed.parent().unwrap_or(Path::new(""))
        };
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder }.to_owned();
        if self.listed.as_ref().is_none_or(|(listed, _)| *listed != folder) {
            self.listed = Some((folder.clone(), list(&folder)));
        }
        let Some((_, entries)) = &self.listed else { return };
        let mut chosen = None;
        ScrollArea::vertical().max_height(220.0).auto_shrink([false, true]).show(ui, |ui| {
            if folder.parent().is_some() && ui.button("⬆ folder above").clicked() {
                chosen = folder.parent().map(|above| format!("{}/", above.display()));
            }
            for entry in entries {
                let name = if entry.is_folder {
                    format!("{}/", entry.name)
                } else {
                    entry.name.clone()
                };
                if ui.selectable_label(false, &name).clicked() {
                    chosen = Some(folder.join(&name).display().to_string());
                }
            }
        });
        if let Some(path) = chosen {
            self.path = path;
            self.warned = None;
        }
    }
}

/// What is in a folder, folders first; nothing where it cannot be read. At most a few hundred: nobody clicks through more.
fn list(folder: &Path) -> Vec<Entry> {
    const MOST: usize = 400;
    let Ok(entries) = std::fs::read_dir(folder) else {
        return Vec::new();
    };
    let mut found: Vec<Entry> = entries
        .take(4 * MOST)
        .filter_map(Result::ok)
        .map(|entry| Entry {
            name: entry.file_name().to_string_lossy().into_owned(),
            is_folder: entry.path().is_dir(),
        })
        .filter(|entry| !entry.name.starts_with('.'))
        .collect();
    found.sort_by(|a, b| (!a.is_folder, &a.name).cmp(&(!b.is_folder, &b.name)));
    found.truncate(MOST);
    found
}
