//! The explorer as a web page, in a browser where there is one: Chromium without a window, on a software GPU.
//!
//! The test serves the page with a script that drives it: opens links, turns the camera, looks at the canvas, and says what it saw by asking for
//! addresses that only the test answers.

#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used)]

use std::io::Write;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use explorer::link::Look;
use explorer::serve::{BuildError, Response, Site, build, serve};
use explorer::{link, scenes};
use serde_json::Value;
use shadewright_runtime::scene::SceneFile;

/// Longest that the browser takes for a step, on a busy machine without a GPU.
const PATIENCE: Duration = Duration::from_secs(180);

const DRIVER: &str = include_str!("page/driver.js");

/// Ends the browser with the test.
struct Browser(Child);

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The first of Chromium's names that is on the path.
fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// A link to a scene with a value changed.
fn changed(example: &str, path: &str, value: &str) -> String {
    let scene = scenes::find(example).unwrap().scene().unwrap();
    let mut document = explorer::document::Document::new(scene);
    document.edit("test", |draft| draft.set(&[], path, value)).unwrap();
    link::write(document.state(), &Look::default())
}

/// What is dropped on the page: a scene, and a picture that it names in a folder that the page does not know.
fn dropped() -> [(&'static str, Vec<u8>); 2] {
    let scene = scenes::find("screen").unwrap();
    let text = scene.text.replace("screen.png", "pictures/mine.png");
    let picture = scene.scene().unwrap().files().bytes(Path::new("screen.png"), 1 << 20).unwrap();
    [("mine.scene.ron", text.into_bytes()), ("mine.png", picture)]
}

/// Serves the page with its driver, which goes through the links. What it says comes back by the channel.
fn serve_driven(site: Site, links: &[String]) -> (u16, Receiver<Value>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let (sender, said) = channel();
    let index = String::from_utf8(site.respond("/").body.into_owned()).unwrap();
    let files = dropped();
    let names = files.each_ref().map(|(name, _)| *name);
    let driver = DRIVER
        .replace("/*FILES*/[]", &serde_json::to_string(&names).unwrap())
        .replace("/*LINKS*/[]", &serde_json::to_string(links).unwrap());
    let driven = index.replace(
        "<script type=\"module\">",
        &format!("<script>{driver}</script>\n<script type=\"module\">"),
    );
    // It serves until the test's process ends.
    std::thread::spawn(move || {
        serve(&listener, |path| {
            if let Some(text) = path.strip_prefix("/said?") {
                let text = unescaped(text);
                let _ = sender.send(serde_json::from_str(&text).unwrap_or(Value::String(text)));
                return Response::found("text/plain", &b""[..]);
            }
            if let Some((_, bytes)) = files.iter().find(|(name, _)| path.strip_prefix("/files/") == Some(name)) {
                return Response::found("application/octet-stream", bytes.as_slice());
            }
            if path == "/" {
                return Response::found("text/html; charset=utf-8", driven.as_bytes());
            }
            site.respond(path)
        });
    });
    (port, said)
}

/// The text of one whose letters but a few are `%20` and its like.
fn unescaped(text: &str) -> String {
    let mut bytes = Vec::new();
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte == b'%' {
            let digits: String = rest.by_ref().take(2).map(char::from).collect();
            bytes.push(u8::from_str_radix(&digits, 16).unwrap());
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).unwrap()
}

/// Says it where it is seen: what a test that passes prints is not.
fn not_tested(why: &str) {
    let _ = writeln!(std::io::stderr(), "NOT TESTED: {why}");
}

/// Catches a page that does not start, draws nothing, does not do what it is told by its address or by the mouse, does not say in its address what it
/// shows, does not take or give files; and whatever a browser complains about.
#[test]
fn the_page_draws_and_follows() {
    let Some(browser) = chromium() else {
        not_tested("there is no Chromium on the path (Debian: apt-get install --no-install-recommends chromium)");
        return;
    };
    let site = match build() {
        Ok(site) => site,
        Err(missing @ BuildError::Missing { .. }) => {
            not_tested(&missing.to_string());
            return;
        }
        Err(failed) => panic!("{failed}"),
    };
    // Red light on the sphere; as it was; its errors; as it was.
    let links = [
        changed("sphere", "lights[0].fields.color", "(1.0, 0.0, 0.0)"),
        "scene=sphere".to_owned(),
        "scene=sphere&show=error".to_owned(),
        "scene=sphere".to_owned(),
    ];
    let (port, said) = serve_driven(site, &links);
    let folder = tempfile::tempdir().unwrap();
    let child = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--enable-unsafe-webgpu", "--disable-gpu-sandbox"])
        // A canvas of WebGPU wants the whole of the browser on one software driver.
        .args([
            "--use-webgpu-adapter=swiftshader",
            "--enable-features=Vulkan",
            "--use-vulkan=swiftshader",
            "--use-angle=swiftshader",
        ])
        .args([
            "--no-first-run",
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .args(["--window-size=1000,700", "--enable-logging=stderr"])
        .arg(format!("--user-data-dir={}", folder.path().display()))
        .arg(format!("http://127.0.0.1:{port}/#scene=sphere"))
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(std::fs::File::create(folder.path().join("log")).unwrap())
        .spawn()
        .unwrap();
    let _browser = Browser(child);
    let hear = |what: &str| {
        let heard = said.recv_timeout(PATIENCE).unwrap_or_else(|_| {
            let log = std::fs::read_to_string(folder.path().join("log")).unwrap_or_default();
            panic!("{what}: nothing is heard of the page\n{log}")
        });
        assert!(heard["error"].is_null(), "{what}: {heard}");
        assert_eq!(heard["errors"], Value::Array(vec![]), "{what}: what the browser complains about");
        heard
    };
    let colour = |heard: &Value| -> [f64; 3] { [0, 1, 2].map(|channel| heard["colour"][channel].as_f64().unwrap()) };
    let differ = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);

    let first = hear("the first picture");
    assert!(colour(&first).iter().all(|channel| *channel > 8.0), "it is black: {first}");
    assert!(first["address"].as_str().unwrap().starts_with("#scene=sphere"), "{first}");

    let red = hear("another light");
    assert!(differ(colour(&red), colour(&first)) > 4.0, "{first} and {red}");
    let again = hear("the first link again");
    assert!(differ(colour(&again), colour(&first)) < 2.0, "{first} and {again}");
    let errors = hear("errors against the truth");
    assert!(errors["address"].as_str().unwrap().contains("show=error"), "{errors}");
    assert!(differ(colour(&errors), colour(&first)) > 4.0, "{first} and {errors}");
    let again = hear("no errors again");
    assert!(differ(colour(&again), colour(&first)) < 2.0, "{first} and {again}");
    let turned = hear("the camera, turned by the mouse");
    let address = turned["address"].as_str().unwrap();
    let linked = link::read(address, &scenes::files()).unwrap().unwrap();
    let camera = |scene: &SceneFile| scene.scene().camera.unwrap().eye;
    let before = scenes::find("sphere").unwrap().scene().unwrap();
    assert_ne!(camera(linked.document.scene()), camera(&before), "{address}");
    assert_eq!(linked.document.scene().scene().materials, before.scene().materials);
    let own = hear("a scene of the user's, dropped with its picture");
    assert!(own["address"].as_str().unwrap().starts_with("#scene=mine.scene.ron"), "{own}");
    assert!(differ(colour(&own), colour(&turned)) > 4.0, "{turned} and {own}");
    let saved = hear("the scene, saved");
    assert_eq!((&saved["saved"], &saved["same"]), (&"mine.scene.ron".into(), &true.into()));
}
