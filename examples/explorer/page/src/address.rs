//! The page's address: what it says is shown, and what is shown it says.

use std::time::Duration;

use eframe::egui;
use explorer::document::State;
use explorer::link::Look;
use explorer::{App, link};
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use web_sys::Window;
use web_time::Instant;

/// Browsers refuse addresses that change too often (some take 100 in 30 s), so they wait for each other this long.
const PAUSE: Duration = Duration::from_millis(500);

/// Keeps the address and the application together.
pub struct Address {
    window: Window,
    /// The fragment as it was last seen or written.
    known: String,
    /// What it was written from.
    shown: Option<(State, Look)>,
    written: Instant,
}

impl Address {
    /// Of this page. `context` is woken when somebody puts another address there.
    ///
    /// # Errors
    /// There is no page.
    pub fn new(context: &egui::Context) -> Result<Self, JsValue> {
        let window = web_sys::window().ok_or("there is no window")?;
        let context = context.clone();
        let changed = Closure::<dyn FnMut()>::new(move || context.request_repaint());
        window.add_event_listener_with_callback("hashchange", changed.as_ref().unchecked_ref())?;
        // The page lives as long as its listener.
        changed.forget();
        Ok(Self {
            window,
            known: String::new(),
            shown: None,
            written: Instant::now(),
        })
    }

    /// Opens what somebody has put into the address, or puts there what is shown.
    pub fn follow(&mut self, app: &mut App, context: &egui::Context) {
        let Ok(there) = self.window.location().hash() else { return };
        if there != self.known {
            if let Err(why) = open(app, &there) {
                app.message = why;
                // What is wrong stays there, to be looked at, until something changes.
                self.shown = Some(shown(app));
            }
            self.known = there;
        }
        let is_there = |(state, seen): &(State, Look)| *state == *app.document.state() && *seen == look(app);
        // A slider that is being moved changes it when it is let go.
        if app.document.is_open() || self.shown.as_ref().is_some_and(is_there) {
            return;
        }
        let waited = self.written.elapsed();
        if waited < PAUSE {
            return context.request_repaint_after(PAUSE - waited);
        }
        let now = shown(app);
        let fragment = format!("#{}", link::write(&now.0, &now.1));
        if fragment != self.known {
            self.write(&fragment, app);
        }
        self.shown = Some(now);
    }

    /// Puts a fragment there without a step of the browser's history: that is the application's to undo.
    fn write(&mut self, fragment: &str, app: &mut App) {
        let history = self.window.history();
        let written = history.and_then(|history| history.replace_state_with_url(&JsValue::NULL, "", Some(fragment)));
        match (written, self.window.location().hash()) {
            (Ok(()), Ok(there)) => self.known = there,
            (Err(error), _) | (_, Err(error)) => app.message = format!("the address does not change: {error:?}"),
        }
        self.written = Instant::now();
    }
}

fn shown(app: &App) -> (State, Look) {
    (app.document.state().clone(), look(app))
}

fn look(app: &App) -> Look {
    Look {
        selected: app.selected.clone(),
        tab: app.tabs.shown,
        mode: app.compare.mode,
    }
}

/// Opens what a fragment says; nothing where it says nothing.
///
/// # Errors
/// Says what is wrong with it.
fn open(app: &mut App, fragment: &str) -> Result<(), String> {
    if let Some(linked) = link::read(fragment, app.document.scene().files())? {
        app.open_document(linked.document);
        if !linked.look.selected.is_empty() {
            app.selected = linked.look.selected;
        }
        app.tabs.shown = linked.look.tab;
        app.compare(linked.look.mode);
    }
    Ok(())
}
