//! The tabs below the picture.

mod bindings;
mod code;
mod graph;
mod inspect;
mod problems;
mod timing;

use eframe::egui;

use crate::App;

pub(crate) use code::save as save_code;

pub use code::CodeState;
pub use graph::GraphState;
pub use inspect::InspectState;
pub use problems::ProblemsState;
pub use timing::TimingState;

/// The tabs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Tab {
    /// The linked code.
    #[default]
    Code,
    /// What a host binds, and where parameters are.
    Bindings,
    /// The tree of modules, drawn.
    Graph,
    /// What pictures take.
    Timing,
    /// What is wrong, with the line of the source.
    Problems,
}

impl Tab {
    /// All of them, in their order.
    pub const ALL: [Self; 5] = [Self::Code, Self::Bindings, Self::Graph, Self::Timing, Self::Problems];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Code => "Code",
            Self::Bindings => "Bindings",
            Self::Graph => "Graph",
            Self::Timing => "Timing",
            Self::Problems => "Problems",
        }
    }
}

/// What the tabs remember.
#[derive(Default)]
pub struct Tabs {
    /// Which one is shown.
    pub shown: Tab,
    /// What code is looked at.
    pub inspect: InspectState,
    /// Of the code.
    pub code: CodeState,
    /// Of the bindings.
    pub bindings: bindings::BindingsState,
    /// Of the graph.
    pub graph: GraphState,
    /// Of the times.
    pub timing: TimingState,
    /// Of the problems.
    pub problems: ProblemsState,
}

/// Shows the tabs.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    // The panel keeps its height whatever little is in it.
    ui.set_min_size(ui.available_size());
    ui.horizontal(|ui| {
        for tab in Tab::ALL {
            let mut text = egui::RichText::new(tab.name());
            if tab == Tab::Problems && !app.problems.is_empty() {
                text = text.color(ui.visuals().error_fg_color);
            }
            ui.selectable_value(&mut app.tabs.shown, tab, text);
        }
    });
    ui.separator();
    match app.tabs.shown {
        Tab::Code => code::show(app, ui),
        Tab::Bindings => bindings::show(app, ui),
        Tab::Graph => graph::show(app, ui),
        Tab::Timing => timing::show(app, ui),
        Tab::Problems => problems::show(app, ui),
    }
}
