//! The tabs below the picture.

mod pareto;
mod pins;
mod problems;
mod reference;
mod sheet;

use eframe::egui;

use crate::App;

/// The tabs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Tab {
    /// What is wrong, with the line of the source.
    #[default]
    Problems,
    /// Permutations that are kept.
    Pins,
    /// The scene's truth, and what stands in it for what.
    Reference,
    /// Error against cost of what could stand in a slot.
    Pareto,
    /// Pictures of what could stand in a slot.
    Sheet,
}

impl Tab {
    /// All of them, in their order.
    pub const ALL: [Self; 5] = [Self::Problems, Self::Pins, Self::Reference, Self::Pareto, Self::Sheet];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Problems => "Problems",
            Self::Pins => "Pins",
            Self::Reference => "Reference",
            Self::Pareto => "Pareto",
            Self::Sheet => "Sheet",
        }
    }
}

/// What the tabs remember.
#[derive(Default)]
pub struct Tabs {
    /// Which one is shown.
    pub shown: Tab,
    /// What the plot of alternatives has across.
    pub cost: pareto::Cost,
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
        Tab::Pins => pins::show(app, ui),
        Tab::Reference => reference::show(app, ui),
        Tab::Pareto => pareto::show(app, ui),
        Tab::Sheet => sheet::show(app, ui),
    }
    // The panel keeps its height, however little there is to show.
    ui.take_available_space();
}
