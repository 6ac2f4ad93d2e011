//! What is wrong with the present scene, with the lines of the source.

use eframe::egui::text::LayoutJob;
use eframe::egui::{self, FontId, RichText, ScrollArea, TextFormat, TextStyle, Visuals, WidgetInfo};
use shadewright_compiler::{Diagnostic, Report};

use crate::App;
use crate::app::Problem;
use crate::panels::tree;
use crate::work::Concerned;

/// What the tab remembers.
#[derive(Default)]
pub struct ProblemsState {
    /// The rows that problems are about.
    pub concerned: Concerned,
    /// The problems of which that was asked.
    pub asked: Vec<Report>,
}

/// Shows it.
pub(super) fn show(app: &mut App, ui: &mut egui::Ui) {
    if app.problems.is_empty() {
        ui.label("Nothing is wrong.");
        return;
    }
    ui.horizontal(|ui| {
        let count = app.problems.iter().map(|problem| match problem {
            Problem::Report(report) => report.diagnostics.len(),
            Problem::Other(..) => 1,
        });
        let count: usize = count.sum();
        ui.label(format!("{count} {}", if count == 1 { "problem" } else { "problems" }));
        let copy = ui.button("Copy");
        copy.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, "Copy the problems"));
        if copy.clicked() {
            ui.ctx().copy_text(text(&app.problems));
            "copied the problems".clone_into(&mut app.message);
        }
    });
    let mut wanted = None;
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        let mut number = 0;
        for problem in &app.problems {
            match problem {
                Problem::Report(report) => {
                    for diagnostic in &report.diagnostics {
                        let rows = app.tabs.problems.concerned.rows.get(number).map(Vec::as_slice);
                        wanted = links(ui, number, rows.unwrap_or_default()).or(wanted.take());
                        one(ui, diagnostic);
                        ui.add_space(8.0);
                        number += 1;
                    }
                }
                Problem::Other(what, message) => {
                    ui.label(RichText::new(format!("{what}: {message}")).color(ui.visuals().error_fg_color));
                    ui.add_space(8.0);
                }
            }
        }
    });
    if let Some(path) = wanted {
        tree::select(app, &path);
    }
}

/// Most rows that a problem names.
const MOST_LINKS: usize = 6;

/// The rows that a problem is about; the one that was clicked.
fn links(ui: &mut egui::Ui, number: usize, rows: &[String]) -> Option<String> {
    if rows.is_empty() {
        return None;
    }
    let clicked = ui.horizontal(|ui| {
        ui.weak("in");
        let clicked = rows.iter().take(MOST_LINKS).filter(|path| {
            let link = ui.link(path.as_str());
            link.widget_info(|| WidgetInfo::labeled(egui::Role::Link, true, format!("Problem {}: select {path}", number + 1)));
            link.clicked()
        });
        let clicked = clicked.last().cloned();
        if rows.len() > MOST_LINKS {
            ui.weak(format!("and {} more", rows.len() - MOST_LINKS));
        }
        clicked
    });
    clicked.inner
}

/// All of them as plain text.
fn text(problems: &[Problem]) -> String {
    let texts = problems.iter().map(|problem| match problem {
        Problem::Report(report) => report.render(),
        Problem::Other(what, message) => format!("{what}: {message}\n"),
    });
    texts.collect::<Vec<_>>().join("\n")
}

/// A report with its excerpts.
pub(super) fn report(ui: &mut egui::Ui, report: &Report) {
    for diagnostic in &report.diagnostics {
        one(ui, diagnostic);
    }
}

fn one(ui: &mut egui::Ui, diagnostic: &Diagnostic) {
    let text = Report::from(diagnostic.clone()).render();
    let font = TextStyle::Monospace.resolve(ui.style());
    ui.add(egui::Label::new(coloured(&text, &font, ui.visuals())).extend().selectable(true));
}

/// A rendered diagnostic in the theme's colours: what is wrong stands out, and the numbers and bars beside the source stand back.
fn coloured(text: &str, font: &FontId, visuals: &Visuals) -> LayoutJob {
    let mut job = LayoutJob::default();
    let mut append = |text: &str, colour| job.append(text, 0.0, TextFormat::simple(font.clone(), colour));
    let (plain, weak, error) = (visuals.text_color(), visuals.weak_text_color(), visuals.error_fg_color);
    for line in text.split_inclusive('\n') {
        let bare = line.trim_start();
        let beside = line
            .find('|')
            .filter(|at| line[..*at].chars().all(|c| c == ' ' || c.is_ascii_digit()));
        if let Some(rest) = line.strip_prefix("error[") {
            let (code, message) = rest.split_once(']').unwrap_or((rest, ""));
            append(&format!("error[{code}]"), error);
            append(message, visuals.strong_text_color());
        } else if bare.starts_with("-->") {
            append(line, visuals.hyperlink_color);
        } else if let Some(at) = beside {
            let (margin, source) = line.split_at(at + 1);
            append(margin, weak);
            let is_mark = source.trim_start().starts_with(['^', '-']) && line[..at].trim().is_empty();
            append(source, if is_mark { error } else { plain });
        } else {
            append(line, plain);
        }
    }
    job
}
