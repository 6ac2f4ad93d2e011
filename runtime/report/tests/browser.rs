//! The page in a browser, where there is one: Chromium without a window.

#![allow(clippy::expect_used)]

mod sample;

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use shadewright_report::write::files;

/// The first of Chromium's names that is on the path.
fn chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&path)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// Loads a page with a browser that keeps its things in a folder. Gives what it has become, and what it said on its console.
fn load(browser: &Path, folder: &Path, page: &Path) -> (String, Vec<String>) {
    let open = |name: &str| std::fs::File::create(folder.join(name)).expect("a file");
    let mut child = Command::new(browser)
        .args([
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--dump-dom",
            "--enable-logging=stderr",
            "--virtual-time-budget=2000",
        ])
        .arg(format!("--user-data-dir={}", folder.join("profile").display()))
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null())
        .stdout(open("dom"))
        .stderr(open("log"))
        .spawn()
        .expect("the browser starts");
    let end = Instant::now() + Duration::from_secs(60);
    while child.try_wait().expect("a status").is_none() {
        if Instant::now() > end {
            child.kill().expect("it can be ended");
            panic!("the browser does not end");
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let read = |name: &str| String::from_utf8_lossy(&std::fs::read(folder.join(name)).expect("a file")).into_owned();
    let console = read("log")
        .lines()
        .filter(|line| line.contains(":CONSOLE"))
        .map(str::to_owned)
        .collect();
    (read("dom"), console)
}

/// Says it where it is seen: what a test that passes prints is not.
fn not_tested(why: &str) {
    let _ = writeln!(std::io::stderr(), "NOT TESTED: {why}");
}

/// Catches a script that fails or is refused by the page's own policy, and text that a browser takes for markup.
#[test]
fn a_browser_has_nothing_to_complain() {
    let Some(browser) = chromium() else {
        not_tested("there is no Chromium on the path (Debian: apt-get install --no-install-recommends chromium)");
        return;
    };
    // The files stay, to be looked at.
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    for (name, bytes) in files(&sample::report()).expect("files") {
        let path = kept.join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("made");
        std::fs::write(path, bytes).expect("written");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let (dom, console) = load(&browser, folder.path(), &kept.join("report.html"));
    assert_eq!(console, Vec::<String>::new());
    for id in [
        "faults",
        "overview",
        "x-brdf-masking",
        "x-curve-exposure-manual",
        "x-b-evil-b-x",
        "agreement",
        "without",
    ] {
        assert!(dom.contains(&format!("id=\"{id}\"")), "{id}");
    }
    // The script ran to its end: every column of the tables with several rows sorts, every command copies.
    assert_eq!(dom.matches("class=\"copy\"").count(), dom.matches("class=\"command\"").count());
    assert!(dom.matches("<th scope=\"col\"").count() > 20 && dom.contains("<button type=\"button\">RMS</button>"));
    // A page that does complain, lest the log be read wrongly.
    let wrong = folder.path().join("wrong.html");
    std::fs::write(&wrong, "<!DOCTYPE html><script>nonsense()</script>").expect("written");
    let (_, console) = load(&browser, folder.path(), &wrong);
    assert!(console.iter().any(|line| line.contains("nonsense is not defined")), "{console:?}");
}
