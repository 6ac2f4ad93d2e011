//! Asking the lanes, and hearing what they tell.

use super::{App, Problem};
use crate::work::{Concerned, News, Paint, Places};

impl App {
    /// Takes in what the lanes have told.
    pub(super) fn hear(&mut self) {
        let mut news = self.lanes.view.news();
        news.extend(self.lanes.desk.news());
        news.extend(self.lanes.long.news());
        for news in news {
            self.take(news);
        }
    }

    fn take(&mut self, news: News) {
        match news {
            News::Painted(painted) => {
                // Newer than what is shown, if not the newest: the old picture stays no longer than it must.
                self.problems.clear();
                self.tabs.timing.take(&painted);
                self.viewport.show(&self.render_state, *painted);
            }
            News::Wrong { version, report } => {
                if version == self.version {
                    self.message = crate::work::reason(&report);
                    self.problems = vec![Problem::Report(report)];
                }
            }
            News::Failed { what, message } => {
                self.message = format!("{what}: {message}");
                self.problems = vec![Problem::Other(what.to_owned(), message)];
            }
            News::Found(found) => self.take_found(found),
            News::OnDisk { path, text } => self.take_disk(&path, text),
            News::Said(message) => self.message = message,
            News::Library(Ok(catalog)) => {
                self.message = format!("{} modules", catalog.modules().count());
                self.set_catalog(catalog);
            }
            News::Library(Err(report)) => {
                self.message = crate::work::reason(&report);
                self.problems = vec![Problem::Report(report)];
            }
            News::Legal(legal) => {
                if legal.version == self.version {
                    self.tree.legal = Some(legal);
                }
            }
            News::Inspected(inspected) => self.tabs.inspect.take(*inspected),
            News::Concerned(concerned) => self.tabs.problems.concerned = concerned,
            News::Compare(told) => self.take_comparison(told),
        }
    }

    /// Asks for what the screen shows and is not there yet.
    pub(super) fn ask(&mut self) {
        if let Some(size) = self.viewport.wants(self.version, self.document.is_open()) {
            let shot = self.shot();
            self.lanes.view.ask(Paint { shot, size });
        }
        if self.tabs.timing.measured.is_some_and(|version| version != self.version) {
            // Its pictures would show what was.
            self.lanes.view.cancel("measurement");
            self.tabs.timing.measured = None;
        }
        self.ask_places();
        self.ask_to_compare();
    }

    /// Asks which rows the problems are about, where they are others than before.
    fn ask_places(&mut self) {
        let reports = self.problems.iter().filter_map(|problem| match problem {
            Problem::Report(report) => Some(report),
            Problem::Other(..) => None,
        });
        let is_known = reports.clone().eq(&self.tabs.problems.asked);
        if is_known {
            return;
        }
        self.tabs.problems.asked = reports.cloned().collect();
        self.tabs.problems.concerned = Concerned::default();
        let job = Places {
            shot: self.shot(),
            rows: self.rows.clone(),
            reports: self.tabs.problems.asked.clone(),
        };
        if !job.reports.is_empty() {
            self.lanes.desk.ask(job);
        }
    }
}
