mod sample;

#[test]
fn write() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("report");
    for (name, bytes) in shadewright_report::write::files(&sample::report()).unwrap() {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    std::fs::write(folder.join("report.md"), shadewright_report::write::markdown(&sample::report())).unwrap();
}
