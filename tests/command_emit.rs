//! `emit` and `check`.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::path::Path;

use serde_json::Value;
use support::{GLOSSY, MATTE, SHADOWED, bad, good, names, run, run_with_input, shadewright};

/// Catches a target that does not come out, or comes out as another.
#[test]
fn every_target_comes_out() {
    let wgsl = good(&["emit", MATTE]);
    assert!(wgsl.text().contains("fn fragment_main("), "{}", wgsl.text());
    naga::front::wgsl::parse_str(wgsl.text()).expect("naga reads it");
    let ir = good(&["emit", MATTE, "--target", "wgsl-ir"]);
    naga::front::wgsl::parse_str(ir.text()).expect("naga reads it");
    let spirv = good(&["emit", MATTE, "--target", "spirv"]).out;
    assert_eq!(spirv.get(..4), Some(&[0x03, 0x02, 0x23, 0x07][..]));
    assert!(good(&["emit", MATTE, "--target", "hlsl"]).text().contains("cbuffer"));
    assert!(good(&["emit", MATTE, "--target", "msl"]).text().contains("metal_stdlib"));
    let glsl = good(&["emit", MATTE, "--target", "glsl", "--entry", "fragment_main"]);
    assert!(glsl.text().starts_with("#version"), "{}", glsl.text());
}

/// Catches SPIR-V that only its own writer takes for valid.
#[test]
fn spirv_val_accepts_spirv() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("shader.spv");
    let path = file.to_str().expect("UTF-8");
    good(&["emit", SHADOWED, "--target", "spirv", "-o", path]);
    let ran = std::process::Command::new("spirv-val")
        .args(["--target-env", "vulkan1.1", path])
        .output()
        .expect("spirv-val is installed");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
}

/// Catches GLSL of an arbitrary entry point, where the pass has several.
#[test]
fn glsl_wants_an_entry_point() {
    bad(&["emit", MATTE, "--target", "glsl"], 1, &["SW0"]);
    bad(&["emit", MATTE, "--target", "glsl", "--entry", "absent"], 1, &["SW0", "absent"]);
}

/// Catches JSON without the shader, or words in the wrong byte order.
#[test]
fn json_holds_shader_and_reflection() {
    let json = good(&["emit", MATTE, "--format", "json"]).json();
    assert_eq!(json["target"], "wgsl");
    assert_eq!(json["text"], good(&["emit", MATTE]).text());
    assert_eq!(json["reflection"]["version"], 1);
    assert_eq!(json["reflection"]["hash"], json["hash"]);
    let json = good(&["emit", MATTE, "--format", "json", "--target", "spirv"]).json();
    assert_eq!(json["words"][0], 0x0723_0203);
}

/// Catches files that differ from what standard output says, and reflection that lists a binding that is not in the text.
#[test]
fn files_hold_the_same_as_standard_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let (shader, reflection) = (folder.path().join("a.wgsl"), folder.path().join("a.json"));
    let ran = good(&[
        "emit",
        SHADOWED,
        "-o",
        shader.to_str().unwrap(),
        "--reflect",
        reflection.to_str().unwrap(),
    ]);
    assert_eq!(ran.text(), "");
    let text = std::fs::read_to_string(&shader).expect("the shader");
    assert_eq!(text, good(&["emit", SHADOWED]).text());
    let json: Value = serde_json::from_slice(&std::fs::read(&reflection).expect("the reflection")).expect("JSON");
    let bindings = json["bindings"].as_array().expect("a list");
    assert!(bindings.iter().any(|binding| binding["name"] == "cube_map_shadow_map"));
    for binding in bindings {
        let (group, number, name) = (&binding["group"], &binding["binding"], binding["name"].as_str().unwrap());
        assert!(text.contains(&format!("@group({group}) @binding({number})")), "{name}");
        assert!(text.contains(name), "{name}");
    }
    assert_eq!(names(folder.path()), ["a.json", "a.wgsl"]);
}

/// Catches output that depends on the run, the directory or the number of threads.
#[test]
fn equal_input_gives_equal_bytes() {
    let here = good(&["emit", GLOSSY]).out;
    let elsewhere = tempfile::tempdir().expect("a folder");
    let mut command = shadewright();
    command
        .current_dir(elsewhere.path())
        .env("RAYON_NUM_THREADS", "1")
        .args(["emit", GLOSSY]);
    assert_eq!(here, support::finish(&mut command).out);
}

/// Catches a `--freeze` that freezes nothing, the wrong instance, or what is not there.
#[test]
fn freeze_makes_constants() {
    let tonemap = r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": "manual"})]})"#;
    let json = good(&["emit", tonemap, "--freeze", "main.post[0].exposure.ev100=3.5", "--format", "json"]).json();
    let params = json["reflection"]["params"].as_array().expect("a list");
    assert!(
        !params
            .iter()
            .any(|param| param["name"] == "ev100" && param["place"]["kind"] == "uniform"),
        "{params:?}"
    );
    let json = good(&["emit", tonemap, "--format", "json"]).json();
    let params = json["reflection"]["params"].as_array().expect("a list");
    assert!(
        params
            .iter()
            .any(|param| param["name"] == "ev100" && param["place"]["kind"] == "uniform"),
        "{params:?}"
    );

    bad(&["emit", tonemap, "--freeze", "post.exposure.ev10=1"], 1, &["`ev10`", "`ev100`"]);
    bad(
        &["emit", tonemap, "--freeze", "post.exposur.ev100=1"],
        1,
        &["`exposur`", "`exposure`"],
    );
    bad(
        &["emit", tonemap, "--freeze", "post[7].exposure.ev100=1"],
        1,
        &["nothing stands in `post[7]`"],
    );
    bad(&["emit", tonemap, "--freeze", "post.exposure.ev100=100"], 1, &["SW0302"]);
    bad(&["emit", tonemap, "--freeze", "ev100"], 2, &["PARAM=VALUE"]);
}

/// Catches a pass of a module that cannot be had, and an unknown one taken for the main one.
#[test]
fn passes_of_modules_come_out() {
    let json = good(&["emit", SHADOWED, "--format", "json"]).json();
    let pass = &json["reflection"]["passes"][0];
    let name = format!("{}.{}", pass["instance"].as_str().unwrap(), pass["name"].as_str().unwrap());
    let depth = good(&["emit", SHADOWED, "--pass", &name, "--format", "json"]).json();
    assert_eq!(depth["pass"], name.as_str());
    assert!(!depth["text"].as_str().unwrap().contains("fn light"));
    bad(&["emit", SHADOWED, "--pass", "absent"], 1, &["SW0212", "absent"]);
}

/// Catches recipes from files, from standard input and from arguments that differ.
#[test]
fn a_recipe_is_the_same_from_anywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("matte.recipe.ron");
    std::fs::write(&file, MATTE).expect("written");
    let inline = good(&["emit", MATTE]).out;
    assert_eq!(good(&["emit", file.to_str().unwrap()]).out, inline);
    assert_eq!(run_with_input(&["emit", "-"], MATTE).out, inline);
}

/// Catches a failing command that empties or half-writes the file that is there, or leaves its temporary files.
#[test]
fn a_failure_leaves_old_files_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let (shader, reflection) = (folder.path().join("a.wgsl"), folder.path().join("a.json"));
    std::fs::write(&shader, "old").expect("written");
    std::fs::write(&reflection, "old").expect("written");
    let (shader, reflection) = (shader.to_str().unwrap(), reflection.to_str().unwrap());
    bad(&["emit", "absent-module", "-o", shader, "--reflect", reflection], 1, &["SW0201"]);
    // The second file cannot be written: the first must not have been.
    bad(
        &["emit", MATTE, "-o", shader, "--reflect", "/nonexistent/a.json"],
        1,
        &["/nonexistent/a.json"],
    );
    bad(
        &["emit", MATTE, "-o", shader, "--reflect", folder.path().to_str().unwrap()],
        1,
        &["is a folder"],
    );
    bad(&["emit", MATTE, "-o", "-", "--reflect", "-"], 2, &["standard output"]);
    assert_eq!(std::fs::read_to_string(shader).unwrap(), "old");
    assert_eq!(std::fs::read_to_string(reflection).unwrap(), "old");
    assert_eq!(names(folder.path()), ["a.json", "a.wgsl"]);
}

/// Catches a rename that replaces a link by a file.
#[cfg(unix)]
#[test]
fn links_stay() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, link) = (folder.path().join("a.wgsl"), folder.path().join("b.wgsl"));
    std::fs::write(&file, "old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    good(&["emit", MATTE, "-o", link.to_str().unwrap()]);
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::read_to_string(&file).unwrap(), good(&["emit", MATTE]).text());
}

/// Catches a rename that replaces a pipe or a device by a file. A pipe of the test's own stands for both: were this to fail on a
/// real device, the device would be gone.
#[cfg(unix)]
#[test]
fn pipes_stay() {
    use std::os::unix::fs::FileTypeExt;
    use std::process::{Command, Stdio};
    let folder = tempfile::tempdir().expect("a folder");
    let pipe = folder.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let mut reader = Command::new("cat").arg(&pipe).stdout(Stdio::piped()).spawn().expect("cat runs");
    good(&["emit", MATTE, "-o", pipe.to_str().unwrap()]);
    if !std::fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo() {
        // Nobody will ever write to what the reader waits for.
        reader.kill().expect("our own child");
        panic!("the pipe is a file now");
    }
    let read = reader.wait_with_output().expect("cat ends").stdout;
    assert_eq!(read, good(&["emit", MATTE]).out);
}

/// Catches a panic, or a complaint, when the reader of the output has gone.
#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_error() {
    let script = format!("{} list | true; echo ${{PIPESTATUS[0]}}", env!("CARGO_BIN_EXE_shadewright"));
    for _ in 0..5 {
        let ran = std::process::Command::new("bash")
            .args(["-c", &script])
            .output()
            .expect("bash runs");
        assert_eq!(String::from_utf8_lossy(&ran.stdout), "0\n");
        assert_eq!(String::from_utf8_lossy(&ran.stderr), "");
    }
}

/// Catches input that is wrong in a way nobody thought of: every one is status 1 and says something.
#[test]
fn odd_input_is_status_1() {
    let deep = format!("{}\"x\"{}", "[".repeat(10_000), "]".repeat(10_000));
    for text in [
        "",
        "()",
        "(module: 3)",
        "(module: \"forward\", fil: {})",
        "\u{0}",
        "forward forward",
        &deep,
    ] {
        let ran = run_with_input(&["emit", "-"], text);
        assert_eq!(ran.status, 1, "{:?}: {}", text.get(..40.min(text.len())), ran.err);
        assert!(!ran.err.is_empty());
    }
    let mut command = shadewright();
    let ran = support::finish(command.args(["emit", "-"]).write_stdin(vec![0xff, 0xfe]));
    assert_eq!(ran.status, 1);
    assert!(ran.err.contains("standard input") || ran.err.contains("UTF-8"), "{}", ran.err);
    bad(&["emit", "."], 1, &[]);
    bad(&["emit", "lambert"], 1, &["SW0211"]);
}

/// Catches a module of the standard library that cannot be linked by itself.
#[test]
fn the_standard_library_is_good() {
    let json = good(&["check", "--format", "json"]).json();
    let checked = json.as_array().expect("a list");
    assert!(checked.len() >= 20, "only {} modules", checked.len());
    assert!(checked.iter().all(|item| item["ok"] == true && item["kind"] == "module"));
    let text = good(&["check"]);
    assert!(text.text().contains("ok     module brdf/lambert\n"), "{}", text.text());
}

/// Catches recipes and scenes of the examples that are wrong.
#[test]
fn the_examples_are_good() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    let mut paths = Vec::new();
    for folder in ["recipes", "scenes"] {
        for name in names(&examples.join(folder)) {
            if name.ends_with(".ron") {
                paths.push(examples.join(folder).join(name).to_str().expect("UTF-8").to_owned());
            }
        }
    }
    assert!(paths.len() >= 2, "{paths:?}");
    let mut arguments = vec!["check"];
    arguments.extend(paths.iter().map(String::as_str));
    good(&arguments);
}

/// Catches a check that passes what is wrong, or stops at the first.
#[test]
fn check_finds_all_that_is_wrong() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).expect("written");
        path.to_str().expect("UTF-8").to_owned()
    };
    let good_one = write("good.recipe.ron", MATTE);
    let category = write("category.recipe.ron", r#"(module: "forward", fill: {"brdf": "point"})"#);
    let range = write("range.recipe.ron", r#"(module: "manual", freeze: {"ev100": 1000.0})"#);
    let ran = run(&["check", &good_one, &category, &range]);
    assert_eq!(ran.status, 1);
    assert!(ran.text().contains(&format!("ok     recipe {good_one}")), "{}", ran.text());
    assert!(ran.err.contains("SW0202") && ran.err.contains("SW0302"), "{}", ran.err);
    let ran = run(&["check", "--format", "json", &good_one, &category]);
    // The last in order is good; the first is wrong all the same.
    assert_eq!(ran.status, 1);
    let json = ran.json();
    let wrong = json
        .as_array()
        .unwrap()
        .iter()
        .find(|item| item["ok"] == false)
        .expect("one is wrong");
    assert_eq!(wrong["diagnostics"][0]["code"], "SW0202");
    let from_input = run_with_input(&["check", "-"], "\"lambert\"");
    assert_eq!((from_input.status, from_input.text()), (0, "ok     recipe -\n"));
    bad(&["check", folder.path().join("absent").to_str().unwrap()], 1, &["absent"]);
    bad(&["check", folder.path().to_str().unwrap()], 1, &["holds no module"]);
}
