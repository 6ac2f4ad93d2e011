//! The README's tutorial, executed step by step as a reader would.
#![allow(clippy::expect_used, clippy::unwrap_used)]

use std::path::Path;
use std::process::Command;

use serde_json::Value;

const SECTION: &str = "## Your own BRDF in ten minutes";

/// A fenced block of the README.
struct Block {
    /// What stands behind the opening fence.
    info: String,
    text: String,
    /// Line of the opening fence.
    line: usize,
}

/// The blocks of the tutorial's section.
fn blocks() -> Vec<Block> {
    let readme = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md")).expect("README.md");
    let mut blocks: Vec<Block> = Vec::new();
    let mut inside = false;
    let mut open = false;
    for (number, line) in readme.lines().enumerate() {
        if let Some(info) = line.strip_prefix("```") {
            open = !open;
            if open && inside {
                blocks.push(Block {
                    info: info.to_owned(),
                    text: String::new(),
                    line: number + 1,
                });
            }
        } else if !open && line.starts_with("## ") {
            inside = line == SECTION;
        } else if open && inside {
            let block = blocks.last_mut().expect("a block is open");
            block.text.push_str(line);
            block.text.push('\n');
        }
    }
    blocks
}

/// Catches a tutorial that a reader cannot follow: a step that fails, a file whose name is wrong, output that differs from what is
/// shown, and a BRDF that doesn't compute what its text says.
#[test]
fn the_tutorial_works_as_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let bin = Path::new(env!("CARGO_BIN_EXE_shadewright")).parent().expect("a folder");
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").expect("PATH"));
    let mut printed = String::new();
    let mut commands = 0;
    for block in blocks() {
        let (kind, file) = block.info.split_once(" file=").unwrap_or((&block.info, ""));
        match (kind, file) {
            ("sh", "") => {
                let ran = Command::new("bash")
                    .args(["-euo", "pipefail", "-c", &block.text])
                    .current_dir(folder.path())
                    .env("PATH", &path)
                    .output()
                    .expect("bash runs");
                let err = String::from_utf8_lossy(&ran.stderr);
                assert!(ran.status.success(), "README.md:{}: {}\n{err}", block.line, block.text);
                printed = String::from_utf8(ran.stdout).expect("UTF-8");
                commands += block.text.lines().filter(|line| line.starts_with("shadewright ")).count();
            }
            ("text", "") => assert_eq!(printed, block.text, "README.md:{}", block.line),
            (_, "") => panic!(
                "README.md:{}: a block that is neither a command, nor output, nor a file",
                block.line
            ),
            (_, file) => {
                let file = folder.path().join(file);
                std::fs::create_dir_all(file.parent().expect("a folder")).expect("made");
                std::fs::write(file, &block.text).expect("written");
            }
        }
    }
    assert!(commands >= 8, "only {commands} commands: the section has moved");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));

    let probed: Value = serde_json::from_str(&read("results.json")).expect("JSON");
    for (row, expected) in [0.5 * std::f64::consts::FRAC_1_PI, std::f64::consts::FRAC_1_PI].iter().enumerate() {
        for channel in 0..3 {
            let value = probed["results"][row][channel].as_f64().expect("a number");
            assert!((value / expected - 1.0).abs() < 1e-5, "row {row}: {value} instead of {expected}");
        }
    }
    let reads_param = |name: &str| read(name).contains("material_params.minnaert_k");
    assert!(reads_param("moon.wgsl"), "{}", read("moon.wgsl"));
    assert!(!reads_param("moon-frozen.wgsl"), "{}", read("moon-frozen.wgsl"));
    let picture = image::open(folder.path().join("moon.png")).expect("a picture").to_rgb8();
    let (bright, dark) = (picture.pixels().map(|p| p[1]).max(), picture.pixels().map(|p| p[1]).min());
    assert!(
        bright > Some(100) && dark < Some(20),
        "the picture goes from {dark:?} to {bright:?}"
    );
}
