//! Finds the modules: every folder beside this file that has a `category.ron` is a category, every folder in it with a
//! `module.ron` is a module. Their files become a table in the program, so that adding a module is adding a folder.

// Cargo reads a build script's standard output.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let root = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?);
    let mut files = Vec::new();
    for category in folders_with(&root, "category.ron")? {
        collect(&root, &category, &mut files)?;
        for module in folders_with(&category, "module.ron")? {
            collect(&root, &module, &mut files)?;
        }
    }
    files.sort();

    let (texts, data): (Vec<_>, Vec<_>) = files.into_iter().partition(|(_, path)| has_extension(path, &["ron", "wgsl", "md"]));
    let mut table = String::from("pub(super) static TEXTS: &[(&str, &str)] = &[\n");
    for (name, path) in &texts {
        writeln!(table, "    ({name:?}, include_str!({:?})),", path.display().to_string())?;
    }
    table.push_str("];\npub(super) static DATA: &[(&str, &[u8])] = &[\n");
    for (name, path) in &data {
        writeln!(table, "    ({name:?}, include_bytes!({:?})),", path.display().to_string())?;
    }
    table.push_str("];\n");
    let out = PathBuf::from(env::var("OUT_DIR")?);
    fs::write(out.join("files.rs"), table)?;
    fs::write(out.join("truths.rs"), truths(&root)?)?;

    // A folder is watched with all that is in it, so new and removed modules are noticed as well.
    println!("cargo::rerun-if-changed={}", root.display());
    Ok(())
}

/// The parameters of FNV-1a in 64 bits.
const FNV_BASIS: u64 = 0xcbf2_9ce4_8422_2325;
const FNV_PRIME: u64 = 0x0000_0100_0000_01b3;

/// Rust that declares the `truth.rs` and `table.rs` of every folder as modules, the tables of them all, sorted by folder, and a digest of the
/// truths' texts and of what they are written with.
fn truths(root: &Path) -> Result<String, Box<dyn Error>> {
    let mut folders = Vec::new();
    for category in folders_with(root, "category.ron")? {
        folders.extend(folders_with(&category, "module.ron")?);
        folders.push(category);
    }
    let named = with_file(root, &folders, "truth.rs")?;
    let mut digest = FNV_BASIS;
    let mut sources: Vec<PathBuf> = fs::read_dir(root.join("src/oracles"))?
        .flatten()
        .map(|entry| entry.path())
        .collect();
    sources.sort();
    sources.extend(named.iter().map(|(_, path)| path.clone()));
    for byte in sources.iter().map(fs::read).collect::<Result<Vec<_>, _>>()?.concat() {
        digest = (digest ^ u64::from(byte)).wrapping_mul(FNV_PRIME);
    }
    let mut text = String::new();
    let mut table = String::from("pub(super) static ALL: &[(&str, &[(&str, super::Truth)])] = &[\n");
    for (index, (name, path)) in named.iter().enumerate() {
        writeln!(text, "#[path = {:?}]\nmod of_{index};", path.display().to_string())?;
        writeln!(table, "    ({name:?}, of_{index}::TRUTHS),")?;
    }
    table.push_str("];\npub(super) static TABLES: &[(&str, &[(&str, super::Table)])] = &[\n");
    for (index, (name, path)) in with_file(root, &folders, "table.rs")?.iter().enumerate() {
        writeln!(text, "#[path = {:?}]\nmod table_{index};", path.display().to_string())?;
        writeln!(table, "    ({name:?}, table_{index}::TABLES),")?;
    }
    Ok(format!("{text}{table}];\npub(super) const DIGEST: u64 = {digest:#018x};\n"))
}

/// Folders that hold a file, by their names relative to `root` with `/`, and the file's path; sorted.
fn with_file(root: &Path, folders: &[PathBuf], file: &str) -> Result<Vec<(String, PathBuf)>, Box<dyn Error>> {
    let mut named = Vec::new();
    for folder in folders.iter().filter(|folder| folder.join(file).is_file()) {
        let parts: Vec<_> = folder
            .strip_prefix(root)?
            .components()
            .map(|c| c.as_os_str().to_string_lossy().into_owned())
            .collect();
        named.push((parts.join("/"), folder.join(file)));
    }
    named.sort();
    Ok(named)
}

/// Folders directly in `folder` that hold the file `marker`.
fn folders_with(folder: &Path, marker: &str) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.join(marker).is_file() {
            found.push(path);
        }
    }
    Ok(found)
}

/// Whether a file's name ends in one of these.
fn has_extension(path: &Path, among: &[&str]) -> bool {
    path.extension().is_some_and(|extension| among.iter().any(|one| extension == *one))
}

/// Adds the files directly in `folder`, named relative to `root` with `/`: all but Rust, which the build compiles.
fn collect(root: &Path, folder: &Path, files: &mut Vec<(String, PathBuf)>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_file() && path.extension().is_some() && !has_extension(&path, &["rs"]) {
            let parts: Vec<_> = path
                .strip_prefix(root)?
                .components()
                .map(|c| c.as_os_str().to_string_lossy().into_owned())
                .collect();
            files.push((parts.join("/"), path));
        }
    }
    Ok(())
}
