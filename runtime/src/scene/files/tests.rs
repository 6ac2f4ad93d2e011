use std::fs::{self, File};
use std::sync::Weak;

use shadewright_compiler::Catalog;

use super::*;
use crate::frame::Frame;
use crate::image::encode_png;
use crate::mesh::gltf::tests::{blob, sample_with};
use crate::scene::SceneFile;

fn catalog() -> Catalog {
    Catalog::load(shadewright_modules::library()).unwrap()
}

/// A picture of one grey texel; all of them have one length.
fn grey(level: u8) -> Vec<u8> {
    encode_png(1, 1, &[level, level, level, 255]).unwrap()
}

/// A scene with a picture, a body, its mirror image, and a glTF file as it is and as a mesh.
const SCENE: &str = r#"(
    camera: (eye: (0, 0, 5), target: (0, 0, 0)),
    size: (4, 2),
    pass: "forward",
    meshes: {"ball": Sphere(radius: 1), "file": Gltf(file: "../things/a.glb")},
    materials: {"a": {"material": (module: "metalness", fill: {
        "base_color_map": (module: "color-texture", textures: {"image": "grey.png"}),
    })}},
    objects: [(mesh: "ball", material: "a"), (mesh: "ball", material: "a", scale: (-1, 1, 1)), (mesh: "file", material: "a")],
    gltf: [(file: "../things/a.glb", lights: false)],
)"#;

/// The files of the scene by name. Of the glTF file, its buffer and its picture are files of their own.
fn scene_files() -> Vec<(&'static str, Vec<u8>)> {
    let gltf = sample_with(|d| {
        d["materials"][0]["alphaMode"] = "BLEND".into();
        d["buffers"][0]["uri"] = "its%20buffer.bin".into();
        d["images"][0] = serde_json::json!({"uri": "pictures/red.png"});
    });
    vec![
        ("scenes/grey.png", grey(10)),
        ("things/a.glb", gltf),
        ("things/its buffer.bin", blob()),
        ("things/pictures/red.png", encode_png(1, 1, &[255, 0, 0, 255]).unwrap()),
    ]
}

/// The same in a folder, written long enough ago that any change shows.
fn on_disk() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in scene_files() {
        write(&folder.path().join(name), &bytes, 100);
    }
    folder
}

/// Writes a file, as if it had been so many seconds ago.
fn write(path: &Path, bytes: &[u8], ago: u64) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, bytes).unwrap();
    let then = SystemTime::now() - Duration::from_secs(ago);
    File::options().write(true).open(path).unwrap().set_modified(then).unwrap();
}

/// What a frame has of files and bodies: whatever a renderer knows by its allocation.
#[derive(Clone, Debug, PartialEq)]
struct Parts {
    textures: Vec<Arc<Texture>>,
    meshes: Vec<Arc<Mesh>>,
    data: Vec<Arc<[f32]>>,
}

impl Parts {
    fn of(frame: &Frame) -> Self {
        let settings = || frame.materials.iter().map(|material| &material.settings);
        Self {
            textures: settings()
                .flat_map(|s| s.textures.values().flat_map(|t| t.values().cloned()))
                .collect(),
            meshes: frame.draws.iter().map(|draw| Arc::clone(&draw.mesh)).collect(),
            data: settings().flat_map(|s| s.data.values().flat_map(|d| d.values().cloned())).collect(),
        }
    }

    /// Which of the textures, then of the meshes, are the very same.
    fn same(&self, other: &Self) -> (Vec<bool>, Vec<bool>) {
        let textures = self.textures.iter().zip(&other.textures).map(|(a, b)| Arc::ptr_eq(a, b));
        let meshes = self.meshes.iter().zip(&other.meshes).map(|(a, b)| Arc::ptr_eq(a, b));
        (textures.collect(), meshes.collect())
    }
}

/// Catches a kind of file that is still looked for on disk, names that come out otherwise than on disk, and a name that leads out of what is there.
#[test]
fn files_in_memory_are_as_good_as_on_disk() {
    let catalog = catalog();
    let folder = on_disk();
    let memory =
        |files: Vec<(&str, Vec<u8>)>| Files::memory(files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.into())).collect());
    let disk = SceneFile::parse("a.scene.ron", SCENE, &folder.path().join("scenes")).unwrap();
    let there = SceneFile::parse("a.scene.ron", SCENE, Path::new("scenes")).unwrap();
    let expected = Parts::of(&disk.frame(&catalog, None).unwrap());
    assert_eq!((expected.textures.len(), expected.meshes.len()), (3, 5));
    let found = there.clone().with_files(memory(scene_files())).frame(&catalog, None).unwrap();
    assert_eq!(Parts::of(&found), expected);

    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/scenes");
    let names = ["screen.png", "downlight.ies", "washer.ldt"];
    let examples_in_memory = memory(names.map(|name| (name, fs::read(format!("{examples}/{name}")).unwrap())).to_vec());
    for (name, tables) in [("screen", true), ("spots", true), ("first", false)] {
        let path = format!("{examples}/{name}.scene.ron");
        let disk = SceneFile::read(Path::new(&path)).unwrap().frame(&catalog, None).unwrap();
        let text = fs::read_to_string(&path).unwrap();
        let there = SceneFile::parse(name, &text, Path::new(""))
            .unwrap()
            .with_files(examples_in_memory.clone());
        let found = Parts::of(&there.frame(&catalog, None).unwrap());
        assert_eq!(found, Parts::of(&disk));
        assert_eq!(!found.data.is_empty(), tables);
    }

    for missing in 0..4 {
        let mut files = scene_files();
        let (name, _) = files.remove(missing);
        let file = there.clone().with_files(memory(files));
        let report = file.frame(&catalog, None).unwrap_err().render();
        assert!(report.contains("there is no such file"), "without {name}: {report}");
    }
    // Files of which only the names are known; the right one is preferred.
    let mut files = scene_files();
    files.push(("grey.png", grey(200)));
    files[3].0 = "red.png";
    let flat = there.clone().with_files(memory(files));
    assert_eq!(Parts::of(&flat.frame(&catalog, None).unwrap()), expected);

    // One more, and another in the place of one.
    let (name, bytes) = scene_files().remove(3);
    let most = memory(scene_files()[..3].to_vec()).with("scenes/grey.png", grey(77));
    assert!(there.clone().with_files(most.clone()).frame(&catalog, None).is_err());
    let parts = Parts::of(&there.clone().with_files(most.with(name, bytes)).frame(&catalog, None).unwrap());
    assert_eq!((parts.textures[0].rgba[0], &parts.meshes), (77, &expected.meshes));
    assert_eq!(most.bytes(Path::new("x/../scenes/grey.png"), 9999), Ok(grey(77)));
    assert!(most.bytes(Path::new("scenes/grey.png"), 9).is_err() && most.bytes(Path::new("gone"), 9).is_err());

    // With one `..` fewer it would be there.
    let outside = SCENE.replace("\"grey.png", "\"../../grey.png");
    let outside = SceneFile::parse("a.scene.ron", &outside, Path::new("scenes")).unwrap();
    let files = memory([scene_files(), vec![("grey.png", grey(10))]].concat());
    let report = outside.with_files(files).frame(&catalog, None).unwrap_err().render();
    assert!(
        report.contains("../../grey.png") && report.contains("there is no such file"),
        "{report}"
    );
}

/// Catches pictures that are decoded and bodies that are built again for each frame (a renderer would upload them again), a change of a file that is
/// not seen, be it of one that another file names, and a change of one thing that makes all others again.
#[test]
fn what_has_not_changed_is_the_same() {
    let catalog = catalog();
    let folder = on_disk();
    let path = |name: &str| folder.path().join(name);
    let first = SceneFile::parse("a.scene.ron", SCENE, &path("scenes")).unwrap();
    let parts = |file: &SceneFile| Parts::of(&file.frame(&catalog, None).unwrap());
    let before = parts(&first);
    let all = (vec![true; 3], vec![true; 5]);
    let edited = first.set("background", "(1, 1, 1)").unwrap();
    assert_eq!(parts(&edited).same(&before), all);
    let other = SceneFile::parse("b.scene.ron", SCENE, &path("scenes")).unwrap();
    assert_eq!(parts(&other).same(&before), (vec![false; 3], vec![false; 5]), "of another family");
    assert_eq!(parts(&other.with_files(first.files().clone())).same(&before), all);

    let larger = first.set("meshes.ball", "Sphere(radius: 2)").unwrap();
    assert_eq!(parts(&larger).same(&before), (vec![true; 3], vec![false, false, true, true, true]));

    write(&path("scenes/grey.png"), &grey(99), 50);
    let after = parts(&first);
    assert_eq!(after.same(&before).1, [true; 5]);
    assert_eq!(after.textures[0].rgba, [99, 99, 99, 255]);
    write(&path("things/pictures/red.png"), &grey(7), 50);
    let after = parts(&first);
    assert_eq!(after.same(&before).1, [true, true, false, false, false], "the file's own picture");
    assert!(after.textures.iter().any(|texture| texture.rgba == [7, 7, 7, 255]));

    // As two changes within one tick of the file system's clock.
    let now = SystemTime::now();
    for level in [20, 21] {
        fs::write(path("scenes/grey.png"), grey(level)).unwrap();
        File::options()
            .write(true)
            .open(path("scenes/grey.png"))
            .unwrap()
            .set_modified(now)
            .unwrap();
        assert_eq!(parts(&first).textures[0].rgba[0], level);
    }
    fs::remove_file(path("things/its buffer.bin")).unwrap();
    assert!(first.frame(&catalog, None).is_err(), "the buffer is gone");
}

/// Catches files that are kept for ever after the scene has named them once.
#[test]
fn what_is_no_longer_asked_for_goes() {
    let catalog = catalog();
    let folder = on_disk();
    let first = SceneFile::parse("a.scene.ron", SCENE, &folder.path().join("scenes")).unwrap();
    let before = Parts::of(&first.frame(&catalog, None).unwrap());
    let texture: Weak<Texture> = Arc::downgrade(&before.textures[0]);
    let mesh: Weak<Mesh> = Arc::downgrade(&before.meshes[0]);
    drop(before);
    let other = first.set("materials.a", r#"{"material": "metalness"}"#).unwrap();
    let other = other.set("meshes.ball", "Sphere(radius: 2)").unwrap();
    let mut rounds = 0;
    while texture.strong_count() + mesh.strong_count() > 0 {
        other.frame(&catalog, None).unwrap();
        rounds += 1;
        assert!(rounds < 20, "still there");
    }
    assert!(
        rounds > 2,
        "gone at once: two scenes that are drawn in turn would make everything again"
    );
}
