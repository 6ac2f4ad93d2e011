//! `permutations`, and `check` of spaces.
#![allow(clippy::expect_used, clippy::unwrap_used)]

mod support;

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use support::{Ran, bad, finish, good, names, run, run_with_input, shadewright};

/// Eight permutations: two BRDFs, two lights there or not.
const SPACE: &str =
    r#"(module: "forward", fill: {"brdf": (one_of: ["lambert", "microfacet"]), "lights": (some_of: ["directional", "point"])})"#;
/// Six permutations, all different.
const LIT: &str =
    r#"(module: "forward", fill: {"brdf": (one_of: ["lambert", "microfacet"]), "lights": (some_of: ["directional", "point"], min: 1)})"#;
/// Six permutations with two programs: a module with a label is the same program.
const TWINS: &str = r#"(module: "display", fill: {"post": (one_of: [
    [],
    ["tonemap"], [(module: "tonemap", label: "a")], [(module: "tonemap", label: "b")], [(module: "tonemap", label: "c")], [(module: "tonemap", label: "d")],
])})"#;

fn read(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Bytes of all files of a folder.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let all = names(folder).into_iter();
    all.map(|name| (name.clone(), std::fs::read(folder.join(name)).expect("a file")))
        .collect()
}

/// Catches a count that is not the space's, or a sample that is not counted.
#[test]
fn counts() {
    assert_eq!(good(&["permutations", SPACE, "--count"]).text(), "8 permutations, 3 choices\n");
    let json = good(&["permutations", SPACE, "--count", "--format", "json"]).json();
    assert_eq!(
        (&json["permutations"], &json["choices"], &json["sample"]),
        (&"8".into(), &3.into(), &Value::Null)
    );
    let text = good(&["permutations", SPACE, "--count", "--sample", "random:3"]);
    assert_eq!(text.text(), "3 of 8 permutations, 3 choices\n");
    // A light without a position has no use for a cube of maps, and it is said.
    let never = r#"(module: "forward", fill: {"lights": [(module: "directional", fill: {"visibility": (one_of: ["none", "cube-map"])})]})"#;
    let text = good(&["permutations", never, "--count"]);
    assert_eq!(text.text(), "1 permutations, 0 choices\nnever main.lights[0].visibility=cube-map\n");
    let ran = run_with_input(&["permutations", "-", "--count"], SPACE);
    assert_eq!(ran.text(), "8 permutations, 3 choices\n");
}

/// Catches a list in another order than the numbers', or one that a recipe of it does not bear out.
#[test]
fn lists() {
    let text = good(&["permutations", SPACE]);
    let lines: Vec<&str> = text.text().lines().collect();
    assert_eq!(lines.len(), 8);
    assert_eq!(lines[0], "0: main.brdf=lambert main.lights=[]");
    assert_eq!(lines[7], "7: main.brdf=microfacet main.lights=[directional, point]");
    let json = good(&["permutations", SPACE, "--format", "json"]).json();
    for (line, item) in lines.iter().zip(json.as_array().expect("a list")) {
        assert!(line.starts_with(&format!("{}: ", item["index"].as_str().unwrap())), "{line}");
        good(&["graph", item["recipe"].as_str().expect("a recipe")]);
    }
    let random = |seed: &str| good(&["permutations", SPACE, "--sample", "random:3", "--seed", seed]).out;
    assert_eq!(random("7"), random("7"));
    assert!((0..9).any(|seed| random(&seed.to_string()) != random("7")));
    let cover = good(&["permutations", SPACE, "--sample", "pairwise"]);
    assert!((4..8).contains(&cover.text().lines().count()), "{}", cover.text());
}

/// Catches a wrong use that is taken for a right one.
#[test]
fn what_is_refused() {
    bad(&["permutations", SPACE, "--sample", "some"], 2, &["all, pairwise, or random:N"]);
    bad(&["permutations", SPACE, "--sample", "random:99999999999"], 2, &["up to 10000000"]);
    bad(&["permutations", SPACE, "--count", "--check"], 2, &["--check"]);
    let none = ["none of the 8 permutations has a pass `typo`"];
    bad(&["permutations", SPACE, "--check", "--pass", "typo"], 1, &none);
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().to_str().unwrap();
    bad(&["permutations", SPACE, "--emit", folder, "--pass", "typo"], 1, &none);
    assert!(names(home.path()).is_empty());
    bad(
        &["permutations", "absent.space.ron"],
        1,
        &["absent.space.ron: there is no such file"],
    );
    bad(
        &["permutations", r#"(module: "forward", fill: {"brdf": (one_of: ["lambrt"])})"#],
        1,
        &["SW0201", "`lambert`"],
    );
    let empty = r#"(module: "forward", fill: {"lights": [(module: "point", fill: {"visibility": "perspective"})]})"#;
    bad(&["permutations", empty], 1, &["SW1007"]);
    assert_eq!(good(&["permutations", empty, "--count"]).text(), "0 permutations, 0 choices\n");
}

/// A folder with a BRDF that does not compile.
fn broken() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let module = folder.path().join("brdf/broken");
    std::fs::create_dir_all(&module).unwrap();
    std::fs::write(module.join("module.ron"), "(summary: \"Broken\")").unwrap();
    let wgsl = "fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {\n    return missing;\n}\n";
    std::fs::write(module.join("broken.wgsl"), wgsl).unwrap();
    folder
}

/// Catches a failure that ends the work, is not reported, or does not show in the exit status; and equal programs counted as different.
#[test]
fn checks() {
    let text = good(&["permutations", TWINS, "--check"]);
    assert_eq!(text.text(), "6 permutations, 6 programs, 2 distinct (3.00 to one)\n");
    let folder = broken();
    let modules = folder.path().to_str().unwrap();
    let space = r#"(module: "forward", fill: {"brdf": (one_of: ["lambert", "broken", "microfacet"]), "lights": ["point"]})"#;
    let ran = run(&["permutations", space, "--check", "--modules", modules]);
    assert_eq!((ran.status, ran.err.as_str()), (1, ""));
    assert!(
        ran.text().starts_with("1: main.brdf=broken\npass main: error[SW0402]"),
        "{}",
        ran.text()
    );
    assert!(
        ran.text()
            .ends_with("3 permutations, 2 programs, 2 distinct (1.00 to one), 1 do not compile\n"),
        "{}",
        ran.text()
    );
    let ran = run(&[
        "permutations",
        space,
        "--check",
        "--modules",
        modules,
        "--format",
        "json",
        "--threads",
        "1",
    ]);
    let json = ran.json();
    assert_eq!(
        (ran.status, &json["programs"], &json["failed"][0]["index"]),
        (1, &2.into(), &"1".into())
    );
    assert_eq!(json["failed"][0]["diagnostics"][0]["code"], "SW0402");
    // A BRDF has no entry points: its functions are linked, as `check` does it with recipes.
    let path = folder.path().join("brdf.space.ron");
    std::fs::write(&path, "(fits: Open, of: \"brdf\", without: [\"broken\"])").unwrap();
    assert!(
        good(&["check", path.to_str().unwrap(), "--modules", modules])
            .text()
            .starts_with("ok     space")
    );
    let path = folder.path().join("broken.space.ron");
    std::fs::write(&path, space).unwrap();
    let ran = run(&["check", path.to_str().unwrap(), "--modules", modules]);
    assert_eq!(ran.status, 1);
    assert!(
        ran.text().starts_with("wrong  space") && ran.err.contains("SW0402"),
        "{}{}",
        ran.text(),
        ran.err
    );
}

fn emit(folder: &Path, space: &str, more: &[&str]) -> Ran {
    let mut arguments = vec!["permutations", space, "--emit", folder.to_str().unwrap()];
    arguments.extend(more);
    run(&arguments)
}

/// Catches a program written twice or not at all, a manifest that names other files than there are or other programs than `emit` writes,
/// and bytes that depend on the threads.
#[test]
fn emits_each_program_once() {
    let base = tempfile::tempdir().unwrap();
    let (one, two) = (base.path().join("one"), base.path().join("two/deep"));
    let ran = emit(&one, TWINS, &["--threads", "1"]);
    let expected = format!(
        "6 permutations, 6 programs, 2 distinct (3.00 to one), 2 files in {}\n",
        one.display()
    );
    assert_eq!((ran.status, ran.text(), ran.err.as_str()), (0, expected.as_str(), ""));
    assert_eq!(emit(&two, TWINS, &["--threads", "3"]).status, 0);
    assert_eq!(contents(&one), contents(&two));
    let manifest = read(&one.join("manifest.json"));
    assert_eq!(
        (&manifest["complete"], &manifest["distinct"], &manifest["ratio"]),
        (&true.into(), &2.into(), &3.0.into())
    );
    let mut named = BTreeSet::from(["manifest.json".to_owned()]);
    for (index, item) in manifest["permutations"].as_array().expect("a list").iter().enumerate() {
        assert_eq!(item["index"], index.to_string());
        let program = &item["programs"][0];
        let (hash, file) = (program["hash"].as_str().unwrap(), program["files"][0].as_str().unwrap());
        assert_eq!(file, format!("{hash}.wgsl"));
        named.insert(file.to_owned());
        let alone = good(&["emit", item["recipe"].as_str().unwrap(), "--format", "json"]).json();
        assert_eq!(alone["hash"], hash);
        if index < 2 {
            assert_eq!(alone["text"], std::fs::read_to_string(one.join(file)).unwrap());
        }
    }
    assert_eq!(names(&one).into_iter().collect::<BTreeSet<_>>(), named);
}

/// Catches targets and passes that are not written, or under wrong names.
#[test]
fn emits_every_pass_in_every_target() {
    let base = tempfile::tempdir().unwrap();
    let auto = r#"(module: "display", fill: {"post": [(module: "tonemap", fill: {"exposure": (one_of: ["manual", "log-average"])})]})"#;
    for (target, ending, files) in [("spirv", ".spv", 4), ("glsl", ".glsl", 6), ("msl", ".metal", 4)] {
        let folder = base.path().join(target);
        let ran = emit(&folder, auto, &["--target", target, "--pass", "all", "--format", "json"]);
        assert_eq!(ran.status, 0, "{}{}", ran.text(), ran.err);
        let json = ran.json();
        assert_eq!(
            (&json["programs"], &json["distinct"], &json["files"]),
            (&4.into(), &4.into(), &files.into()),
            "{target}"
        );
        assert_eq!(names(&folder).iter().filter(|name| name.ends_with(ending)).count(), files);
    }
    let folder = base.path().join("named");
    let ran = emit(&folder, auto, &["--pass", "log_average.sum"]);
    assert!(
        ran.text().starts_with("2 permutations, 1 programs, 1 distinct (1.00 to one)"),
        "{}{}",
        ran.text(),
        ran.err
    );
}

/// Catches a second run that does everything again, trusts what is damaged, or ends with other bytes than one that was not interrupted.
#[test]
fn emit_goes_on_where_it_was() {
    let base = tempfile::tempdir().unwrap();
    let (whole, folder) = (base.path().join("whole"), base.path().join("folder"));
    assert_eq!(emit(&whole, LIT, &[]).status, 0);
    let kept = |folder: &Path, more: &[&str]| emit(folder, LIT, &[&["--format", "json"], more].concat()).json()["kept"].clone();
    assert_eq!(kept(&whole, &[]), 6);
    let expected = contents(&whole);
    assert_eq!(kept(&folder, &["--sample", "random:3"]), 0);
    // The numbers of a sample are the space's own: what is there is found again.
    assert_eq!(kept(&folder, &[]), 3);
    assert_eq!(contents(&folder), expected);
    let files: Vec<String> = expected.keys().filter(|name| name.ends_with(".wgsl")).cloned().collect();
    std::fs::remove_file(folder.join(&files[0])).unwrap();
    std::fs::write(folder.join(&files[1]), "damaged").unwrap();
    assert_eq!(kept(&folder, &[]), 4);
    assert_eq!(contents(&folder), expected);
    // What was written but not noted is not written again.
    std::fs::remove_file(folder.join("manifest.json")).unwrap();
    let old = std::time::SystemTime::UNIX_EPOCH + Duration::from_secs(1);
    let file = std::fs::File::options().write(true).open(folder.join(&files[0])).unwrap();
    file.set_modified(old).unwrap();
    assert_eq!(kept(&folder, &[]), 0);
    assert_eq!(file.metadata().unwrap().modified().unwrap(), old);
    // Another target has nothing to go on.
    assert_eq!(kept(&folder, &["--target", "hlsl"]), 0);
    std::fs::write(folder.join("manifest.json"), "{\"name\": \"somebody else's\"}").unwrap();
    let ran = emit(&folder, LIT, &[]);
    assert_eq!(ran.status, 1);
    assert!(ran.err.contains("is no manifest of permutations"), "{}", ran.err);
    assert_eq!(
        std::fs::read_to_string(folder.join("manifest.json")).unwrap(),
        "{\"name\": \"somebody else's\"}"
    );
}

/// Catches an edit after which everything is compiled again, one that goes unnoticed, and a text of another permutation than the first.
#[test]
fn emit_keeps_what_an_edit_does_not_reach() {
    let base = tempfile::tempdir().unwrap();
    let modules = base.path().join("modules");
    let write = |name: &str, body: &str| {
        let module = modules.join("brdf").join(name);
        std::fs::create_dir_all(&module).unwrap();
        std::fs::write(module.join("module.ron"), "(summary: \"Planted\")").unwrap();
        let wgsl = format!("fn brdf(s: Surface, v: vec3f, l: vec3f) -> vec3f {{\n    {body}\n}}\n");
        std::fs::write(module.join(format!("{name}.wgsl")), wgsl).unwrap();
    };
    let folder = base.path().join("folder");
    let mut runs = 0;
    let mut kept = |names: [&str; 3]| {
        let space = format!(r#"(module: "forward", fill: {{"brdf": (one_of: {names:?}), "lights": ["point"]}})"#);
        let more = ["--modules", modules.to_str().unwrap(), "--format", "json"];
        let json = emit(&folder, &space, &more).json();
        runs += 1;
        let whole = base.path().join(format!("whole {runs}"));
        assert_eq!(emit(&whole, &space, &more).status, 0);
        let mut now = contents(&folder);
        // What nothing names any more is left where it is.
        let expected = contents(&whole);
        now.retain(|name, _| expected.contains_key(name));
        assert_eq!(now, expected, "run {runs}");
        json["kept"].as_u64().unwrap()
    };
    write("one", "return s.diffuse;");
    write("two", "return s.diffuse * 2.0;");
    assert_eq!(kept(["one", "two", "lambert"]), 0);
    assert_eq!(kept(["one", "two", "lambert"]), 3);
    write("two", "return s.diffuse * 3.0;");
    assert_eq!(kept(["one", "two", "lambert"]), 2);
    // Another comment, the same program: the file has another text under the same name.
    write("one", "return s.diffuse; // planted");
    assert_eq!(kept(["one", "two", "lambert"]), 2);
    // Two texts of one program: the first one's is in the file, whichever that is now.
    write("two", "return s.diffuse; // also planted");
    assert_eq!(kept(["one", "two", "lambert"]), 2);
    assert_eq!(kept(["two", "one", "lambert"]), 2);
    write("two", "return s.diffuse; // edited");
    assert_eq!(kept(["two", "one", "lambert"]), 1, "the text of the first was in the file of both");
    write("two", "return s.diffuse * 2.0;");
    assert_eq!(kept(["two", "one", "lambert"]), 1, "as before");
}

/// Catches Ctrl-C that leaves half a file, a temporary one, or a manifest that names what is not there.
#[cfg(unix)]
#[test]
fn ctrl_c_leaves_order() {
    let base = tempfile::tempdir().unwrap();
    let folder = base.path().join("out");
    let space = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/spaces/standard.space.ron");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_shadewright"))
        .args([
            "permutations",
            space.to_str().unwrap(),
            "--threads",
            "1",
            "--emit",
            folder.to_str().unwrap(),
        ])
        .stderr(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .spawn()
        .expect("the command runs");
    let begun = Instant::now();
    while !std::fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some()) {
        assert!(
            begun.elapsed() < Duration::from_secs(120) && child.try_wait().unwrap().is_none(),
            "nothing is written"
        );
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .expect("kill");
    assert!(sent.success());
    let output = child.wait_with_output().expect("it ends");
    let err = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(130), "{err}");
    assert!(
        err.starts_with("interrupted: ") && err.contains("the same command goes on"),
        "{err}"
    );
    assert!(output.stdout.is_empty());
    let manifest = read(&folder.join("manifest.json"));
    assert_eq!(manifest["complete"], false);
    let listed: BTreeSet<String> = manifest["files"].as_object().unwrap().keys().cloned().collect();
    let there: BTreeSet<String> = names(&folder).into_iter().filter(|name| name != "manifest.json").collect();
    assert_eq!(there, listed);
    let done = manifest["permutations"].as_array().unwrap();
    assert!(!done.is_empty());
    for (index, item) in done.iter().enumerate() {
        assert_eq!(item["index"], index.to_string());
    }
    for name in &there {
        naga::front::wgsl::parse_str(&std::fs::read_to_string(folder.join(name)).unwrap()).expect("a whole file");
    }
}

/// Catches progress on what is no terminal, where it would be noise in a log.
#[test]
fn no_progress_in_logs() {
    let ran = finish(shadewright().args(["permutations", SPACE, "--check"]));
    assert_eq!((ran.status, ran.err.as_str()), (0, ""));
}

/// Catches a manifest that somebody edited and that is believed: permutations without programs or files, or a hash that is none.
#[test]
fn an_edited_manifest_is_not_believed() {
    type Edit = fn(&mut Value);
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("out");
    emit(&folder, SPACE, &[]);
    let whole = contents(&folder);
    let edits: [(&str, Edit); 4] = [
        ("no programs", |entry| entry["programs"] = Value::Array(Vec::new())),
        ("no files", |entry| entry["programs"][0]["files"] = Value::Array(Vec::new())),
        ("no hash", |entry| entry["programs"][0]["hash"] = "zzz".into()),
        ("another's hash", |entry| entry["programs"][0]["hash"] = "0".repeat(32).into()),
    ];
    for (what, edit) in edits {
        let mut manifest = read(&folder.join("manifest.json"));
        manifest["permutations"].as_array_mut().unwrap().iter_mut().for_each(edit);
        std::fs::write(folder.join("manifest.json"), manifest.to_string()).unwrap();
        emit(&folder, SPACE, &[]);
        assert!(contents(&folder) == whole, "{what}");
    }
}
