//! The tabs below the picture.

mod problems;

use eframe::egui;

use crate::App;

/// The tabs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Tab {
    /// What is wrong, with the line of the source.
    #[default]
    Problems,
}

impl Tab {
    /// All of them, in their order.
    pub const ALL: [Self; 1] = [Self::Problems];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Problems => "Problems",
        }
    }
}

/// What the tabs remember.
#[derive(Default)]
pub struct Tabs {
    /// Which one is shown.
    pub shown: Tab,
}

/// Shows the tabs.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    ui.horizontal(|ui| {
        for tab in Tab::ALL {
            ui.selectable_value(&mut app.tabs.shown, tab, tab.name());
        }
    });
    ui.separator();
    match app.tabs.shown {
        Tab::Problems => problems::show(app, ui),
    }
}
