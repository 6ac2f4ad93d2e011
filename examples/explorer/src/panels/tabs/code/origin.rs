//! Where a line of the linked code comes from, and why it is there.

use eframe::egui::{self, RichText, ScrollArea, WidgetInfo};

use super::inspect;
use crate::App;
use crate::tree::row_of;
use crate::work::{Listing, Made};

/// Says it of the line that is asked about.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui, made: &Made, listing: &Listing) {
    let Some(line) = app.tabs.code.line else { return };
    ui.horizontal(|ui| {
        ui.strong(format!("Line {}", line + 1));
        let close = ui.small_button("✖");
        close.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Close the origin"));
        if close.clicked() {
            app.tabs.code.line = None;
        }
    });
    let Some(Some(origin)) = listing.origins.get(line) else {
        ui.weak("The linker has written this line.");
        return;
    };
    ScrollArea::vertical().auto_shrink(false).id_salt("origin").show(ui, |ui| {
        let item = &origin.item;
        ui.label(format!("of {}", item.name));
        let at = if origin.line > 0 {
            format!(":{}", origin.line)
        } else {
            String::new()
        };
        ui.label(RichText::new(format!("{}{at}", item.file)).monospace());
        if item.places.is_empty() {
            ui.weak(format!("the interface of {}", item.module));
        }
        for place in &item.places {
            let link = ui.link(place);
            link.widget_info(|| WidgetInfo::labeled(egui::Role::Link, true, format!("Select {place}")));
            let row = row_of(&app.rows, made.subject(), made.place(place));
            let hover = row.map_or_else(String::new, |row| {
                if row.is_stated {
                    row.path.clone()
                } else {
                    format!("{}, by default", row.path)
                }
            });
            if link.on_hover_text(hover).clicked() {
                inspect::select(app, made, place);
            }
        }
        for why in made.program.why(&item.name).iter().take(4) {
            ui.separator();
            ui.label(format!("{} {}", why.kind, why.name));
            if !why.path.is_empty() {
                ui.weak("reached by");
                ui.label(why.path.join(" > "));
            }
            ui.weak("named in");
            ui.label(RichText::new(named(app, made, &why.place, &why.because)).monospace());
        }
    });
}

/// Which text put a module there: the scene, or the manifest whose default it is.
fn named(app: &App, made: &Made, place: &str, because: &str) -> String {
    // Recipes of a scene have no text of their own.
    let row = row_of(&app.rows, made.subject(), made.place(place)).filter(|_| because.starts_with("recipe:"));
    let stated = row.and_then(|row| app.document.scene().place(&row.path));
    stated.unwrap_or_else(|| because.to_owned())
}

/// Selects the row of the module that a line is from.
pub(super) fn select(app: &mut App, made: &Made, listing: &Listing, line: usize) {
    let Some(Some(origin)) = listing.origins.get(line) else { return };
    if let Some(place) = origin.item.places.first() {
        inspect::select(app, made, place);
    }
}
