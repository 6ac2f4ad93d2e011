//! The page's files, made by cargo and wasm-bindgen.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::Response;

const TARGET: &str = "wasm32-unknown-unknown";
const INDEX: &str = include_str!("../../page/index.html");
/// Name of the module and of its bindings, as the page calls them.
const NAME: &str = "explorer";

/// Why there is no page.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum BuildError {
    /// A tool is not there.
    #[error("{what}: install it by `{advice}`")]
    Missing {
        /// Which.
        what: String,
        /// A command that installs it.
        advice: String,
    },
    /// A tool failed.
    #[error("{0}")]
    Failed(String),
}

/// A page that any server of files can serve.
#[derive(Clone, Debug)]
pub struct Site {
    /// Where its files are.
    pub folder: PathBuf,
    /// Name, media type, contents.
    files: Vec<(&'static str, &'static str, Vec<u8>)>,
}

impl Site {
    /// The files of a folder.
    fn read(folder: PathBuf) -> Result<Self, BuildError> {
        let read = |(name, kind): (&'static str, &'static str)| {
            let path = folder.join(name);
            let bytes = std::fs::read(&path).map_err(|error| failed(format!("{}: {error}", path.display())))?;
            Ok((name, kind, bytes))
        };
        let files = [
            ("index.html", "text/html; charset=utf-8"),
            ("explorer.js", "text/javascript; charset=utf-8"),
            ("explorer_bg.wasm", "application/wasm"),
        ];
        let files = files.map(read).into_iter().collect::<Result<_, _>>()?;
        Ok(Self { folder, files })
    }

    /// Answers a request for a path.
    pub fn respond(&self, path: &str) -> Response<'_> {
        let name = path.split('?').next().unwrap_or_default().trim_start_matches('/');
        let name = if name.is_empty() { "index.html" } else { name };
        let found = self.files.iter().find(|(known, ..)| *known == name);
        found.map_or(Response::MISSING, |(_, kind, bytes)| Response::found(kind, bytes.as_slice()))
    }
}

fn failed(why: impl Into<String>) -> BuildError {
    BuildError::Failed(why.into())
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Builds the page. What cargo has built before it does not build again.
///
/// # Errors
/// A tool is missing, or the sources are.
pub fn build() -> Result<Site, BuildError> {
    let bindgen = find_bindgen()?;
    check_target()?;
    let module = build_module()?;
    let folder = module.with_file_name("explorer-site");
    let mut command = Command::new(&bindgen);
    command.args([
        "--target",
        "web",
        "--no-typescript",
        "--remove-name-section",
        "--remove-producers-section",
    ]);
    command.args(["--out-name", NAME, "--out-dir"]);
    run(command.arg(&folder).arg(&module))?;
    let index = folder.join("index.html");
    std::fs::write(&index, INDEX).map_err(|error| failed(format!("{}: {error}", index.display())))?;
    Site::read(folder)
}

/// Runs a tool; what it writes. What it says of errors goes where ours goes.
fn run(command: &mut Command) -> Result<String, BuildError> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.map_err(|error| failed(format!("{name}: {error}")))?;
    if !output.status.success() {
        return Err(failed(format!("{name} failed")));
    }
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Whether Rust's library is there for the target.
fn check_target() -> Result<(), BuildError> {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let libraries = run(Command::new(rustc)
        .args(["--print", "target-libdir", "--target", TARGET])
        .current_dir(root()))?;
    if Path::new(libraries.trim()).is_dir() {
        return Ok(());
    }
    Err(BuildError::Missing {
        what: format!("Rust's library for {TARGET} is not there"),
        advice: format!("rustup target add {TARGET}"),
    })
}

/// The wasm-bindgen of the version that the program is built with: each reads its own only.
fn find_bindgen() -> Result<PathBuf, BuildError> {
    let lock = root().join("Cargo.lock");
    let text = std::fs::read_to_string(&lock).map_err(|error| failed(format!("{}: {error}", lock.display())))?;
    let version = locked(&text, "wasm-bindgen").ok_or_else(|| failed("Cargo.lock names no wasm-bindgen"))?;
    let home = std::env::var_os("CARGO_HOME").map(PathBuf::from);
    let home = home.or_else(|| Some(Path::new(&std::env::var_os("HOME")?).join(".cargo")));
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders = std::env::split_paths(&path).chain(home.map(|home| home.join("bin")));
    let program = format!("wasm-bindgen{}", std::env::consts::EXE_SUFFIX);
    let found = folders.map(|folder| folder.join(&program)).find(|program| {
        let said = Command::new(program).arg("--version").stderr(Stdio::null()).output();
        said.is_ok_and(|said| String::from_utf8_lossy(&said.stdout).split_whitespace().any(|word| word == version))
    });
    found.ok_or_else(|| BuildError::Missing {
        what: format!("wasm-bindgen {version} is not on the path"),
        advice: format!("cargo install wasm-bindgen-cli --version {version}"),
    })
}

/// The version of a package in a lock file.
fn locked<'t>(lock: &'t str, package: &str) -> Option<&'t str> {
    let (_, after) = lock.split_once(&format!("name = \"{package}\"\n"))?;
    after.lines().next()?.strip_prefix("version = \"")?.strip_suffix('"')
}

/// Has cargo build the module; where it is.
fn build_module() -> Result<PathBuf, BuildError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "-p", "explorer-page", "--profile", "page", "--target", TARGET]);
    let said = run(command.arg("--message-format=json-render-diagnostics").current_dir(root()))?;
    let module = said.lines().rev().find_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let is_page = message["reason"] == "compiler-artifact" && message["target"]["name"] == "explorer_page";
        let files = message["filenames"].as_array().filter(|_| is_page)?;
        let names = files.iter().filter_map(|file| file.as_str());
        names
            .map(PathBuf::from)
            .find(|file| file.extension().is_some_and(|end| end == "wasm"))
    });
    module.ok_or_else(|| failed("cargo has built no module"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Catches a version that is read of another package, or of the lock file's own.
    #[test]
    fn versions_are_those_of_the_lock_file() {
        let lock = "version = 4\n\n[[package]]\nname = \"wasm-bindgen-macro\"\nversion = \"0.1.0\"\n\n[[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.7\"\n";
        assert_eq!(locked(lock, "wasm-bindgen"), Some("0.2.7"));
        assert_eq!(locked(lock, "wasm"), None);
        let ours = std::fs::read_to_string(root().join("Cargo.lock")).unwrap();
        assert!(locked(&ours, "wasm-bindgen").is_some_and(|version| version.starts_with("0.2.")));
    }

    /// Catches a page that does not start because of a wrong media type, and files of the machine that a page could ask for.
    #[test]
    fn only_the_page_is_served() {
        let site = Site {
            folder: PathBuf::new(),
            files: vec![
                ("index.html", "text/html", b"page".to_vec()),
                ("a.wasm", "application/wasm", b"module".to_vec()),
            ],
        };
        let answer = |path: &str| {
            let response = site.respond(path);
            (response.status, response.kind.into_owned(), response.body.to_vec())
        };
        assert_eq!(answer("/"), (200, "text/html".into(), b"page".to_vec()));
        assert_eq!(answer("/?x#y"), answer("/index.html"));
        assert_eq!(answer("/a.wasm"), (200, "application/wasm".into(), b"module".to_vec()));
        for path in ["/../Cargo.toml", "//etc/passwd", "/index.htm", "/a.wasm/"] {
            assert_eq!(answer(path).0, 404, "{path}");
        }
    }
}
