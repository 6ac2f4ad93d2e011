//! The explorer in a real window on a virtual display, driven by mouse and keyboard, and killed.
//!
//! Needs Xvfb, xdotool and ImageMagick, which `./setup tests` installs where it can. Where they are not there the test says so and checks nothing.

#![allow(clippy::unwrap_used)]

use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use explorer::files::Kept;
use image::RgbImage;

const PATIENCE: Duration = Duration::from_secs(120);

/// A process that does not outlive the test.
struct Owned(Child);

impl Drop for Owned {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

struct Display {
    _server: Owned,
    name: String,
}

impl Display {
    /// A virtual screen; `None` where there is no such server.
    fn open() -> Option<Self> {
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .ok()?;
        let mut line = String::new();
        BufReader::new(server.stdout.take()?).read_line(&mut line).ok()?;
        Some(Self {
            _server: Owned(server),
            name: format!(":{}", line.trim()),
        })
    }

    fn run(&self, program: &str, args: &[&str]) -> Vec<u8> {
        let out = Command::new(program).args(args).env("DISPLAY", &self.name).output().unwrap();
        assert!(out.status.success(), "{program} {args:?}: {}", String::from_utf8_lossy(&out.stderr));
        out.stdout
    }

    fn explorer(&self, state: &Path, args: &[&str]) -> Owned {
        let child = Command::new(env!("CARGO_BIN_EXE_explorer"))
            .args(args)
            .env("DISPLAY", &self.name)
            .env("XDG_STATE_HOME", state)
            .env_remove("WAYLAND_DISPLAY")
            .spawn();
        Owned(child.unwrap())
    }

    fn screenshot(&self) -> RgbImage {
        let png = self.run("import", &["-window", "root", "png:-"]);
        image::load_from_memory(&png).unwrap().to_rgb8()
    }
}

/// How many colours a part of the screen has: a picture has many, an interface few.
fn colours(screen: &RgbImage, [x, y, width, height]: [u32; 4]) -> usize {
    let part = image::imageops::crop_imm(screen, x, y, width, height).to_image();
    part.pixels().map(|pixel| pixel.0).collect::<std::collections::HashSet<_>>().len()
}

fn until(what: &str, mut is_so: impl FnMut() -> bool) {
    let start = Instant::now();
    while !is_so() {
        assert!(start.elapsed() < PATIENCE, "never: {what}");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Says it where it is seen: what a test that passes prints is not.
fn not_tested(why: &str) {
    let _ = writeln!(std::io::stderr(), "NOT TESTED: {why}");
}

/// Catches a window that stays empty, a mouse that steers nothing, work that goes with the process, and a start that does not bring it back.
#[test]
fn a_window_is_driven_and_killed() {
    let there = |program: &str| {
        Command::new(program)
            .arg("-version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok()
    };
    let Some(display) = Display::open().filter(|_| there("xdotool") && there("import")) else {
        not_tested("Xvfb, xdotool and ImageMagick's import are not all there");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("shadewright/explorer.json");
    let start = Instant::now();
    let window = display.explorer(folder.path(), &["sphere"]);
    // The middle of the window is the picture.
    let middle = [400, 120, 400, 300];
    until("a picture", || colours(&display.screenshot(), middle) > 200);
    println!(
        "a picture is on the screen {} ms after the start of the process",
        start.elapsed().as_millis()
    );
    until("the state of the first picture", || !Kept::read(&file).starting && file.exists());
    let camera = || {
        let text = Kept::read(&file).work.map(|work| work.state.text).unwrap_or_default();
        text.lines().find(|line| line.contains("camera")).unwrap_or_default().to_owned()
    };
    let before = (camera(), display.screenshot());
    // With pauses: a window that is behind sees press, way and release as one.
    let drag = "mousemove 500 250 sleep 0.3 mousedown 1 sleep 0.5 mousemove 560 260 sleep 0.5 mousemove 640 270 sleep 0.5 mouseup 1";
    let drag: Vec<&str> = drag.split(' ').collect();
    display.run("xdotool", &drag);
    until("a turned camera", || camera() != before.0);
    until("another picture", || display.screenshot() != before.1);
    let (turned, shown) = (camera(), Kept::read(&file));
    // No window manager gives a window the keyboard.
    display.run(
        "xdotool",
        &["search", "--name", "Shadewright", "windowfocus", "sleep", "0.3", "key", "ctrl+z"],
    );
    until("an undone turn", || camera() == before.0);
    display.run("xdotool", &["key", "ctrl+y"]);
    until("a turn done again", || camera() == turned);
    drop(window);
    let _again = display.explorer(folder.path(), &[]);
    until("the picture again", || colours(&display.screenshot(), middle) > 200);
    let kept = Kept::read(&file);
    assert_eq!((camera(), kept.work), (turned, shown.work));
}
