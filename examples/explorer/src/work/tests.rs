use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Duration;

use shadewright_runtime::gpu::Gpu;

use super::*;

/// Tells when it begins a step, and does it when it is let.
struct Held {
    kind: &'static str,
    name: &'static str,
    begun: Sender<&'static str>,
    go: Receiver<()>,
    steps: usize,
}

impl Job for Held {
    fn kind(&self) -> &'static str {
        self.kind
    }
    fn step(&mut self, _: &mut Bench, _: &AtomicBool, tell: &mut dyn FnMut(News)) -> Step {
        let _ = self.begun.send(self.name);
        let _ = self.go.recv_timeout(Duration::from_secs(20));
        self.steps -= 1;
        if self.steps == 0 {
            tell(News::Failed {
                what: self.kind,
                message: self.name.to_owned(),
            });
            return Step::Break(());
        }
        Step::Continue(Progress {
            what: self.name.to_owned(),
            done: 1,
            of: 2,
        })
    }
}

struct Panics;

impl Job for Panics {
    fn kind(&self) -> &'static str {
        "panics"
    }
    fn step(&mut self, _: &mut Bench, _: &AtomicBool, _: &mut dyn FnMut(News)) -> Step {
        panic!("planted")
    }
}

fn done(lane: &mut Lane, count: usize) -> Vec<String> {
    let mut told = Vec::new();
    for _ in 0..4000 {
        for news in lane.news() {
            if let News::Failed { message, .. } = news {
                told.push(message);
            }
        }
        if told.len() >= count && lane.is_idle() {
            break;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    told
}

/// Catches work that piles up, a job that goes on after a newer one was asked for, one that is lost, and a panic that ends the lane.
#[test]
fn the_newest_of_a_kind_is_done() {
    let woken = Arc::new(AtomicUsize::new(0));
    let wake = Arc::clone(&woken);
    let gpu = Gpu::headless().unwrap();
    let mut lane = Lane::new("test", Bench::new(gpu), move || {
        wake.fetch_add(1, Ordering::Relaxed);
    });
    let (begun, begins) = channel();
    let held = |kind, name, steps| {
        let (let_go, go) = channel();
        let begun = begun.clone();
        (
            Held {
                kind,
                name,
                begun,
                go,
                steps,
            },
            let_go,
        )
    };
    let begins = || begins.recv_timeout(Duration::from_secs(20)).unwrap();
    let (first, go_first) = held("a", "first", 2);
    let (second, _go) = held("a", "second", 1);
    let (third, go_third) = held("a", "third", 1);
    let (other, go_other) = held("b", "other", 2);
    lane.ask(first);
    assert_eq!(begins(), "first");
    lane.ask(second);
    lane.ask(other);
    lane.ask(third);
    go_first.send(()).unwrap();
    assert_eq!(begins(), "third", "the newer took the place of the one that waited");
    go_third.send(()).unwrap();
    assert_eq!(begins(), "other");
    go_other.send(()).unwrap();
    assert_eq!(begins(), "other");
    assert_eq!(
        lane.progress().map(|(kind, progress)| (kind, progress.unwrap().done)),
        Some(("b", 1))
    );
    lane.cancel("b");
    go_other.send(()).unwrap();
    assert_eq!(
        done(&mut lane, 2),
        ["third", "other"],
        "the step that runs is the last, and this was"
    );
    lane.ask(Panics);
    assert_eq!(done(&mut lane, 1), ["this should not have happened: planted"]);
    let (last, go) = held("a", "last", 1);
    go.send(()).unwrap();
    lane.ask(last);
    assert_eq!(done(&mut lane, 1), ["last"]);
    assert!(woken.load(Ordering::Relaxed) > 5);
}

/// Catches a menu that offers what cannot be linked, or greys out what can.
#[test]
fn illegal_choices_have_their_reason() {
    let text = r#"(
        camera: (eye: (0.0, 0.0, 6.0), target: (0.0, 0.0, 0.0)), pass: "forward",
        meshes: {"ball": Sphere(radius: 1.0)}, materials: {"m": {"material": "metalness", "brdf": "microfacet"}},
        lights: [(module: "point")], objects: [(mesh: "ball", material: "m")],
    )"#;
    let scene = shadewright_runtime::scene::SceneFile::parse("test", text, std::path::Path::new("")).unwrap();
    let catalog = Arc::new(Catalog::load(shadewright_modules::library()).unwrap());
    let rows = crate::tree::rows(&scene, &catalog, &[]);
    let shot = Shot {
        scene,
        catalog,
        version: 1,
    };
    let mut bench = Bench::new(Gpu::headless().unwrap());
    let mut verdicts = |path: &str| {
        let row = rows.iter().find(|row| row.path == path).unwrap();
        let mut job = Try::new(shot.clone(), row.clone());
        let mut legal = None;
        let mut tell = |news| match news {
            News::Legal(found) => legal = Some(found),
            other => panic!("{other:?}"),
        };
        while job.step(&mut bench, &AtomicBool::new(false), &mut tell).is_continue() {}
        legal.unwrap().verdicts
    };
    let reason = |verdicts: &[Verdict], name: &str| verdicts.iter().find(|v| v.module.name == name).unwrap().reason.clone();
    let visibility = verdicts("lights[0].visibility");
    assert_eq!(reason(&visibility, "cube-map"), None);
    let why = reason(&visibility, "perspective").unwrap();
    assert!(why.contains("direction"), "{why}");
    let brdf = verdicts("materials.m.brdf");
    assert!(brdf.iter().filter(|v| v.reason.is_none()).count() > 10, "{brdf:?}");
}
