//! A walk through everything that can be done, at random.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use eframe::egui::accesskit::{Action, ActionData};
use eframe::egui::{Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, PointerButton, Role, TouchPhase, Vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use explorer::App;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;

use crate::harness::{CLICKABLE, open_small, settle};

/// Actions from one pause to the next.
const PAUSE: usize = 5;
/// Longest pause.
const PATIENCE: Duration = Duration::from_secs(20);

/// Names of the lanes' threads.
const LANES: [&str; 3] = ["view", "desk", "long"];

/// Actions of the walk.
const ACTIONS: usize = 10_000;

const KEYS: [(Modifiers, Key); 22] = [
    (Modifiers::NONE, Key::ArrowUp),
    (Modifiers::NONE, Key::ArrowDown),
    (Modifiers::NONE, Key::ArrowLeft),
    (Modifiers::NONE, Key::ArrowRight),
    (Modifiers::NONE, Key::Enter),
    (Modifiers::NONE, Key::Escape),
    (Modifiers::NONE, Key::Delete),
    (Modifiers::NONE, Key::Tab),
    (Modifiers::SHIFT, Key::Tab),
    (Modifiers::NONE, Key::Space),
    (Modifiers::COMMAND, Key::Z),
    (Modifiers::COMMAND, Key::Y),
    (Modifiers::COMMAND, Key::F),
    (Modifiers::COMMAND, Key::S),
    (Modifiers::COMMAND, Key::Num1),
    (Modifiers::COMMAND, Key::Num2),
    (Modifiers::COMMAND, Key::Num3),
    (Modifiers::COMMAND, Key::Num4),
    (Modifiers::COMMAND, Key::Num5),
    (Modifiers::COMMAND, Key::Num6),
    (Modifiers::ALT, Key::ArrowUp),
    (Modifiers::ALT, Key::ArrowDown),
];

const TEXTS: [&str; 8] = ["", "ggx", "é€漢", "(", "1e39", "-0", "../x", "\"\\"];

struct Walk {
    explorer: Harness<'static, App>,
    random: Pcg32,
    folder: tempfile::TempDir,
}

impl Walk {
    fn below(&mut self, most: usize) -> usize {
        self.random.next_u32() as usize % most.max(1)
    }

    fn share(&mut self) -> f32 {
        (self.random.next_u32() >> 8) as f32 / (1 << 24) as f32
    }

    /// One action, said in words.
    fn act(&mut self) -> String {
        match self.below(100) {
            0..=59 => self.click(),
            60..=69 => {
                let (modifiers, key) = KEYS[self.below(KEYS.len())];
                self.explorer.key_press_modifiers(modifiers, key);
                format!("{modifiers:?} {key:?}")
            }
            70..=79 => self.steer(),
            80..=91 => self.turn(),
            92..=95 => {
                let text = TEXTS[self.below(TEXTS.len())].to_owned();
                self.explorer.event(Event::Text(text.clone()));
                format!("type {text}")
            }
            96 => {
                let size = Vec2::new(200.0 + 1200.0 * self.share(), 150.0 + 800.0 * self.share());
                self.explorer.set_size(size);
                format!("size {size}")
            }
            _ => {
                let rows = self.explorer.state().rows.len();
                let which = self.below(rows);
                let path = self.explorer.state().rows[which].path.clone();
                self.explorer.state_mut().selected.clone_from(&path);
                format!("select {path}")
            }
        }
    }

    /// Clicks something that can be clicked. Nothing outside a folder of its own is read as modules or written.
    fn click(&mut self) -> String {
        let dialog = self.explorer.state().dialog.as_ref();
        let is_outside = dialog.is_some_and(|dialog| !Path::new(dialog.path.trim()).starts_with(self.folder.path()));
        let seed = self.random.next_u32() as usize;
        let nodes: Vec<_> = self
            .explorer
            .query_all_by(|node| CLICKABLE.contains(&node.role()) && !node.is_disabled())
            .filter(|node| !(is_outside && node.accesskit_node().label().is_some_and(|label| label == "OK")))
            .collect();
        if nodes.is_empty() {
            return "nothing to click".to_owned();
        }
        let node = &nodes[seed % nodes.len()];
        node.click();
        format!("click {:?}", node.accesskit_node().label())
    }

    /// Gives a slider or a number some value, or some step.
    fn turn(&mut self) -> String {
        let seed = self.random.next_u32() as usize;
        let value = [0.0, 1.0, -1.0, 0.5, 1e-9, 1e9, f64::MAX, f64::NAN, f64::from(self.share())][self.below(9)];
        let actions = [
            Action::Increment,
            Action::Decrement,
            Action::SetValue,
            Action::SetValue,
            Action::Focus,
        ];
        let action = actions[self.below(actions.len())];
        let nodes: Vec<_> = self
            .explorer
            .query_all_by(|node| matches!(node.role(), Role::Slider | Role::SpinButton | Role::TextInput))
            .collect();
        if nodes.is_empty() {
            return "nothing to turn".to_owned();
        }
        let node = &nodes[seed % nodes.len()];
        let (target_node, target_tree) = node.accesskit_node().locate();
        let label = node.accesskit_node().label();
        self.explorer
            .event(Event::AccessKitActionRequest(eframe::egui::accesskit::ActionRequest {
                action,
                target_tree,
                target_node,
                data: matches!(action, Action::SetValue).then_some(ActionData::NumericValue(value)),
            }));
        format!("{action:?} {label:?} {value}")
    }

    /// Lets short work come to its end, which the next action would mostly cancel.
    fn pause(&mut self) {
        let start = Instant::now();
        while !self.explorer.state().lanes.desk.is_idle() && start.elapsed() < PATIENCE {
            std::thread::sleep(Duration::from_millis(1));
            self.explorer.step();
        }
    }

    /// Something with the mouse in the picture.
    fn steer(&mut self) -> String {
        let Some(rect) = self.explorer.state().viewport.rect else {
            return "no picture".to_owned();
        };
        let at = rect.min + rect.size() * Vec2::new(self.share(), self.share());
        self.explorer.event(Event::PointerMoved(at));
        if self.below(3) == 0 {
            let delta = Vec2::new(0.0, 400.0 * (self.share() - 0.5));
            self.explorer.event(Event::MouseWheel {
                unit: MouseWheelUnit::Point,
                delta,
                modifiers: Modifiers::NONE,
                phase: TouchPhase::Move,
                source: MouseWheelSource::Wheel,
            });
            return format!("wheel {delta}");
        }
        let to = at + Vec2::new(300.0 * (self.share() - 0.5), 300.0 * (self.share() - 0.5));
        let button = [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle][self.below(3)];
        for (pos, pressed) in [(at, true), (to, false)] {
            self.explorer.event(Event::PointerMoved(pos));
            self.explorer.event(Event::PointerButton {
                pos,
                button,
                pressed,
                modifiers: Modifiers::NONE,
            });
            self.explorer.step();
        }
        format!("drag {at} {to}")
    }
}

/// Panics of lanes' threads, which end a job only.
static PANICS: AtomicUsize = AtomicUsize::new(0);

/// Counts them from now on.
fn count_panics() {
    let before = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if std::thread::current().name().is_some_and(|name| LANES.contains(&name)) {
            PANICS.fetch_add(1, Ordering::Relaxed);
        }
        before(panic);
    }));
}

/// Catches any panic, on any lane, and a document that cannot be read again.
#[test]
fn ten_thousand_random_actions() {
    count_panics();
    let mut walk = Walk {
        explorer: open_small(),
        random: Pcg32::new(0x5eed, 7),
        folder: tempfile::tempdir().unwrap(),
    };
    // People type what the fonts lack, too.
    walk.explorer.ctx.set_missing_glyph_policy(eframe::egui::MissingGlyphPolicy::Tofu);
    let folder: PathBuf = walk.folder.path().to_owned();
    let mut last: Vec<String> = Vec::new();
    for step in 0..ACTIONS {
        let said = walk.act();
        last.push(said);
        if last.len() > 12 {
            last.remove(0);
        }
        walk.explorer.step();
        if step % PAUSE == 0 {
            walk.pause();
        }
        let panics = PANICS.load(Ordering::Relaxed);
        assert_eq!(panics, 0, "step {step} after {last:#?}");
        let app = walk.explorer.state();
        if step % 500 == 0 {
            let state = app.document.state();
            assert!(state.parse(&explorer::scenes::files()).is_ok(), "step {step}: {}", state.text);
            // Another one, as soon as a scene has lost too much to show anything.
            let text = crate::harness::SMALL;
            let path = folder.join("again.scene.ron");
            std::fs::write(&path, text).unwrap();
            walk.explorer.state_mut().open_file(path);
        }
    }
    settle(&mut walk.explorer);
    assert_eq!(PANICS.load(Ordering::Relaxed), 0);
}
