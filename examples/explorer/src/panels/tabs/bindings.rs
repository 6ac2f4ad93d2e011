//! What a host binds to a pass, where its parameters are, and what it holds.

mod rows;

use eframe::egui::{self, Label, RichText, Sense, WidgetInfo};
use egui_extras::{Column, TableBuilder};

use super::inspect;
use crate::App;
use crate::work::Made;
use rows::Line;

/// The tables.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Table {
    /// Bound resources with their layouts.
    #[default]
    Resources,
    /// Parameters and their places.
    Parameters,
    /// Entry points with their inputs and outputs.
    Stages,
    /// Counts of operations.
    Cost,
}

impl Table {
    const ALL: [Self; 4] = [Self::Resources, Self::Parameters, Self::Stages, Self::Cost];

    fn name(self) -> &'static str {
        match self {
            Self::Resources => "Resources",
            Self::Parameters => "Parameters",
            Self::Stages => "Stages",
            Self::Cost => "Cost",
        }
    }
}

/// What the tab remembers.
#[derive(Default)]
pub struct BindingsState {
    /// Which table is shown.
    pub table: Table,
}

/// Shows them.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    let inspected = inspect::current(app);
    let Some(made) = inspect::made(ui, inspected.as_deref()) else {
        return;
    };
    ui.horizontal_wrapped(|ui| {
        inspect::choices(app, ui, made, false);
        ui.separator();
        for table in Table::ALL {
            let is_shown = app.tabs.bindings.table == table;
            let response = ui.selectable_value(&mut app.tabs.bindings.table, table, table.name());
            response.widget_info(|| WidgetInfo::selected(egui::Role::Button, true, is_shown, format!("Table: {}", table.name())));
        }
    });
    let reflection = made.program.reflection();
    let (heads, lines): (&[(&str, f32)], Vec<Line>) = match app.tabs.bindings.table {
        Table::Resources => (rows::RESOURCES, rows::resources(reflection)),
        Table::Parameters => (rows::PARAMETERS, rows::parameters(reflection)),
        Table::Stages => (rows::STAGES, rows::stages(reflection)),
        Table::Cost => (rows::COST, rows::cost(&made.costs)),
    };
    table(app, ui, made, heads, &lines);
}

fn table(app: &mut App, ui: &mut egui::Ui, made: &Made, heads: &[(&str, f32)], lines: &[Line]) {
    if lines.is_empty() {
        ui.weak("None.");
        return;
    }
    let height = ui.text_style_height(&egui::TextStyle::Body) + 4.0;
    let mut builder = TableBuilder::new(ui)
        .id_salt(app.tabs.bindings.table.name())
        .striped(true)
        .resizable(true)
        .min_scrolled_height(0.0)
        .auto_shrink(false);
    for (_, width) in heads {
        builder = builder.column(Column::initial(*width).clip(true).at_least(24.0));
    }
    // What is left belongs to nobody, so that every column can be made wider.
    let builder = builder.column(Column::remainder());
    let mut clicked = None;
    let table = builder.header(height, |mut header| {
        for (name, _) in heads {
            header.col(|ui| {
                ui.strong(*name);
            });
        }
        header.col(|_| {});
    });
    table.body(|body| {
        body.rows(height, lines.len(), |mut table_row| {
            let index = table_row.index();
            let line = &lines[index];
            for (column, cell) in line.cells.iter().enumerate() {
                table_row.col(|ui| {
                    let mut text = RichText::new(cell);
                    if line.is_part {
                        text = text.weak();
                    }
                    if column != line.name || line.instance.is_none() {
                        ui.add(Label::new(text).truncate());
                        return;
                    }
                    let response = ui.add(
                        Label::new(text.color(ui.visuals().hyperlink_color))
                            .truncate()
                            .sense(Sense::click()),
                    );
                    let name = format!("Select the module of {cell}, line {}", index + 1);
                    response.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, &name));
                    if response.on_hover_text(&line.hover).clicked() {
                        clicked = line.instance.clone();
                    }
                });
            }
        });
    });
    if let Some(instance) = clicked {
        let instances = &made.program.reflection().instances;
        let place = instances.iter().find(|i| i.name == instance).and_then(|i| i.paths.first());
        if let Some(place) = place {
            inspect::select(app, made, place);
        }
    }
}
